"""An aircraft on its wheels: straight along a line with rudder and nose wheel, wings level."""

import math
from dataclasses import replace

from uvf.control.commands import AttitudeSetpoint, Surfaces
from uvf.estimation.state import Estimate

STEER_SPEED = 10.0  # m/s for which the gains hold: a fast wheel turns the nose more
SLOWEST = 5.0  # m/s
PER_HEADING, PER_RATE, PER_METRE = 0.5, 0.15, 0.03  # rad of rudder per rad, rad/s and m
PER_ROLL, PER_ROLL_RATE = 0.5, 0.1  # rad of aileron per rad and rad/s
MOST_ASIDE = 5.0  # m
FURTHEST = 0.44  # rad of rudder


class Gyros:
    """The attitude by the gyroscopes alone, for some seconds: while it speeds up or brakes, accelerometers do not tell what is down."""

    def __init__(self, now: Estimate) -> None:
        """From wings level."""
        self._roll, self._pitch, self._yaw = 0.0, now.pitch, now.yaw

    def step(self, now: Estimate, dt: float) -> Estimate:
        """The estimate with roll, pitch and yaw [rad] replaced by the angular rates p, q, r integrated over ``dt`` [s]."""
        self._roll += now.p * dt
        self._pitch += now.q * dt
        self._yaw += now.r * dt
        return replace(now, roll=self._roll, pitch=self._pitch, yaw=self._yaw)


def held(now: Estimate, by_gyros: Estimate, wanted: AttitudeSetpoint) -> AttitudeSetpoint:
    """Attitude setpoint for loops that look at the estimate ``now``, such that the attitude by the gyroscopes becomes ``wanted``."""
    return replace(wanted, bank=wanted.bank + now.roll - by_gyros.roll, pitch=wanted.pitch + now.pitch - by_gyros.pitch)


def rolling(by_gyros: Estimate, rudder: float, throttle: float, brake: float = 0.0) -> Surfaces:
    """Surfaces of an aircraft on its wheels: wings level by aileron, elevator neutral; ``rudder`` [rad], throttle and brake [0..1]."""
    aileron = min(max(-PER_ROLL * by_gyros.roll - PER_ROLL_RATE * by_gyros.p, -FURTHEST), FURTHEST)
    return Surfaces(aileron, 0.0, rudder, throttle, brake=brake)


def rudder_along(now: Estimate, course: float, right: float) -> float:
    """Rudder [rad] that steers back to a line of ``course`` [rad, NED]; the aircraft is ``right`` [m] of the line (negative: left)."""
    gain = STEER_SPEED / max(now.ground_speed, SLOWEST)
    off = math.remainder(now.yaw - course, math.tau)
    aside = min(max(right, -MOST_ASIDE), MOST_ASIDE)
    asked = gain * (PER_HEADING * off + PER_RATE * now.r + PER_METRE * aside)
    return min(max(asked, -FURTHEST), FURTHEST)
