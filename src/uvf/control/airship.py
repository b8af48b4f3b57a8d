"""The control law of an airship (``law: airship``): the rudder turns it, pitch climbs, throttle holds the airspeed.

An airship hangs under its buoyancy: it does not bank to turn, and height costs it no energy. A bank that is asked for stands for the turn
rate that it would make, g / V tan(bank) (Beard & McLain 9.14), so that guidance and modes are those of an aeroplane. Khoury, "Airship
Technology", 2nd edition, chapter 4: controls of the conventional airship.
"""

import math

from uvf.control.attitude_loops import PitchLoop
from uvf.control.commands import AltitudeAirspeedSetpoint, AttitudeSetpoint, Surfaces
from uvf.control.cycle import STEEPEST, Cycle, clip
from uvf.control.servos import Servos, SurfaceTrim
from uvf.maths.filters import Integral
from uvf.maths.geodesy import GRAVITY

PITCH_TRIM_LIMIT = 0.15  # rad, of the integrator on pitch
THROTTLE_TRIM_LIMIT = 0.4  # of the integrator on throttle


class AirshipAttitude:
    """Turn rate to the rudder and pitch to the elevator, with their integrators; roll is left to the pendulum."""

    def __init__(self, servos: Servos) -> None:
        self._limit = servos.rudder.limit
        self._pitch = PitchLoop(servos)
        self._turn = SurfaceTrim(servos.rudder)

    def step(self, cycle: Cycle, wanted: AttitudeSetpoint) -> Surfaces:
        """Surface deflections [rad] and throttle [0..1] for one cycle; a rudder given is the whole of it."""
        if wanted.rudder is None:
            rudder = self._rudder(cycle, clip(wanted.bank, cycle.params.bank_limit))
        else:
            rudder = clip(wanted.rudder, self._limit)
        return Surfaces(0.0, self._pitch.step(cycle, wanted.pitch, 0.0), rudder, min(max(wanted.throttle, 0.0), 1.0))

    def _rudder(self, cycle: Cycle, bank: float) -> float:
        params = cycle.params
        rate = GRAVITY / cycle.speed * math.tan(bank)
        error = rate - cycle.now.r
        moving = math.sqrt(cycle.scale) * params.turn_ff * rate + cycle.scale * params.yaw_damping * error
        return self._turn.step(-moving, -cycle.scale, params.turn_i * error, cycle.dt)


class AirshipPath:
    """Height or climb rate to pitch, airspeed to throttle, with their integrators."""

    lacking = 0.0

    def __init__(self) -> None:
        self._pitch = Integral(PITCH_TRIM_LIMIT)
        self._throttle = Integral(THROTTLE_TRIM_LIMIT)

    def begin(self, cycle: Cycle, wanted: AltitudeAirspeedSetpoint, pitch: float, throttle: float) -> None:
        """Sets the integrators so that the first step asks for ``pitch`` [rad] and ``throttle`` [0..1], as far as limits allow."""
        self._pitch.value = self._throttle.value = 0.0
        self._pitch.value = clip(pitch - self._nose(cycle, _climb(cycle, wanted)), PITCH_TRIM_LIMIT)
        self._throttle.value = clip(throttle - self._power(cycle, wanted), THROTTLE_TRIM_LIMIT)

    def step(self, cycle: Cycle, wanted: AltitudeAirspeedSetpoint) -> tuple[float, float]:
        """Pitch [rad] and throttle [0..1] for one cycle. Integrators wait while what they move is at its limit."""
        params, climb = cycle.params, _climb(cycle, wanted)
        pitch, error = self._nose(cycle, climb), (climb - cycle.now.climb) / cycle.speed
        if abs(pitch) < params.pitch_limit or error * pitch < 0:
            self._pitch.step(params.climb_i * error, cycle.dt)
        if wanted.throttle is not None:
            return clip(pitch, params.pitch_limit), wanted.throttle
        throttle, slower = self._power(cycle, wanted), _faster(cycle, wanted)
        if 0 < throttle < 1 or slower * (throttle - 0.5) < 0:
            self._throttle.step(params.power_pole * params.throttle_speed * slower, cycle.dt)
        return clip(pitch, params.pitch_limit), min(max(throttle, 0.0), 1.0)

    def _nose(self, cycle: Cycle, climb: float) -> float:
        path = math.asin(clip(climb / cycle.speed, STEEPEST))
        return path + cycle.alpha + cycle.params.climb_p * (climb - cycle.now.climb) / cycle.speed + self._pitch.value

    def _power(self, cycle: Cycle, wanted: AltitudeAirspeedSetpoint) -> float:
        params, error = cycle.params, _faster(cycle, wanted)
        level = params.trim_throttle + params.throttle_speed * (cycle.now.airspeed + error - params.trim_airspeed)
        pushed = params.airspeed_p * error * cycle.speed / GRAVITY * params.throttle_climb
        return level + pushed + self._throttle.value


def _climb(cycle: Cycle, wanted: AltitudeAirspeedSetpoint) -> float:
    """m/s asked for, within the vehicle's limits."""
    params = cycle.params
    higher = 0.0 if wanted.height is None else wanted.height - cycle.now.height
    return min(max(wanted.climb + params.altitude_p * higher, -params.sink_max), params.climb_max)


def _faster(cycle: Cycle, wanted: AltitudeAirspeedSetpoint) -> float:
    """m/s of airspeed that are wanting, of one within the vehicle's limits."""
    return min(max(wanted.airspeed, cycle.params.min_airspeed), cycle.params.max_airspeed) - cycle.now.airspeed
