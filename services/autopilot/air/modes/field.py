"""Where one takes off and lands: the strips of the world and home."""

import math
from collections.abc import Sequence
from functools import partial

from services.autopilot.air.modes.landing import LandingMode
from services.autopilot.air.modes.takeoff import TakeoffMode
from services.autopilot.air.setpoints import FlightContext
from uvf.estimation.state import Estimate
from uvf.guidance.approach import Approach
from uvf.guidance.route import Place
from uvf.guidance.runways import LandingStrip, lane_by, lane_for
from uvf.models.vehicle.flight_params import AirParams

NEAR = 150.0  # m: an item this near to a strip means the strip


class Airfield:
    """Makes take-offs and landings for where the aircraft is."""

    def __init__(self, strips: Sequence[LandingStrip]) -> None:
        self._strips = tuple(strips)

    def take_off(self, now: Estimate, height: float, context: FlightContext) -> TakeoffMode:
        """A take-off that is done at ``height`` [m, world]. On a strip there is the room that lies ahead on it."""
        on = next((s for s in self._strips if _distance(s, now.north, now.east) < s.length / 2), None)
        if on is None:
            return TakeoffMode(now, height, context)
        lane = on.lane(now.yaw)
        distance, _ = lane.locate(now)
        return TakeoffMode(now, height, context, lane.rest + distance)

    def landing(self, now: Estimate, home: Place, context: FlightContext, params: AirParams) -> LandingMode:
        """On the nearest strip, without any at home."""
        place = Place(now.north, now.east, home.height) if self._strips else home
        return LandingMode(now, partial(lane_for, place, self._strips), context, params)

    def landing_at(
        self, now: Estimate, place: Place, context: FlightContext, params: AirParams, approach: Approach | None = None
    ) -> LandingMode:
        """On the strip there, or on the place itself; by the approach that a mission lays down, whatever the wind."""
        if approach is not None:
            lane = lane_by(place, approach.course, self._strips)
            return LandingMode(now, lambda _: lane, context, params, approach)
        near = [s for s in self._strips if _distance(s, place.north, place.east) < s.length / 2 + NEAR]
        return LandingMode(now, partial(lane_for, place, near), context, params)


def _distance(strip: LandingStrip, north: float, east: float) -> float:
    """m, from its middle."""
    return math.hypot(strip.middle.north - north, strip.middle.east - east)
