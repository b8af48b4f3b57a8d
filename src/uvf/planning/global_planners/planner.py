"""What every global planner is asked, on one costmap: a path from a pose to a pose; and its answer, a path or a refusal with its kind."""

from dataclasses import dataclass
from enum import Enum
from math import isfinite, isnan
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from uvf.maths.curves.segments import Triple, checked_configuration, checked_radius

Floats = NDArray[np.float64]


class Refusal(Enum):
    """Why there is no path; Nav2's error codes of ComputePathToPose, and the one that a potential field has of its own."""

    START_OUTSIDE_MAP = "start outside map"
    GOAL_OUTSIDE_MAP = "goal outside map"
    START_OCCUPIED = "start occupied"
    GOAL_OCCUPIED = "goal occupied"
    NO_VALID_PATH = "no valid path"
    """There is none: that is sure for all planners but the hybrid ones, which look at so many poses and no more."""
    TIMED_OUT = "timed out"
    """None was found with what the planner may spend; one may exist."""
    LOCAL_MINIMUM = "local minimum"
    """The descent ends before the goal; another planner may find a path."""


@dataclass(frozen=True)
class GlobalPlannerSettings:
    """How a vehicle uses a costmap. Raises ValueError for figures that make no sense."""

    cost_travel_multiplier: float = 2.0
    """How much longer a path may be, 1 + this times, to stay out of the highest cost; for planners that weigh costs (Nav2: Smac)."""
    unknown_cost: float = -1.0
    """Factor on the length of a path over unknown ground, 1 or more; negative: it is not crossed."""
    minimum_turning_radius: float = 0.5
    """m, of the hybrid planners."""

    def __post_init__(self) -> None:
        """Checks the figures."""
        if not (isfinite(self.cost_travel_multiplier) and self.cost_travel_multiplier >= 0.0):
            raise ValueError(f"cost_travel_multiplier: {self.cost_travel_multiplier}; a finite number of 0 or more is needed")
        if not isfinite(self.unknown_cost) or 0.0 <= self.unknown_cost < 1.0:
            raise ValueError(f"unknown_cost: {self.unknown_cost}; 1 or more is needed, or a negative number where it is not crossed")
        checked_radius(self.minimum_turning_radius)


@dataclass(frozen=True)
class PathQuery:
    """What is asked: poses x, y [m, map frame], yaw [rad]. Raises ValueError for what is not finite, and negative figures."""

    start: Triple
    goal: Triple
    tolerance: float = 0.0
    """m: a start or goal that cannot be is moved to the nearest place that can be reached, up to so far; 0: it is refused."""
    seed: int = 0
    """Of the random numbers of sampling planners."""
    seconds: float = 5.0
    """Wall time that sampling planners and the visibility graph may take; searches on the grid are not ended early."""

    def __post_init__(self) -> None:
        """Checks the figures."""
        for what, at in (("start", self.start), ("goal", self.goal)):
            checked_configuration(what, at)
        if not (isfinite(self.tolerance) and self.tolerance >= 0.0):
            raise ValueError(f"tolerance: {self.tolerance} m; a finite number of 0 or more is needed")
        if self.seed < 0:
            raise ValueError(f"seed: {self.seed}; 0 or more is needed")
        if isnan(self.seconds) or self.seconds < 0.0:
            raise ValueError(f"seconds: {self.seconds} s; 0 or more is needed")


@dataclass(frozen=True)
class GlobalPath:
    """A path (n, 3): x, y [m, map frame], yaw [rad], poses no farther apart than a cell; or None, the kind of refusal and its reason.

    Yaws are those of travel, the last one the goal's; a hybrid planner's are the vehicle's, which may drive backwards.
    """

    path: Floats | None
    refusal: Refusal | None = None
    reason: str = ""

    @property
    def length(self) -> float:
        """Length [m], inf without a path."""
        return float(np.hypot(*np.diff(self.path[:, :2], axis=0).T).sum()) if self.path is not None else np.inf


class GlobalPathPlanner(Protocol):
    """Plans on one costmap and keeps what it has prepared of it; not for several threads at once."""

    def plan(self, query: PathQuery) -> GlobalPath:
        """The path from start to goal, the same for the same query unless time runs out."""
        ...
