"""WGS84 and the local tangent plane: latitude, longitude, altitude into ENU metres and back."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

A = 6_378_137.0  # m, semi-major axis
F = 1 / 298.257223563  # flattening
E2 = F * (2 - F)  # first eccentricity squared
B = A * (1 - F)  # m, semi-minor axis
GRAVITY = 9.80665  # m/s^2, standard


def ecef_from_geodetic(latitude: float, longitude: float, altitude: float) -> Floats:
    """ECEF position (3,) [m] of a WGS84 latitude and longitude [rad] and an altitude above the ellipsoid [m]."""
    n = A / np.sqrt(1 - E2 * np.sin(latitude) ** 2)
    x = (n + altitude) * np.cos(latitude) * np.cos(longitude)
    y = (n + altitude) * np.cos(latitude) * np.sin(longitude)
    z = (n * (1 - E2) + altitude) * np.sin(latitude)
    return np.array((x, y, z))


def geodetic_from_ecef(ecef: Floats) -> tuple[float, float, float]:
    """(latitude [rad], longitude [rad], altitude above the ellipsoid [m]) of an ECEF position (3,) [m].

    Bowring 1976, sub-millimetre near the Earth's surface.
    """
    x, y, z = ecef
    p = np.hypot(x, y)
    theta = np.arctan2(z * A, p * B)
    ep2 = (A * A - B * B) / (B * B)
    latitude = np.arctan2(z + ep2 * B * np.sin(theta) ** 3, p - E2 * A * np.cos(theta) ** 3)
    n = A / np.sqrt(1 - E2 * np.sin(latitude) ** 2)
    altitude = p * np.cos(latitude) + z * np.sin(latitude) - A * A / n
    return float(latitude), float(np.arctan2(y, x)), float(altitude)


@dataclass(frozen=True)
class LocalTangent:
    """The ENU frame that touches the ellipsoid at an origin: latitude [rad], longitude [rad], altitude [m]."""

    latitude: float
    longitude: float
    altitude: float

    @classmethod
    def from_degrees(cls, latitude: float, longitude: float, altitude: float) -> "LocalTangent":
        """Local tangent plane at a latitude and longitude [deg] and an altitude [m]."""
        return cls(float(np.radians(latitude)), float(np.radians(longitude)), altitude)

    @cached_property
    def enu_from_ecef(self) -> Floats:
        """Rotation matrix (3, 3) from ECEF to ENU axes."""
        sp, cp = np.sin(self.latitude), np.cos(self.latitude)
        sl, cl = np.sin(self.longitude), np.cos(self.longitude)
        return np.array(((-sl, cl, 0.0), (-sp * cl, -sp * sl, cp), (cp * cl, cp * sl, sp)))

    @cached_property
    def origin_ecef(self) -> Floats:
        """ECEF position (3,) [m] of the origin."""
        return ecef_from_geodetic(self.latitude, self.longitude, self.altitude)

    def enu(self, latitude: float, longitude: float, altitude: float) -> Floats:
        """ENU position (3,) [m] of a point at a latitude and longitude [rad] and an altitude [m]."""
        return self.enu_from_ecef @ (ecef_from_geodetic(latitude, longitude, altitude) - self.origin_ecef)

    def geodetic(self, enu: Floats) -> tuple[float, float, float]:
        """(latitude [rad], longitude [rad], altitude [m]) of an ENU position (3,) [m]; the inverse of ``enu``."""
        return geodetic_from_ecef(self.origin_ecef + self.enu_from_ecef.T @ enu)
