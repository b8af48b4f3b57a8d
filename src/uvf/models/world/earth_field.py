"""The magnetic field of the Earth at a place."""

from math import cos, radians, sin

from uvf.models.world.file import Origin

GAUSS = 1e-4  # T
LAST = 179.999  # deg, for the tables end before the date line and the pole
POLE = 89.999


def earth_field(place: Origin) -> tuple[float, float, float]:
    """Magnetic field [T], ENU, at the place: declination, inclination and strength from the tables of autopilots (pymavlink).

    They are of the World Magnetic Model, every 10 degrees, straight between: within a degree or two but for the poles' surroundings.
    """
    from pymavlink.mavextra import get_mag_field_ef  # 0.2 s, for those alone who make worlds

    latitude, longitude = min(max(place.latitude, -POLE), POLE), min(max(place.longitude, -LAST), LAST)
    declination, inclination, gauss = get_mag_field_ef(latitude, longitude)
    east, dips, size = radians(declination), radians(inclination), GAUSS * gauss
    return size * cos(dips) * sin(east), size * cos(dips) * cos(east), -size * sin(dips)
