"""One vehicle gives way to the rest of its team where a passage is too narrow for two."""

from dataclasses import replace

import numpy as np

from services.planner.team import Teammates
from uvf.maths.se2 import Pose2
from uvf.planning.navigation.directive import Action, Directive
from uvf.planning.navigation.global_routes import GlobalRoutes
from uvf.planning.navigation.right_of_way import AHEAD, Traveller, give_way, is_first_of_circle, that_meet
from uvf.planning.smoothing import from_place, way_along

BLURRED = 0.1  # m by which the map may show a vehicle of the team elsewhere


class GivingWay:
    """Of the vehicle of that name; radius: circumscribed [m]."""

    def __init__(self, name: str, radius: float, routes: GlobalRoutes) -> None:
        self.waits_for = ""
        """The vehicle that comes first through a narrow passage; "" while none does."""
        self._name, self._radius, self._routes = name, radius, routes

    def heed(self, directive: Directive, here: Pose2, team: Teammates) -> Directive:
        """The directive as far as the vehicle at ``here`` [map] may follow it now."""
        self.waits_for = ""
        travellers, waiting = (team.travellers, team.waiting) if directive.action == Action.FOLLOW else ([], {})
        others = [other for other in travellers if not is_first_of_circle(self._name, other.name, waiting)]
        if not others:
            return directive
        own, passed = from_place(directive.path, here[:2])
        traveller = Traveller(self._name, own[way_along(own) <= AHEAD], self._radius)
        others = that_meet(traveller, others)
        if not others:
            return directive
        clearance = self._routes.map_clearance(traveller.path, team.discs + np.array((0.0, 0.0, BLURRED)))
        wait = give_way(traveller, clearance, others)
        if wait is None:
            return directive
        self.waits_for = wait.for_whom
        return replace(directive, until=passed + wait.until)
