"""Milvus on the strip, flown by a scripted pilot: take-off, and approach with landing. No autopilot, no estimator.

The pilot looks along the strip (it runs east from the world's origin): he keeps to its middle with the rudder, the wings level with the
ailerons, and the nose at the pitch that the phase asks for. ``python -m benchmarks.sim.air.milvus.strip
docs/images/milvus-strip.png`` draws both.
"""

import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from benchmarks.sim.air.milvus.coefficients import BODY, FOLDER, TANGENT
from services.sim_air.actuators import Actuators
from services.sim_air.engine.airframe import Airframe
from services.sim_air.engine.states import InitialState
from services.sim_air.engine.wiring import Controls
from uvf.maths import rotations

ROTATION_SPEED = 17.0  # m/s, 6 % above the least speed of level flight
APPROACH = (19.0, -0.07, 0.4)  # m/s, path [rad], flap [rad]
FLARE_HEIGHT = 3.0  # m
CALM = np.zeros(3)


@dataclass(frozen=True)
class Sight:
    """What the pilot sees; m, s, rad; nose up and to the right of the strip's middle are positive."""

    t: float
    along: float
    right: float
    height: float  # of the wheels over the strip
    airspeed: float
    roll: float
    pitch: float
    heading: float  # right of the strip's
    sink: float
    rates: tuple[float, float, float]  # FRD
    wheels: tuple[str, ...]
    structure: tuple[str, ...]


class Moment(NamedTuple):
    """What the pilot saw, and where the controls were."""

    sight: Sight
    controls: Controls


Pilot = Callable[[Sight], Controls]


class Strip:
    """One aircraft and what has been seen of it."""

    def __init__(self) -> None:
        assert BODY is not None
        self.airframe = Airframe(FOLDER, BODY, TANGENT)
        self.log: list[Moment] = []
        self._dt = 1 / BODY.physics_hz
        self._actuators = Actuators(Controls(), BODY)
        self._standing_height = 0.0

    def stand(self) -> None:
        """Puts the aircraft on its wheels at the strip's begin, motor off."""
        self.airframe.stand(InitialState(np.zeros(3), 0.0, 0.0, CALM))
        self._standing_height = float(self.airframe.motion().position[2])

    def approach(self, along: float, height: float) -> None:
        """Trimmed on the path of APPROACH; the flaps come out as the pilot takes over."""
        self.stand()
        speed, path, _ = APPROACH
        trim = self.airframe.start(InitialState(np.array((along, 0.0, height + self._standing_height)), 0.0, speed, CALM, climb=path))
        assert BODY is not None
        self._actuators = Actuators(trim.controls, BODY)

    def fly(self, pilot: Pilot, seconds: float, until: Callable[[Sight], bool] = lambda _: False) -> Sight:
        """So many seconds [s], or until something is seen; the last sight."""
        for n in range(round(seconds / self._dt)):
            sight = self._look(n * self._dt)
            if until(sight):
                break
            controls = self._actuators.step(pilot(sight), self._dt)
            self.airframe.command(controls)
            self.airframe.step()
            self.log.append(Moment(sight, controls))
        return self.log[-1].sight

    def _look(self, t: float) -> Sight:
        motion, touches = self.airframe.motion(), self.airframe.touches()
        roll, pitch, yaw = rotations.to_euler(motion.world_from_body)
        (x, y, z), (p, q, r) = motion.position.tolist(), motion.angular_velocity.tolist()
        wheels, structure = (tuple(touch.name for touch in touches if touch.carries is kind) for kind in (True, False))
        seen = (x, -y, z - self._standing_height, motion.airspeed, float(roll), -float(pitch), -float(yaw), -float(motion.velocity[2]))
        return Sight(t, *seen, (p, -q, -r), wheels, structure)


def steer(sight: Sight, pitch: float) -> tuple[float, float, float]:
    """Aileron, elevator, rudder that hold the wings level, this pitch, and the middle of the strip."""
    p, q, r = sight.rates
    aileron = -0.5 * sight.roll - 0.1 * p
    elevator = -0.15 + 2.5 * (sight.pitch - pitch) + 0.25 * q
    gain = 10.0 / max(sight.airspeed, 5.0)  # a fast wheel turns the nose more
    rudder = gain * (0.5 * sight.heading + 0.15 * r + 0.03 * sight.right)
    return aileron, elevator, rudder


def take_off(sight: Sight) -> Controls:
    """Full power within a second; the nose stays down until ROTATION_SPEED, then up to 9 degrees."""
    aileron, elevator, rudder = steer(sight, 0.16 if lifted(sight) else 0.22)
    if sight.airspeed < ROTATION_SPEED and not lifted(sight):
        elevator = 0.0
    return Controls(aileron, elevator, rudder, min(sight.t, 1.0))


