"""Model predictive path integral control (Williams, Aldrich, Theodorou 2017): the commands that many random futures agree on."""

from dataclasses import dataclass
from functools import lru_cache
from math import ceil

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.maths.kinematics import Twist
from uvf.planning.costmap.footprint import RobotFootprint
from uvf.planning.local import rollout
from uvf.planning.local.planner import Limits, LocalSituation
from uvf.planning.local.rollout import FEATURES, Others, roll_out

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]

POOL = 4
"""Times as much noise as one round needs is drawn at the start; a round takes a part of it from a random place."""
AT_ONCE = 0.95
"""Share of the horizon after a contact from which no future is worth driving."""
TURN_FIRST = (0.5, 1.0, 1.6, 2.2, 2.7, 3.2)
"""rad by which manoeuvres turn, on the spot or backing up, before they drive on."""
SIDE_FOR = (0.2, 0.4, 0.6, 0.8, 1.0)
"""Shares of the horizon for which manoeuvres go sideways."""
SMOOTH = np.array((-3.0, 12.0, 17.0, 12.0, -3.0)) / 35.0
"""Savitzky-Golay of five points, quadratic."""


@dataclass(frozen=True)
class MppiSettings:
    """How futures are drawn and judged. Weights are per unit of the feature (``rollout``), lower sums are better."""

    samples: int = 1000
    steps: int = 56
    step: float = 0.05  # s
    speed_noise: float = 0.3  # standard deviation, as a share of the speed range
    turn_noise: float = 0.35  # the same of the turn rate
    noise_memory: float = 0.85  # correlation from one step to the next: slow changes explore farther than fast ones
    temperature: float = 0.3
    collision_weight: float = 60.0
    cost_weight: float = 3.0
    to_go_weight: float = 8.0  # per way at full speed within the horizon, as all weights of lengths
    mean_to_go_weight: float = 6.0
    off_path_weight: float = 1.2
    reverse_weight: float = 6.0
    aside_weight: float = 6.0
    """Of the way that the vehicle would make at full speed in the time that it needs to turn to the way on, as far as it must."""
    turn_weight: float = 0.1  # per largest turn rate
    near_weight: float = 15.0
    fast_weight: float = 6.0
    close_weight: float = 10.0
    heed: float = 1.5  # m to a moving obstacle from which it matters
    doubt: tuple[float, float] = (0.1, 0.25)
    """m, m/s: by how much a moving obstacle may be elsewhere than it is taken to be, now and the farther ahead one looks."""
    growth: float = 0.1  # m/s by which a moving obstacle is taken to be wider the farther ahead one looks


class Mppi:
    """Chooses velocities; remembers the last plan, so that each round begins where the last one ended."""

    def __init__(self, limits: Limits, footprint: RobotFootprint, settings: MppiSettings, seed: int = 0) -> None:
        self.settings = settings
        self._limits, self._outline = limits, (footprint.sides(), footprint.circumscribed_radius)
        self._rng = np.random.default_rng(seed)
        shape = (POOL * settings.samples, settings.steps, 2)
        noise = _coloured(self._rng.standard_normal(shape), settings.noise_memory)
        sideways = np.zeros((*shape[:2], 1))
        if limits.side_speed > 0.0:
            sideways = _coloured(self._rng.standard_normal(sideways.shape), settings.noise_memory)
            sideways[::2] = 0.0
        self._noise = np.concatenate((noise, sideways), axis=2).astype(np.float32)
        self._plan: Floats = np.zeros((settings.steps, 3))
        self._commands = np.empty((settings.samples, settings.steps, 3), dtype=np.float32)
        self._found = np.empty((settings.samples, FEATURES), dtype=np.float32)
        self._weights = _weights(settings, limits)
        self.best: Floats32 = np.zeros(FEATURES, dtype=np.float32)
        """Features of the plan that was chosen last."""

    def reset(self) -> None:
        """Forgets the last plan."""
        self._plan[:] = 0.0

    def command(self, now: LocalSituation) -> Twist | None:
        """Velocity for now; None where every future ends in a contact at once."""
        settings, grids, start = self.settings, now.grids, now.state
        limits = now.limits or self._limits
        others = Others(now.obstacles, *self._outline, settings.heed, settings.growth, settings.doubt)
        offset = int(self._rng.integers(0, (POOL - 1) * settings.samples + 1))
        spread = (
            settings.speed_noise * (limits.max_speed - min(limits.min_speed, 0.0)),
            settings.turn_noise * limits.max_turn_rate,
            settings.speed_noise * limits.side_speed,
        )
        _draw(self._plan, (self._noise, offset, spread), _manoeuvres(limits, settings), self._commands)
        _clip(self._commands, limits)
        roll_out(grids, start, self._commands, (settings.step, limits), others, self._found)
        costs = self._found @ self._weights
        weights = np.exp(-(costs - costs.min()) / settings.temperature)
        _average(self._commands, weights / weights.sum(), self._plan)
        self._smooth()
        chosen = self._plan[None].astype(np.float32)
        roll_out(grids, start, chosen, (settings.step, limits), others, self._found[:1])
        if self._found[0, rollout.COLLIDED] > 0.0:  # the average of two ways round may lie between them
            best = int(np.argmin(costs))
            self._plan[:] = self._commands[best]
            roll_out(grids, start, self._commands[best : best + 1].copy(), (settings.step, limits), others, self._found[:1])
        self.best = self._found[0].copy()
        velocity = Twist(*self._plan[0].tolist())
        self._plan[:-1] = self._plan[1:]
        stuck = self.best[rollout.COLLIDED] > AT_ONCE and not len(now.obstacles)  # what moves may yet pass by
        return None if stuck else velocity

    def _smooth(self) -> None:
        for k in range(3):
            padded = np.concatenate(([self._plan[0, k]] * 2, self._plan[:, k], [self._plan[-1, k]] * 2))
            self._plan[:, k] = np.convolve(padded, SMOOTH, mode="valid")


