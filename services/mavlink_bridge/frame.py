"""Where the world lies on earth: a site's origin, or the home of the autopilot that tells it first."""

from dataclasses import dataclass

from uvf.maths.geodesy import LocalTangent
from uvf.runtime.mavlink.geo import GeoPosition


class BridgeOrigin:
    """One for all vehicles of an address."""

    def __init__(self, tangent: LocalTangent | None = None) -> None:
        self.tangent = tangent

    def settle(self, latitude: float, longitude: float, altitude: float) -> bool:
        """deg, deg, m AMSL: counts if nothing else has; returns whether it does."""
        if self.tangent is not None:
            return False
        self.tangent = LocalTangent.from_degrees(latitude, longitude, altitude)
        return True


@dataclass(frozen=True)
class Chart(GeoPosition):
    """A vehicle of a kind in such a world."""

    origin: LocalTangent
    ground: bool

    @property
    def is_ground(self) -> bool:
        return self.ground
