"""A second engine in the state of a first one: JSBSim cannot copy its state, and not all of it can be written.

What can be written is: the initial conditions, and every property that the model's catalogue calls writable. What cannot is reached
while the body is held still: propellers are driven to their speed by the throttle, and the last cycles are run at the commands that
hold, which fills the integrators' histories with the accelerations of this state. A filter inside the model's own flight control
begins at the steady output of its input.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from services.sim_air.engine.initial import EARTH_RATE, Engine
from services.sim_air.engine.wiring import Controls

HELD = 1.0  # s
CYCLES = 3  # of a turn
NEAR = 1e-4  # of a propeller's speed
WIND = tuple(f"atmosphere/wind-{axis}-fps" for axis in ("north", "east", "down"))
OTHERWISE = ("ic/", "simulation/", "position/", "orbital/", "velocities/", "attitude/", "accelerations/", "atmosphere/")
"""Set by the initial conditions and the settings, or moving others when they are written."""
SPEED = "propulsion/engine/propeller-rpm"
PLACES = {
    "lat-geod-rad": "position/lat-geod-rad",
    "h-sl-ft": "position/h-sl-ft",
    "terrain-elevation-ft": "position/terrain-elevation-asl-ft",
    "phi-rad": "attitude/phi-rad",
    "theta-rad": "attitude/theta-rad",
    "psi-true-rad": "attitude/psi-rad",
    "vn-fps": "velocities/v-north-fps",
    "ve-fps": "velocities/v-east-fps",
    "vd-fps": "velocities/v-down-fps",
    "p-rad_sec": "velocities/p-rad_sec",
    "q-rad_sec": "velocities/q-rad_sec",
    "r-rad_sec": "velocities/r-rad_sec",
}
"""Initial conditions and what they are taken from, in the order in which they are set."""


@dataclass(frozen=True)
class EngineState:
    """A saved state: all properties of the model by name, the last commands, and its time [s]."""

    values: Mapping[str, float]
    controls: Controls
    time: float

    def place(self, fdm: Engine, held: float) -> None:
        """Sets the initial conditions; held: time [s] for which the body will be held, while the Earth turns under it."""
        for initial, source in PLACES.items():
            fdm[f"ic/{initial}"] = self.values[source]
        fdm["ic/long-gc-rad"] = self.values["position/long-gc-rad"] + EARTH_RATE * held
        fdm.run_ic()

    def write(self, fdm: Engine) -> None:
        """Writes all properties that differ; unchanged ones are left alone, for some affect others when written."""
        for name in _writable(fdm):
            if (name in WIND or not name.startswith(OTHERWISE)) and fdm[name] != (value := self.values[name]) and np.isfinite(value):
                fdm[name] = value

    def settle(self, fdm: Engine, command: Callable[[Controls], None], turns: int) -> None:
        """Brings a body held still into the state: first the writable properties, then, in ``turns``, what takes time."""
        self.write(fdm)
        drive = EngineDrive(fdm, command, self)
        for left in range(turns, 0, -1):
            if left == 2:
                self.write(fdm)  # again: what has moved meanwhile
            drive.turn()


def _writable(fdm: Engine) -> list[str]:
    return [line.split(" ")[0] for line in fdm.query_property_catalog("").splitlines() if "(RW)" in line]


class EngineDrive:
    """Drives the propellers of a held body to a speed, in turns of three cycles, two of them at the commands that hold.

    Over a turn the speed's distance from the target goes as e' = a e + b u + c with the throttle u of its first cycle; a, b, c are
    fitted to the last three turns. All engines are driven alike, by the first one's speed.
    """

    def __init__(self, fdm: Engine, command: Callable[[Controls], None], state: EngineState) -> None:
        self._fdm = fdm
        self._command = command
        self._controls = state.controls
        self._target = state.values.get(SPEED)
        self._throttle = state.controls.throttle
        self._turns: list[tuple[float, float, float]] = []
        """rpm above the target before, throttle, rpm above the target after."""

    @property
    def off(self) -> float:
        """Propeller speed above the target [rpm]; 0 without a propeller."""
        return 0.0 if self._target is None else self._fdm[SPEED] - self._target

    def turn(self) -> None:
        """Makes one turn of CYCLES cycles."""
        before = self.off
        self._command(replace(self._controls, throttle=self._throttle))
        self._fdm.run()
        self._command(self._controls)
        for _ in range(CYCLES - 1):
            self._fdm.run()
        if abs(self.off) > NEAR * (self._target or np.inf):  # nearer, the turns are too much alike for a new fit
            self._turns = [*self._turns[-2:], (before, self._throttle, self.off)]
        self._throttle = min(max(self._next(), 0.0), 1.0)

    def _next(self) -> float:
        """The throttle that leads to the target."""
        if not self._target:
            return self._controls.throttle
        if len({throttle for _, throttle, _ in self._turns}) < 2 or len(self._turns) < 3:
            return 0.0 if self.off > 0 else 1.0
        e, u, after = np.array(self._turns).T
        a, b, c = np.linalg.lstsq(np.column_stack((e, u, np.ones(3))), after, rcond=None)[0]
        return float(-(a * self.off + c) / b) if b > 0 else self._throttle
