"""What fits into MAVLink's fields, what can be a place, and what of an autopilot's numbers and words the bus can carry."""

from schemas.messages import Vector3
from services.mavlink_bridge.frame import Chart
from uvf.runtime.mavlink.limits import HIGHEST, far_off

LARGEST = 1e9  # of any unit: a thousand of them together are below what a reader on the bus refuses
LARGEST_FLOAT = 3.4028234663852886e38  # of 32 bits
WHOLE_FLOAT = 2**24  # up to here each whole number is a 32-bit float


class OutOfLimits(Exception):
    """A request that cannot be sent to the autopilot; the text says why, and how to mend it."""


def where(chart: Chart, place: Vector3) -> tuple[float, float, float]:
    """Latitude [deg], longitude [deg], altitude [m AMSL] of a place (x, y, z) [m, world] for an autopilot. Raises OutOfLimits."""
    if reason := far_off(place):
        raise OutOfLimits(reason)
    latitude, longitude, _ = chart.geodetic((place.x, place.y, place.z))  # type: ignore[arg-type]
    return latitude, longitude, amsl(chart, place.z)


def amsl(chart: Chart, z: float) -> float:
    """Altitude [m AMSL] of the height ``z`` [m, world]. Raises OutOfLimits."""
    altitude = z + chart.origin.altitude
    if not abs(altitude) <= HIGHEST:
        raise OutOfLimits(f"an altitude of {altitude:g} m above sea level: name one within {HIGHEST:g} m")
    return altitude


def is_on_earth(latitude: float, longitude: float) -> bool:
    """Whether latitude and longitude [deg] told by an autopilot are possible."""
    return abs(latitude) <= 90.0 and abs(longitude) <= 180.0


def is_sound(*told: float) -> bool:
    """Whether numbers told by an autopilot, of any unit [-], are finite and below 1e9."""
    return all(abs(number) < LARGEST for number in told)
