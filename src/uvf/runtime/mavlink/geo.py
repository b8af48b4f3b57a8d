"""Between the world's frame and MAVLink's latitude, longitude and altitude above mean sea level."""

import numpy as np

from schemas.messages import Vector3
from uvf.maths.geodesy import Floats, LocalTangent
from uvf.mavlink import dialect as mav

AMSL_FRAMES = (mav.MAV_FRAME_GLOBAL, mav.MAV_FRAME_GLOBAL_INT)
HOME_FRAMES = (mav.MAV_FRAME_GLOBAL_RELATIVE_ALT, mav.MAV_FRAME_GLOBAL_RELATIVE_ALT_INT)


class GeoPosition:
    """Converts positions of a vehicle's world with an ``origin``, the altitude of which counts as above mean sea level."""

    origin: LocalTangent

    @property
    def is_ground(self) -> bool:
        """Whether it is a ground vehicle; to be implemented by subclasses."""
        raise NotImplementedError

    def geodetic(self, position: Floats) -> tuple[float, float, float]:
        """(latitude [deg], longitude [deg], altitude [m AMSL]) of a world position (3,) [m, ENU]."""
        latitude, longitude, _ = self.origin.geodetic(np.array((position[0], position[1], 0.0)))
        return float(np.degrees(latitude)), float(np.degrees(longitude)), float(position[2]) + self.origin.altitude

    def world(self, latitude: float, longitude: float, altitude: float) -> Vector3:
        """World position (x, y, z) [m, ENU] of a latitude and longitude [deg] and an altitude [m AMSL]; the inverse of ``geodetic``."""
        x, y, _ = self.origin.enu(float(np.radians(latitude)), float(np.radians(longitude)), self.origin.altitude)
        return Vector3(x=float(x), y=float(y), z=altitude - self.origin.altitude)
