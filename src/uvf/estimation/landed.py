"""Whether the aircraft is in the air, from what it estimates; nothing tells it that its wheels carry it."""

from uvf.estimation.state import Estimate
from uvf.models.vehicle.flight_params import AirParams

LIFTS = 0.7  # of min_airspeed, through the air
ROLLS = 3.0  # m/s over ground: an aircraft that stands in a gale does not fly
RESTS = 2.0  # m/s over ground
SETTLES = 1.0  # s at rest


class LandDetector:
    """Whether the aircraft is airborne: from the take-off run on, until it rests without the airspeed to hover in a headwind."""

    def __init__(self, airborne: bool) -> None:
        self.airborne = airborne
        self._rested = 0.0  # s

    def step(self, now: Estimate, params: AirParams, dt: float) -> None:
        """Takes one estimate, ``dt`` [s] after the last, and sets ``airborne``."""
        if not self.airborne:
            self.airborne = now.airspeed > LIFTS * params.min_airspeed and now.ground_speed > ROLLS
            return
        rests = now.ground_speed < RESTS and abs(now.climb) < RESTS and now.airspeed < params.min_airspeed
        self._rested = self._rested + dt if rests else 0.0
        self.airborne = self._rested < SETTLES
