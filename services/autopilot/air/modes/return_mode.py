"""Mode Return: to a circle over home or a rally point, there down to another height, and after a while to a landing, as PX4's Return.

Without ``descend_alt`` it stays at the height at which it came; without ``land_delay`` it circles until somebody asks for something else.
"""

from dataclasses import replace

from services.autopilot.air.modes.paths import OWN, OrbitMode
from services.autopilot.air.setpoints import Setpoint
from uvf.estimation.state import Estimate
from uvf.guidance.route import Circle, Place
from uvf.models.vehicle.flight_params import AirParams

AT_HEIGHT = 5.0  # m


class ReturnMode(OrbitMode):
    """Its height follows the parameters until somebody asks for another one."""

    def __init__(self, to: Place, lowest: float, home: float, height: float) -> None:
        """lowest: over this place; home: of home; height: of the aircraft, below which it does not sink on its way. m, world."""
        super().__init__(Circle(replace(to, height=max(height, to.height)), 0.0), OWN)
        self._lowest, self._home, self._began = lowest, home, height
        self._given = self.circle.centre.height
        self._arrived = False
        self._waited = 0.0  # s

    def step(self, now: Estimate, params: AirParams, dt: float) -> Setpoint:
        if self.circle.centre.height == self._given:
            self._given = self._height(params)
            self.circle = replace(self.circle, centre=replace(self.circle.centre, height=self._given))
        wish = super().step(now, params, dt)
        self._arrived = self._arrived or self.circle.is_captured(now)
        there = self._arrived and abs(now.height - self.circle.centre.height) < AT_HEIGHT
        self._waited = self._waited + dt if there else self._waited
        if 0 <= params.land_delay <= self._waited:
            self.ended = "return: lands"
        return wish

    def _height(self, params: AirParams) -> float:
        """m, world."""
        comes = max(self._began, self._lowest, self._home + params.return_altitude)
        if not self._arrived or not params.descend_alt:
            return comes
        return min(comes, max(self._lowest, self._home + params.descend_alt, params.min_altitude))
