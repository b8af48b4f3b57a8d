"""Servos: a rate limit, then a first-order lag."""

import math

from services.sim_air.airframe import Controls
from uvf.runtime.vehicle_file import AirBody


class Servo:
    """One control surface [rad]."""

    def __init__(self, position: float, limit: float, body: AirBody) -> None:
        self.position = position
        self._limit = limit
        self._rate = body.servo_rate
        self._lag = body.servo_lag

    def step(self, command: float, dt: float) -> float:
        """Exact response of the lag over ``dt`` [s] to a held command, cut at the servo's rate."""
        target = min(max(command, -self._limit), self._limit)
        move = (target - self.position) * (1 - math.exp(-dt / self._lag) if self._lag else 1.0)
        most = self._rate * dt
        self.position += min(max(move, -most), most)
        return self.position


class Actuators:
    """The servos of one aircraft; the motor follows its throttle at once, the propeller's inertia is JSBSim's."""

    def __init__(self, start: Controls, body: AirBody) -> None:
        self._aileron = Servo(start.aileron, body.max_aileron, body)
        self._elevator = Servo(start.elevator, body.max_elevator, body)
        self._rudder = Servo(start.rudder, body.max_rudder, body)
        self.position = start

    def step(self, command: Controls, dt: float) -> Controls:
        """Where the surfaces are ``dt`` [s] later."""
        self.position = Controls(
            self._aileron.step(command.aileron, dt),
            self._elevator.step(command.elevator, dt),
            self._rudder.step(command.rudder, dt),
            min(max(command.throttle, 0.0), 1.0),
        )
        return self.position
