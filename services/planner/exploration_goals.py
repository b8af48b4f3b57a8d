"""Where a vehicle goes that explores: the frontiers of its map, and a patrol when there are none left."""

from collections.abc import Sequence

from uvf.planning.exploration import Explorer, OthersGoal, Patrol
from uvf.planning.frontiers import FrontierWeights
from uvf.planning.global_planner import GlobalPlanner

Point = tuple[float, float]

SETTLING = 3.0  # s that a vehicle stands before it explores: a gyroscope measured at rest turns its map by less
STANDS = "stands still for its gyroscope to be measured"


class ExplorationGoals:
    """One vehicle's; all points are (x, y) [m, map]."""

    def __init__(self, planner: GlobalPlanner, weights: FrontierWeights) -> None:
        self.explorer = Explorer(weights)
        self.is_shut_in = False
        """Whether nothing can be planned from where the vehicle stands."""
        self._planner, self._patrol = planner, Patrol()
        self._since: float | None = None

    def begin(self) -> None:
        """The vehicle begins to explore, or does something else from now on."""
        self.is_shut_in, self.explorer.goal = False, None

    def choose(self, t: float, here: Point, others: Sequence[OthersGoal]) -> tuple[Point | None, str]:
        """The goal at ``t`` [s] for a vehicle at ``here``, kept as long as it is worth it; None and why where none is."""
        self._since = t if self._since is None else self._since
        if t - self._since < SETTLING:
            return None, STANDS
        ways, costs, reason = self._planner.ways(here), self._planner.costs, self._planner.shut_in(here)
        self.is_shut_in = bool(reason)
        if reason or ways is None or costs is None:
            return None, reason
        target = self.explorer.choose(t, costs, ways, others) or self._patrol.choose(here, costs, ways)
        return target, "" if target else "everything is explored"

    def done(self, t: float) -> None:
        """The goal is reached, or given up, at ``t`` [s]; another one is to be chosen."""
        self.explorer.blacklist_goal(t)
        self._patrol.reached()
