"""What has to be in order before an aircraft is armed on the ground; each fault is a reason in words."""

import math
from collections.abc import Callable
from dataclasses import dataclass

from uvf.estimation.state import Estimate
from uvf.models.vehicle.flight_params import AirParams

POSITION = 10.0  # m, sigma
HEADING = 0.35  # rad, sigma
ACCURACY = 6.0  # m, of a fix
STALE_FIX = 1.0  # s
STILL = 2.0  # m/s over ground
TILT = 0.5  # rad, that no landing gear stands at
NO_WIND = 0.8  # of min_airspeed: more is no wind in which one takes off, but a fault
EARTH_FIELD = (15e-6, 75e-6)  # T


@dataclass(frozen=True, slots=True)
class PrearmInputs:
    """An aircraft on the ground."""

    now: Estimate
    params: AirParams
    gnss_age: float = 0.0  # s since the last fix
    accuracy: float = 0.0  # m, of the fixes
    charge: float = 1.0  # 0..1
    has_air_data: bool = True
    field: float = 0.0  # T, strength; 0 without a magnetometer
    fence_fault: str = ""
    mission_fault: str = ""


Check = Callable[[PrearmInputs], str]


def _estimator(s: PrearmInputs) -> str:
    now = s.now
    if now.position_sigma > POSITION:
        return f"position is known to {now.position_sigma:.0f} m only, {POSITION:g} m are needed: wait"
    unsure = s.field and now.yaw_sigma > HEADING  # without a compass the heading is found in motion
    return f"heading is known to {now.yaw_sigma:.1f} rad only: wait" if unsure else ""


def _gnss(s: PrearmInputs) -> str:
    if s.gnss_age > STALE_FIX:
        return "no satellite fix"
    return f"satellite fixes are good to {s.accuracy:.0f} m only" if s.accuracy > ACCURACY else ""


def _battery(s: PrearmInputs) -> str:
    return f"battery low: {100 * s.charge:.0f} %, {100 * s.params.battery_low:.0f} % are needed" if s.charge < s.params.battery_low else ""


def _air_data(s: PrearmInputs) -> str:
    if not s.has_air_data:
        return "no air data"
    fast = s.now.airspeed > NO_WIND * s.params.min_airspeed
    return f"airspeed reads {s.now.airspeed:.0f} m/s at rest: look at the pitot tube" if fast else ""


def _compass(s: PrearmInputs) -> str:
    low, high = EARTH_FIELD
    if s.field and not low < s.field < high:
        return f"magnetic field of {s.field * 1e6:.0f} uT is not the earth's: move away from iron and magnets"
    return "compass contradicts the other sensors" if s.now.ratios.field > 1 else ""


def _at_rest(s: PrearmInputs) -> str:
    if s.now.ground_speed > STILL:
        return f"it moves at {s.now.ground_speed:.1f} m/s over ground"
    tilt = max(abs(s.now.roll), abs(s.now.pitch))
    return f"it does not stand upright: {math.degrees(tilt):.0f} deg" if tilt > TILT else ""


CHECKS: tuple[tuple[str, Check], ...] = (
    ("estimator", _estimator),
    ("GNSS", _gnss),
    ("battery", _battery),
    ("air data", _air_data),
    ("compass", _compass),
    ("at rest", _at_rest),
    ("fence", lambda s: f"fence: {s.fence_fault}" if s.fence_fault else ""),
    ("mission", lambda s: f"mission: {s.mission_fault}" if s.mission_fault else ""),
)


def faults(standing: PrearmInputs) -> list[str]:
    """Why it should not be armed, in the order of ``CHECKS``."""
    return [why for _, check in CHECKS if (why := check(standing))]
