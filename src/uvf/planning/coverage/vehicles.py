"""What covers a field: an aircraft, which turns outside of it and flies over holes, or a ground vehicle, which stays inside."""

import math
from dataclasses import dataclass

from uvf.planning.coverage.ground_speed import GroundSpeed
from uvf.planning.coverage.transits import Motion


@dataclass(frozen=True)
class SurveyAircraft:
    """A fixed-wing aircraft: ``speed`` of its airspeed in the wind, turn ``radius`` [m] over ground on every course.

    lead_in, lead_out: [m], flown straight on before each swath, to be level on it, and after it.
    """

    speed: GroundSpeed
    radius: float
    lead_in: float = 0.0
    lead_out: float = 0.0

    def __post_init__(self) -> None:
        """Raises ValueError for lengths below 0 or without end."""
        for name, value in (("turn radius", self.radius), ("lead-in", self.lead_in), ("lead-out", self.lead_out)):
            if not 0.0 <= value < math.inf:
                raise ValueError(f"a {name} of {value:g} m; give 0 or more")

    @property
    def motion(self) -> Motion:
        """How it moves, for the kernels."""
        return Motion(self.radius, self.speed.table, self.speed.airspeed, self.speed.wind)

    @property
    def turn_length(self) -> float:
        """Length [m] of the shortest turn back to a neighbouring track, with lead-in and lead-out."""
        return math.pi * self.radius + self.lead_in + self.lead_out


@dataclass(frozen=True)
class GroundVehicle:
    """A ground vehicle at ``speed`` [m/s] that never leaves the field; ``radius`` [m] of its turns, 0: on the spot.

    headlands: passes along every border, within which the swaths lie. A vehicle that does not turn on the spot turns on them, where
    there is room, and beyond them elsewhere.
    """

    speed: float
    radius: float = 0.0
    headlands: int = 1

    def __post_init__(self) -> None:
        """Raises ValueError for what no vehicle has."""
        if not 0.0 < self.speed < math.inf:
            raise ValueError(f"a speed of {self.speed:g} m/s; give a positive one")
        if not 0.0 <= self.radius < math.inf:
            raise ValueError(f"a turn radius of {self.radius:g} m; give 0 or more")
        if not 0 <= self.headlands <= 100:
            raise ValueError(f"{self.headlands} headland passes; give 0 to 100")

    @property
    def motion(self) -> Motion:
        """How it moves, for the kernels."""
        return Motion(self.radius, GroundSpeed(self.speed).table, self.speed, (0.0, 0.0))