class Landing:
    """Down the path of APPROACH with power, flare without, nose down, brakes."""

    def __init__(self, along: float, height: float) -> None:
        self._from = along, height
        self._flaring = self._down = False

    def __call__(self, sight: Sight) -> Controls:
        """What the phase asks for; it only goes on, from approach to flare to ground roll."""
        speed, path, flap = APPROACH
        along, height = self._from
        self._flaring = self._flaring or sight.height < FLARE_HEIGHT
        self._down = self._down or len(sight.wheels) >= 2
        if self._down:
            aileron, _, rudder = steer(sight, 0.0)
            return Controls(aileron, 0.0, rudder, 0.0, flap, 0.6 if len(sight.wheels) == 3 else 0.0)
        if self._flaring:  # the nose comes up as the ground comes near
            aileron, elevator, rudder = steer(sight, 0.17 - 0.04 * max(sight.height, 0.0))
            return Controls(aileron, elevator, rudder, 0.0, flap)
        above = sight.height - (height + np.tan(path) * (sight.along - along))
        aileron, elevator, rudder = steer(sight, 0.02 - 0.02 * above + 0.03 * (sight.sink + speed * np.sin(path)))
        return Controls(aileron, elevator, rudder, min(max(0.55 + 0.1 * (speed - sight.airspeed), 0.0), 1.0), flap)


def lifted(sight: Sight) -> bool:
    """Whether no wheel touches, and the aircraft is more than 2 cm up."""
    return not sight.wheels and sight.height > 0.02


def stopped(sight: Sight) -> bool:
    """Whether it stands on its three wheels; in the first second it never does."""
    return len(sight.wheels) == 3 and sight.airspeed < 0.05 and sight.t > 1.0


def flown_take_off() -> Strip:
    """15 s from standing on the strip."""
    strip = Strip()
    strip.stand()
    strip.fly(take_off, 15.0)
    return strip


def flown_landing() -> Strip:
    """From 250 m before the strip and 20 m above it until it stands."""
    strip = Strip()
    strip.approach(-250.0, 20.0)
    strip.fly(Landing(-250.0, 20.0), 60.0, stopped)
    return strip


def ground_runs(_: Path | None) -> dict[str, dict[str, float]]:
    """A row each for take-off and landing: times [s], ways [m] and speeds [m/s]."""
    off, on = flown_take_off(), flown_landing()
    lift = next(m.sight for m in off.log if lifted(m.sight))
    touch = next(m.sight for m in on.log if m.sight.wheels)
    return {
        "take-off": {"s": lift.t, "m": lift.along, "m/s": lift.airspeed, "from the middle m": max(abs(m.sight.right) for m in off.log)},
        "landing": {
            "s": on.log[-1].sight.t - touch.t,
            "m": on.log[-1].sight.along - touch.along,
            "m/s": touch.airspeed,
            "sink m/s": touch.sink,
            "from the middle m": max(abs(m.sight.right) for m in on.log),
        },
    }


def plot(path: Path) -> None:
    """Airspeed, height, attitude and controls of both over time [s]."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10, 8), layout="constrained")
    grid = figure.subplots(4, 2, sharex="col")
    for column, (name, strip) in enumerate({"take-off": flown_take_off(), "landing": flown_landing()}.items()):
        t = [m.sight.t for m in strip.log]
        rows: list[dict[str, list[float]]] = [
            {"airspeed [m/s]": [m.sight.airspeed for m in strip.log]},
            {"height [m]": [m.sight.height for m in strip.log], "wheels on the ground": [len(m.sight.wheels) for m in strip.log]},
            {"pitch [deg]": [np.degrees(m.sight.pitch) for m in strip.log], "roll [deg]": [np.degrees(m.sight.roll) for m in strip.log]},
            {
                "elevator [10 deg]": [np.degrees(m.controls.elevator) / 10 for m in strip.log],
                "throttle": [m.controls.throttle for m in strip.log],
                "brake": [m.controls.brake for m in strip.log],
                "flap [rad]": [m.controls.flap for m in strip.log],
            },
        ]
        changes = [m.sight.t for m, n in zip(strip.log, strip.log[1:], strict=False) if bool(m.sight.wheels) != bool(n.sight.wheels)]
        for axes, lines in zip(grid[:, column], rows, strict=True):
            for label, values in lines.items():
                axes.plot(t, values, label=label)
            for change in changes:
                axes.axvline(change, color="0.5", lw=0.8, ls="--")
            axes.grid(alpha=0.3)
            axes.legend(fontsize=8)
        grid[0, column].set_title(f"{name}; dashed: wheels leave or meet the ground")
        grid[-1, column].set_xlabel("t [s]")
    figure.savefig(path, dpi=100)


CASES = {"ground runs": ground_runs}

if __name__ == "__main__":
    plot(Path(sys.argv[1]))
