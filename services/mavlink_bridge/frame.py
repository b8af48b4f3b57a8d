"""Where the world lies on earth: a site's origin, or the home of the autopilot that tells it first."""

from dataclasses import dataclass

from uvf.maths.geodesy import LocalTangent
from uvf.runtime.mavlink.geo import GeoPosition


class BridgeOrigin:
    """The world's origin, common to all vehicles of an address."""

    def __init__(self, tangent: LocalTangent | None = None) -> None:
        self.tangent = tangent

    def settle(self, latitude: float, longitude: float, altitude: float) -> bool:
        """Sets the origin at latitude [deg], longitude [deg] and altitude [m AMSL], unless it is known; returns whether it did."""
        if self.tangent is not None:
            return False
        self.tangent = LocalTangent.from_degrees(latitude, longitude, altitude)
        return True


@dataclass(frozen=True)
class Chart(GeoPosition):
    """The world frame of a vehicle of a given kind."""

    origin: LocalTangent
    ground: bool

    @property
    def is_ground(self) -> bool:
        """Whether the vehicle is a ground vehicle."""
        return self.ground
