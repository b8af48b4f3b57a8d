"""Servos: a rate limit, then a first-order lag."""

import math
from dataclasses import replace

from services.sim_air.engine.wiring import Controls
from uvf.models.vehicle.air import AirBody, Lever, Surface

SERVOS = ("aileron", "elevator", "rudder", "throttle", "flap", "brake")
"""What one moves, in the order of Controls."""


class Servo:
    """A control surface [rad], or a lever [0..1]."""

    def __init__(self, position: float, reach: tuple[float, float], rate: float, lag: float) -> None:
        """reach: its stops; rate: of its motion [1/s of what it moves]; lag: s."""
        self.position = position
        self._low, self._high = reach
        self._rate = rate
        self._lag = lag
        self._dt, self._share = 0.0, 0.0

    def step(self, command: float, dt: float) -> float:
        """Position [rad or 0..1] after ``dt`` [s]: exact first-order response to a held ``command`` [rad or 0..1], rate-limited."""
        if dt != self._dt:
            self._dt, self._share = dt, 1 - math.exp(-dt / self._lag) if self._lag else 1.0
        target = min(max(command, self._low), self._high)
        move = (target - self.position) * self._share
        most = self._rate * dt
        self.position += min(max(move, -most), most)
        return self.position


class Actuators:
    """The servos of one aircraft. A motor follows its throttle at once unless its lag is given; JSBSim has the propeller's inertia."""

    def __init__(self, start: Controls, body: AirBody) -> None:
        controls = body.controls
        self._servos = [_servo(getattr(controls, name), name, getattr(start, name), body) for name in SERVOS]
        self.position = start

    def step(self, command: Controls, dt: float) -> Controls:
        """Deflections of the surfaces [rad] and levers [0..1] after ``dt`` [s]."""
        commands = (command.aileron, command.elevator, command.rudder, command.throttle, command.flap, command.brake)
        moved = Controls(*(servo.step(wanted, dt) for servo, wanted in zip(self._servos, commands, strict=True)))
        self.position = replace(moved, brake_difference=command.brake_difference) if command.brake_difference else moved
        return self.position


def _servo(control: Surface | Lever, name: str, start: float, body: AirBody) -> Servo:
    if isinstance(control, Lever):
        return Servo(start, (0.0, 1.0), math.inf, control.lag)
    low = 0.0 if name == "flap" else control.lowest()
    return Servo(start, (low, control.limit), control.rate or body.servo_rate or math.inf, body.lag_of(control))
