"""How good the estimate is, and the wind with its uncertainty."""

import math

from schemas.messages import EstimateQuality
from services.autopilot.mavlink.connection.facts import VehicleInfo, VehicleState
from uvf.mavlink import dialect as mav
from uvf.mavlink.scaling import whole
from uvf.runtime.messages.convert import array

Message = mav.MAVLink_message | None
HORIZONTAL = mav.ESTIMATOR_POS_HORIZ_REL | mav.ESTIMATOR_PRED_POS_HORIZ_REL | mav.ESTIMATOR_VELOCITY_HORIZ
ABSOLUTE = mav.ESTIMATOR_POS_HORIZ_ABS | mav.ESTIMATOR_PRED_POS_HORIZ_ABS
VERTICAL = mav.ESTIMATOR_VELOCITY_VERT | mav.ESTIMATOR_POS_VERT_ABS


def estimator_status(facts: VehicleInfo, latest: VehicleState, t: float) -> Message:
    """ESTIMATOR_STATUS at ``t`` [s, since the link's start]; None without an estimate.

    Ratios [-] as PX4 has them: innovation over its gate, above 1 rejected; NaN where nothing is compared or reported.
    """
    if latest.nav is None:
        return None
    told = latest.fresh(latest.quality)
    velocity, place, height, field, airspeed = _ratios(told)
    height_sigma = math.nan if told is None else told.height_sigma
    flags = mav.ESTIMATOR_CONST_POS_MODE if latest.is_silent else _flags(facts, told)
    sigma = latest.nav.position_sigma
    usec = whole(t * 1e6, (0, 2**63))
    return mav.MAVLink_estimator_status_message(usec, flags, velocity, place, height, field, math.nan, airspeed, sigma, height_sigma)


def _flags(facts: VehicleInfo, told: EstimateQuality | None) -> int:
    """Without a word on its quality the estimate of a ground vehicle is that of its map."""
    flags = mav.ESTIMATOR_ATTITUDE | HORIZONTAL
    flags |= ABSOLUTE if told is None or told.position_known else 0
    flags |= VERTICAL if not facts.is_ground and (told is None or told.height_known) else 0
    flags |= mav.ESTIMATOR_GPS_GLITCH if told is not None and max(told.position_ratio, told.velocity_ratio) > 1 else 0
    return int(flags)


def _ratios(told: EstimateQuality | None) -> tuple[float, ...]:
    """Velocity, horizontal and vertical position, magnetometer, airspeed. Ours are the squares."""
    if told is None:
        return (math.nan,) * 5
    squares = told.velocity_ratio, told.position_ratio, told.height_ratio, told.field_ratio, told.airspeed_ratio
    return tuple(math.sqrt(s) if s >= 0 else math.nan for s in squares)


def wind(facts: VehicleInfo, latest: VehicleState, t: float) -> Message:
    """WIND_COV: wind velocity [m/s, NED] at ``t`` [s], of aircraft only; no vertical wind is estimated."""
    if latest.nav is None or facts.is_ground:
        return None
    east, north, _ = array(latest.nav.wind)
    told = latest.fresh(latest.quality)
    sigma = told.wind_sigma if told is not None else math.nan
    height = latest.nav.position.z + facts.origin.altitude
    nan = math.nan
    return mav.MAVLink_wind_cov_message(whole(t * 1e6, (0, 2**63)), north, east, nan, sigma**2, nan, height, sigma, nan)
