"""The dynamic window approach (Fox, Burgard, Thrun 1997) and trajectory rollout (Gerkey, Konolige 2008), as ROS' local planners have them.

Both score steady commands; DWA those that can be reached within one control period, trajectory rollout those within the whole horizon.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uvf.maths.kinematics import Twist
from uvf.planning.costmap.footprint import RobotFootprint
from uvf.planning.local import rollout
from uvf.planning.local.planner import Limits, LocalSituation, State
from uvf.planning.local.rollout import FEATURES, Others, roll_out
from uvf.planning.local.window import UNREACHED

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]


@dataclass(frozen=True)
class DwaSettings:
    """Parameters of base_local_planner / dwa_local_planner under their names."""

    sim_time: float = 2.0  # s
    sim_period: float = 0.05  # s, of the controller; the window of DWA
    step: float = 0.05  # s between the poses that are looked at
    vx_samples: int = 6
    vth_samples: int = 20
    path_distance_bias: float = 0.75  # 1/m
    goal_distance_bias: float = 1.0  # 1/m
    occdist_scale: float = 0.1
    whole_horizon: bool = False
    """Trajectory rollout: the window is what can be reached within ``sim_time``."""


class Dwa:
    """Chooses the steady command whose arc ends nearest to path and goal and farthest from obstacles; touching ones are out."""

    def __init__(self, limits: Limits, footprint: RobotFootprint, settings: DwaSettings) -> None:
        self.settings = settings
        self._limits, self._outline = limits, (footprint.sides(), footprint.circumscribed_radius)

    def reset(self) -> None:
        """Nothing is remembered from one cycle to the next."""

    def command(self, now: LocalSituation) -> Twist | None:
        """Velocity for now; None where every arc touches something or leads nowhere."""
        s, state = self.settings, now.state
        pairs = self._window(state)
        steps = max(round(s.sim_time / s.step), 1)
        commands = np.zeros((len(pairs), steps, 3), dtype=np.float32)
        commands[:, :, :2] = pairs[:, None, :]
        found = np.empty((len(pairs), FEATURES), dtype=np.float32)
        others = Others(now.obstacles, *self._outline)
        roll_out(now.grids, state, commands, (s.step, self._limits), others, found)
        allowed = (found[:, rollout.COLLIDED] == 0.0) & (found[:, rollout.TO_GO] < UNREACHED / 2)
        if not allowed.any():
            return None
        costs = (
            s.path_distance_bias * found[:, rollout.OFF_PATH]
            + s.goal_distance_bias * found[:, rollout.TO_GO]
            + s.occdist_scale * found[:, rollout.WORST]
        )
        best = int(np.argmin(np.where(allowed, costs, np.inf)))
        return Twist(float(pairs[best, 0]), float(pairs[best, 1]))

    def _window(self, state: State) -> Floats:
        """(k, 2) commands within reach, with standing still in turn rate among them."""
        s, limits = self.settings, self._limits
        span = s.sim_time if s.whole_horizon else s.sim_period
        dv, dw = limits.acceleration * span, limits.angular_acceleration * span
        slowest, fastest = max(limits.min_speed, state.speed - dv), min(limits.max_speed, state.speed + dv)
        right, left = max(-limits.max_turn_rate, state.turn_rate - dw), min(limits.max_turn_rate, state.turn_rate + dw)
        speeds = np.linspace(slowest, max(fastest, slowest), s.vx_samples)
        turns = np.linspace(right, max(left, right), s.vth_samples)
        if right < 0.0 < left:
            turns = np.concatenate((turns, (0.0,)))
        if slowest < 0.0 < fastest:
            speeds = np.concatenate((speeds, (0.0,)))
        return np.stack(np.meshgrid(speeds, turns, indexing="ij"), axis=-1).reshape(-1, 2)
