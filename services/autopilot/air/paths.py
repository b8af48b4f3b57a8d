"""Modes that follow a path: circles, and the legs of a mission."""

from services.autopilot.air.navigator import Navigator
from services.autopilot.air.params import AirParams
from services.autopilot.air.route import Circle
from services.autopilot.air.state import Estimate
from services.autopilot.air.wishes import Phase, Track, Wish


class Circling(Phase):
    """Round a circle at its height, for ever."""

    def __init__(self, circle: Circle, airspeed: float = 0.0) -> None:
        """airspeed: m/s, 0 = cruise."""
        self.circle = circle
        self._airspeed = airspeed

    def step(self, now: Estimate, params: AirParams, dt: float) -> Wish:
        return Wish(Track(self.circle.aim(now, params), self.circle.centre.height, 0.0, self._airspeed or params.trim_airspeed))


class Following(Phase):
    """The legs and circles of a mission, up to its end or to an item that is not one of them."""

    def __init__(self, navigator: Navigator) -> None:
        self._navigator = navigator

    def step(self, now: Estimate, params: AirParams, dt: float) -> Wish:
        aim, level = self._navigator.step(now, params, dt)
        return Wish(Track(aim, level.height, level.climb, self._navigator.speed or params.trim_airspeed))
