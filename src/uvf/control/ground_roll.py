"""An aircraft on its wheels: straight along a line with rudder and nose wheel, wings level."""

import math
from dataclasses import replace

from uvf.control.commands import AttitudeSetpoint, Surfaces
from uvf.control.cycle import Cycle, clip
from uvf.estimation.state import Estimate
from uvf.maths.atmosphere import RHO0
from uvf.maths.geodesy import GRAVITY
from uvf.models.vehicle.flight_params import AirParams

STEER_SPEED = 10.0  # m/s for which the gains hold: a fast wheel turns the nose more
SLOWEST = 5.0  # m/s
PER_HEADING, PER_RATE, PER_METRE = 0.5, 0.15, 0.03  # rad of rudder per rad, rad/s and m
PER_ROLL, PER_ROLL_RATE, MOST_SLOW = 0.5, 0.1, 2.5  # rad of aileron per rad and rad/s at cruise airspeed; how many times more slower
MOST_ASIDE = 5.0  # m
FURTHEST = 0.44  # rad of a surface
NOSE_SHARE = 0.5  # of the elevator that takes the load of the air off a nose wheel
TAIL_LOAD, TAIL_DROPS = 0.6, 1.3  # g that the wing carries while the tail comes down; of rest_pitch, where that load would need this much
BACK = 0.22  # rad of elevator: more takes the load off the wheels that brake
TAIL_HIGH = 0.08  # rad above the attitude at rest, from where on the elevator is not back any more: a gust has lifted it
TAIL_UP, TAIL_DOWN = 0.6, 0.9  # of the attitude at rest: between them the brakes of a tail-dragger give way, that it does not nose over
BRAKES_STEER, RUDDER_STEERS = 0.7, 1.0  # of min_airspeed: up to which the brakes steer where no wheel does, from which the rudder alone
STEERING_BRAKE = 0.4  # of the brakes, where they have to steer too: in front of the centre of gravity they turn it about
CARRIES, CARRIED = 0.95, 0.65  # of min_airspeed: the wings carry it too, or the wheels alone do


class Gyros:
    """The attitude by the gyroscopes alone, for some seconds: while it speeds up or brakes, accelerometers do not tell what is down."""

    def __init__(self, now: Estimate) -> None:
        """From the attitude of now."""
        self._roll, self._pitch, self._yaw = now.roll, now.pitch, now.yaw

    def step(self, now: Estimate, dt: float) -> Estimate:
        """The estimate with roll, pitch and yaw [rad] replaced by the angular rates integrated over ``dt`` [s] (Beard & McLain 3.3)."""
        turning = now.q * math.sin(self._roll) + now.r * math.cos(self._roll)
        pitching = now.q * math.cos(self._roll) - now.r * math.sin(self._roll)
        self._roll += (now.p + turning * math.tan(self._pitch)) * dt
        self._yaw += turning / math.cos(self._pitch) * dt
        self._pitch += pitching * dt
        return replace(now, roll=self._roll, pitch=self._pitch, yaw=self._yaw)


def held(now: Estimate, by_gyros: Estimate, wanted: AttitudeSetpoint) -> AttitudeSetpoint:
    """Attitude setpoint for loops that look at the estimate ``now``, such that the attitude by the gyroscopes becomes ``wanted``."""
    return replace(wanted, bank=wanted.bank + now.roll - by_gyros.roll, pitch=wanted.pitch + now.pitch - by_gyros.pitch)


def rolling(by_gyros: Estimate, params: AirParams, rudder: float, throttle: float, brake: float = 0.0) -> Surfaces:
    """Surfaces of an aircraft on its wheels: wings level by aileron; ``rudder`` [rad], throttle and brake [0..1].

    The elevator takes half of the air's load off a nose wheel, which steers better so than without any. A tail wheel is let down as the
    wing carries less, and then kept down. Brakes come on as the wheels carry, and give way before a tail rises.
    """
    part = by_gyros.airspeed / params.min_airspeed
    differing = clip(params.brake_steering * _share(part, RUDDER_STEERS, BRAKES_STEER) * rudder, 1.0)
    slow = min(params.trim_airspeed / max(by_gyros.airspeed, SLOWEST), MOST_SLOW)
    aileron = clip(-slow * (PER_ROLL * by_gyros.roll + PER_ROLL_RATE * by_gyros.p), FURTHEST)
    brake *= _share(part, CARRIES, CARRIED) * (1 - abs(differing)) * (STEERING_BRAKE if params.brake_steering else 1.0)
    if params.gear != "tail_wheel":
        elevator = NOSE_SHARE * clip(params.elev_zero_alpha + params.elev_per_alpha * by_gyros.pitch, FURTHEST)
        return Surfaces(aileron, elevator, rudder, throttle, brake=brake, brake_difference=differing)
    rest = params.rest_pitch
    down = _share(by_gyros.pitch, TAIL_UP * rest, TAIL_DOWN * rest)
    brake *= min(down, _share(by_gyros.pitch, rest + TAIL_HIGH, rest + TAIL_HIGH / 2))
    return Surfaces(aileron, _tail(by_gyros, params), rudder, throttle, brake=brake, brake_difference=differing * down)


def _tail(by_gyros: Estimate, params: AirParams) -> float:
    """Elevator [rad] that holds the attitude in which the wing carries a share of the weight, up to that at rest, and then goes back.

    Without the limits and the integrator of the loops of flight: slower than the wing carries those raise no nose, and the wheels hold too.
    """
    cycle = Cycle(by_gyros, params, 0.0)
    squared = max(by_gyros.airspeed, 1.0) ** 2 * by_gyros.density / RHO0
    alpha = params.alpha_zero_lift + params.alpha_per_load * TAIL_LOAD * GRAVITY / squared
    pitch = min(alpha, params.rest_pitch)
    rate = (pitch - by_gyros.pitch) / params.final_pitch_time
    moving = math.sqrt(cycle.scale) * (params.pitch_ff * rate + params.final_pitch_p * (rate - by_gyros.q))
    held = clip(params.elev_zero_alpha + params.elev_per_alpha * pitch - moving, FURTHEST)
    heavier = _share(alpha, params.rest_pitch, TAIL_DROPS * params.rest_pitch)
    high = _share(by_gyros.pitch - params.rest_pitch, 0.0, TAIL_HIGH)
    return held - heavier * (1 - high) * (BACK + held)


def _share(value: float, none: float, whole: float) -> float:
    """0 at ``none``, 1 at ``whole``, straight between."""
    return min(max((value - none) / (whole - none), 0.0), 1.0) if none != whole else 1.0


def rudder_along(now: Estimate, course: float, right: float) -> float:
    """Rudder [rad] that steers back to a line of ``course`` [rad, NED]; the aircraft is ``right`` [m] of the line (negative: left)."""
    gain = STEER_SPEED / max(now.ground_speed, SLOWEST)
    off = math.remainder(now.yaw - course, math.tau)
    aside = clip(right, MOST_ASIDE)
    return clip(gain * (PER_HEADING * off + PER_RATE * now.r + PER_METRE * aside), FURTHEST)
