"""Where one takes off and lands: the strips of the world and home."""

import math
from collections.abc import Sequence
from functools import partial

from services.autopilot.air.modes.landing import Landing
from services.autopilot.air.modes.takeoff import TakeOff
from services.autopilot.air.setpoints import Senses
from uvf.estimation.state import Estimate
from uvf.guidance.approach import Approach
from uvf.guidance.route import Place
from uvf.guidance.runways import Strip, lane_by, lane_for
from uvf.models.vehicle.flight_params import AirParams

NEAR = 150.0  # m: an item this near to a strip means the strip


class Field:
    """Makes take-offs and landings for where the aircraft is."""

    def __init__(self, strips: Sequence[Strip]) -> None:
        self._strips = tuple(strips)

    def take_off(self, now: Estimate, height: float, senses: Senses) -> TakeOff:
        """height: m, world, at which it is done. On a strip there is the room that lies ahead on it."""
        on = next((s for s in self._strips if _distance(s, now.north, now.east) < s.length / 2), None)
        if on is None:
            return TakeOff(now, height, senses)
        lane = on.lane(now.yaw)
        distance, _ = lane.locate(now)
        return TakeOff(now, height, senses, lane.rest + distance)

    def landing(self, now: Estimate, home: Place, senses: Senses, params: AirParams) -> Landing:
        """On the nearest strip, without any at home."""
        place = Place(now.north, now.east, home.height) if self._strips else home
        return Landing(now, partial(lane_for, place, self._strips), senses, params)

    def landing_at(self, now: Estimate, place: Place, senses: Senses, params: AirParams, approach: Approach | None = None) -> Landing:
        """On the strip there, or on the place itself; by the approach that a mission lays down, whatever the wind."""
        if approach is not None:
            lane = lane_by(place, approach.course, self._strips)
            return Landing(now, lambda _: lane, senses, params, approach)
        near = [s for s in self._strips if _distance(s, place.north, place.east) < s.length / 2 + NEAR]
        return Landing(now, partial(lane_for, place, near), senses, params)


def _distance(strip: Strip, north: float, east: float) -> float:
    """m, from its middle."""
    return math.hypot(strip.middle.north - north, strip.middle.east - east)
