"""Exploration: the frontier that is driven to now, those left alone for a while, and the patrol when all is known."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.grids import distance_field
from uvf.planning.costmap.costmap import Costmap
from uvf.planning.frontiers import Frontier, FrontierWeights, frontier_mask, frontiers
from uvf.planning.search.grid_search import CostToGo

Mask = NDArray[np.bool_]
Point = tuple[float, float]

APART = 2.5  # m from where another vehicle goes to explore, within which that one sees it too
SHUN_RADIUS = 0.5  # m
SHUN_TIME = 30.0  # s, tripled with each further time at the same place
STILL_THERE = 0.7  # m from the goal within which the frontier must remain
EASY = 32
"""Values below are at ease: far enough from every obstacle to stand there."""
PATROL_REST = 1.5  # m, when no place is farther from those visited, the round begins again


class OthersGoal(NamedTuple):
    """Where another vehicle goes to explore [m, map frame], and whether it is asked first."""

    place: Point
    comes_first: bool


@dataclass
class Shunned:
    """A goal left alone until a time [s], and how often it was shunned again."""

    point: Point
    until: float
    times: int


@dataclass
class Explorer:
    """Chooses frontiers as goals in the map frame; keeps one as long as its frontier is there."""

    taste: FrontierWeights
    goal: Point | None = None
    explored: float = 0.0
    """Estimate of the known part of the floor that can be reached, 0..1."""
    _shunned: list[Shunned] = field(default_factory=list)

    def choose(self, t: float, costs: Costmap, ways: CostToGo, others: Sequence[OthersGoal] = ()) -> Point | None:
        """The goal [m, map frame] to go to at ``t`` [s], None when there is nothing left to explore.

        others: where the rest of the team goes; a frontier that none of them goes to comes first (Burgard et al. 2005).
        """
        found = frontiers(costs, ways.cost, self._shunned_mask(t, costs), self.taste)
        left = frontiers(costs, ways.cost, self._shunned_mask(t, costs, again=True), self.taste) if self._shunned else found
        self.explored = self._estimate(costs, ways, sum(f.size for f in left))
        places = [_place(costs, frontier) for frontier in found]
        if not places:
            self.goal = None
        elif self.goal is None or not self.still_worth_it(t, costs) or self._gives_way(others, places):
            self.goal = next((place for place in places if not _is_taken(place, others)), places[0])
        return self.goal

    def _gives_way(self, others: Sequence[OthersGoal], places: Sequence[Point]) -> bool:
        """Whether somebody who comes first goes to the same frontier, and there is another one."""
        prior = [other for other in others if other.comes_first]
        return self.goal is not None and _is_taken(self.goal, prior) and not all(_is_taken(place, others) for place in places)

    def still_worth_it(self, t: float, costs: Costmap) -> bool:
        """Whether at ``t`` [s] enough frontier is left about the goal."""
        if self.goal is None:
            return False
        near = disc(costs, self.goal, STILL_THERE) & ~self._shunned_mask(t, costs)
        return int((frontier_mask(costs) & near).sum()) >= self.taste.least_size

    def blacklist_goal(self, t: float) -> None:
        """Gives up the goal at ``t`` [s], reached or not: frontier that is left there does not count for a while."""
        if self.goal is None:
            return
        for old in self._shunned:
            if np.hypot(old.point[0] - self.goal[0], old.point[1] - self.goal[1]) < SHUN_RADIUS:
                old.times += 1
                old.until = t + SHUN_TIME * 3**old.times
                break
        else:
            self._shunned.append(Shunned(self.goal, t + SHUN_TIME, 0))
        self.goal = None

    def _shunned_mask(self, t: float, costs: Costmap, again: bool = False) -> Mask:
        """Where frontiers do not count; again: only for those shunned more than once, for the others are yet to be explored."""
        mask = np.zeros(costs.values.shape, dtype=np.bool_)
        for place in self._shunned:
            if place.until > t and (place.times > 0 or not again):
                mask |= disc(costs, place.point, SHUN_RADIUS + self.taste.view)
        return mask

    def _estimate(self, costs: Costmap, ways: CostToGo, frontier_cells: int) -> float:
        """Behind each frontier cell about a metre of floor is taken to be hidden."""
        known = int(np.isfinite(ways.cost).sum())
        return known / max(known + frontier_cells / costs.resolution, 1)


@dataclass
class Patrol:
    """Goals for when everything is explored: the place farthest from those visited, round after round."""

    goal: Point | None = None
    _visited: list[Point] = field(default_factory=list)

    def choose(self, here: Point, costs: Costmap, ways: CostToGo) -> Point | None:
        """The goal [m, map frame] to go to; kept until ``reached`` or until no path leads there."""
        if self.goal is not None and costs.holds(cell := costs.cell(*self.goal)) and np.isfinite(ways.cost[cell]):
            return self.goal
        easy = np.isfinite(ways.cost) & (costs.values < EASY)
        if not easy.any():
            return None
        distance = np.where(easy, self._distance([*self._visited, here], costs), -1.0)
        if distance.max() < PATROL_REST:
            self._visited.clear()
            distance = np.where(easy, self._distance([here], costs), -1.0)
        farthest = np.array(np.unravel_index(int(np.argmax(distance)), distance.shape))
        x, y = costs.points(farthest[None])[0]
        self.goal = (float(x), float(y))
        return self.goal

    def reached(self) -> None:
        """Marks the goal as visited, or given up."""
        if self.goal is not None:
            self._visited.append(self.goal)
        self.goal = None

    def _distance(self, points: list[Point], costs: Costmap) -> NDArray[np.float64]:
        marks = np.zeros(costs.values.shape, dtype=np.bool_)
        for point in points:
            if costs.holds(costs.cell(*point)):
                marks[costs.cell(*point)] = True
        return distance_field(marks) * costs.resolution


def disc(costs: Costmap, centre: Point, radius: float) -> Mask:
    """Mask (rows, columns) of the cells whose centres lie within ``radius`` [m] of a point [m, map frame]."""
    rows, columns = costs.values.shape
    x = costs.origin[0] + (np.arange(columns) + 0.5) * costs.resolution - centre[0]
    y = costs.origin[1] + (np.arange(rows) + 0.5) * costs.resolution - centre[1]
    inside: Mask = y[:, None] ** 2 + x[None, :] ** 2 <= radius * radius
    return inside


def _place(costs: Costmap, frontier: Frontier) -> Point:
    x, y = costs.points(np.array([frontier.goal]))[0].tolist()
    return x, y


def _is_taken(place: Point, others: Sequence[OthersGoal]) -> bool:
    return any(np.hypot(place[0] - x, place[1] - y) < APART for (x, y), _ in others)