def _weights(s: MppiSettings, limits: Limits) -> Floats32:
    """(FEATURES,) what a unit of each feature costs."""
    way, weights = s.steps * s.step * limits.max_speed, np.zeros(FEATURES, dtype=np.float32)
    weights[rollout.COLLIDED], weights[rollout.COST], weights[rollout.NEAR] = s.collision_weight, s.cost_weight, s.near_weight
    weights[rollout.TO_GO], weights[rollout.MEAN_TO_GO] = s.to_go_weight / way, s.mean_to_go_weight / way
    weights[rollout.OFF_PATH], weights[rollout.REVERSED] = s.off_path_weight / way, s.reverse_weight / way
    weights[rollout.FAST], weights[rollout.CLOSE] = s.fast_weight, s.close_weight
    weights[rollout.TURNED] = s.turn_weight / limits.max_turn_rate
    turning = max(limits.max_speed / limits.max_turn_rate, limits.turning_radius) * (1.0 - limits.side_speed / limits.max_speed)
    weights[rollout.ASIDE] = s.aside_weight / way * turning
    return weights


@lru_cache(maxsize=4)
def _manoeuvres(limits: Limits, settings: MppiSettings) -> Floats32:
    """(k, steps, 3) commands that find a way where noise round the last plan does not: held steady, or turning first and then driving.

    Who cannot turn on the spot backs up round a corner first.
    """
    speeds = np.linspace(limits.min_speed, limits.max_speed, 9)
    turns = np.linspace(-limits.max_turn_rate, limits.max_turn_rate, 13)
    pairs = np.stack(np.meshgrid(speeds, turns, indexing="ij"), axis=-1).reshape(-1, 1, 2)
    pairs = np.concatenate((pairs, np.zeros((*pairs.shape[:2], 1))), axis=-1)
    steady = np.concatenate((_sideways(limits, settings.steps), np.repeat(pairs, settings.steps, axis=1)))
    turning, backing = [], min(limits.min_speed, 0.0) if limits.turning_radius > 0.0 else 0.0
    rate = min(limits.max_turn_rate, -backing / limits.turning_radius) if backing else limits.max_turn_rate
    for angle in TURN_FIRST:
        first = min(ceil(angle / rate / settings.step), settings.steps)
        for speed in (0.4 * limits.max_speed, 0.8 * limits.max_speed):
            for way in (-limits.max_turn_rate, limits.max_turn_rate):
                commands = np.tile((speed, 0.0, 0.0), (settings.steps, 1))
                commands[:first] = backing, way, 0.0
                turning.append(commands)
    both: Floats32 = np.concatenate((np.array(turning), steady)).astype(np.float32)[: settings.samples // 2]
    return both


def _sideways(limits: Limits, steps: int) -> Floats:
    """(k, steps, 3) commands to the sides, standing, ahead and back, for a while and then stopping; none of who cannot go there."""
    if limits.side_speed == 0.0:
        return np.zeros((0, steps, 3))
    found = []
    for speed in (0.0, 0.5 * limits.max_speed, 0.5 * min(limits.min_speed, 0.0)):
        for side in (-limits.side_speed, limits.side_speed):
            for share in SIDE_FOR:
                commands = np.zeros((steps, 3))
                commands[: ceil(share * steps)] = speed, 0.0, side
                found.append(commands)
    return np.array(found)


def _coloured(white: Floats, memory: float) -> Floats:
    """Noise (k, n, 2) of unit deviation with so much correlation from step to step, from white noise; the first step has it too."""
    out = white.copy()
    for i in range(1, white.shape[1]):
        out[:, i] = memory * out[:, i - 1] + np.sqrt(1.0 - memory**2) * white[:, i]
    return out


@compiled
def _draw(plan: Floats, noises: tuple[Floats32, int, tuple[float, float, float]], manoeuvres: Floats32, out: Floats32) -> None:
    """The last plan itself, the manoeuvres, and the plan with noise: (of unit deviation, the row to begin with, deviations)."""
    noise, offset, spread = noises
    samples, steps = out.shape[0], out.shape[1]
    for k in range(samples):
        for i in range(steps):
            for j in range(3):
                if k == 0:
                    out[k, i, j] = plan[i, j]
                elif k <= manoeuvres.shape[0]:
                    out[k, i, j] = manoeuvres[k - 1, i, j]
                else:
                    out[k, i, j] = plan[i, j] + spread[j] * noise[offset + k, i, j]


@compiled
def _clip(commands: Floats32, limits: Limits) -> None:
    """To what the vehicle is allowed."""
    for k in range(commands.shape[0]):
        for i in range(commands.shape[1]):
            commands[k, i, 0] = min(max(commands[k, i, 0], limits.min_speed), limits.max_speed)
            commands[k, i, 1] = min(max(commands[k, i, 1], -limits.max_turn_rate), limits.max_turn_rate)
            commands[k, i, 2] = min(max(commands[k, i, 2], -limits.side_speed), limits.side_speed)


@compiled
def _average(commands: Floats32, weights: Floats32, plan: Floats) -> None:
    """The mean of the commands by their weights."""
    plan[:] = 0.0
    for k in range(commands.shape[0]):
        if weights[k] > 1e-7:
            for i in range(commands.shape[1]):
                plan[i, 0] += weights[k] * commands[k, i, 0]
                plan[i, 1] += weights[k] * commands[k, i, 1]
                plan[i, 2] += weights[k] * commands[k, i, 2]
