"""Servos: a rate limit, then a first-order lag."""

import math

from services.sim_air.wiring import Controls
from uvf.runtime.air_file import AirBody, Lever, Surface


class Servo:
    """One control surface [rad], or lever [0..1]."""

    def __init__(self, position: float, reach: tuple[float, float], rate: float, lag: float) -> None:
        """reach: its stops; rate: of its motion [1/s of what it moves]; lag: s."""
        self.position = position
        self._low, self._high = reach
        self._rate = rate
        self._lag = lag

    def step(self, command: float, dt: float) -> float:
        """Exact response of the lag over ``dt`` [s] to a held command, cut at the servo's rate."""
        target = min(max(command, self._low), self._high)
        move = (target - self.position) * (1 - math.exp(-dt / self._lag) if self._lag else 1.0)
        most = self._rate * dt
        self.position += min(max(move, -most), most)
        return self.position


class Actuators:
    """The servos of one aircraft; a motor follows its throttle at once unless its lag is given, the propeller's inertia is JSBSim's."""

    def __init__(self, start: Controls, body: AirBody) -> None:
        controls = body.controls
        self._servos = {name: _servo(getattr(controls, name), name, getattr(start, name), body) for name in controls.__struct_fields__}
        self.position = start

    def step(self, command: Controls, dt: float) -> Controls:
        """Where the surfaces are ``dt`` [s] later."""
        self.position = Controls(**{name: servo.step(getattr(command, name), dt) for name, servo in self._servos.items()})
        return self.position


def _servo(control: Surface | Lever, name: str, start: float, body: AirBody) -> Servo:
    if isinstance(control, Lever):
        return Servo(start, (0.0, 1.0), math.inf, control.lag)
    low = 0.0 if name == "flap" else -control.limit
    lag = body.servo_lag if control.lag is None else control.lag
    return Servo(start, (low, control.limit), control.rate or body.servo_rate, lag)
