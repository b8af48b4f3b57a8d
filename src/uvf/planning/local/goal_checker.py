"""Whether the vehicle is at its goal, and the turn to the heading that is wanted there."""

from dataclasses import dataclass
from math import hypot

from uvf.maths.kinematics import Twist
from uvf.maths.rotations import wrap
from uvf.planning.local.path_following import turn_rate_over
from uvf.planning.local.planner import Limits, State

Point = tuple[float, float]


@dataclass(frozen=True)
class GoalTolerances:
    """Nav2's parameters of the same names (SimpleGoalChecker)."""

    xy_goal_tolerance: float = 0.1  # m
    yaw_goal_tolerance: float = 0.1  # rad


class GoalChecker:
    """Stateful: once the goal's place is reached, it stays so until there is another goal, however the vehicle drifts as it turns."""

    def __init__(self, tolerances: GoalTolerances) -> None:
        self.tolerances = tolerances
        self._reached: Point | None = None

    def at_place(self, state: State, goal: Point) -> bool:
        """Whether the goal (x, y) [m] is reached, or has been; a goal farther than the tolerance from the last one is another one."""
        tolerance = self.tolerances.xy_goal_tolerance
        if self._reached is not None and hypot(goal[0] - self._reached[0], goal[1] - self._reached[1]) > tolerance:
            self._reached = None
        if self._reached is None and hypot(goal[0] - state.x, goal[1] - state.y) <= tolerance:
            self._reached = goal
        return self._reached is not None

    def has_heading(self, state: State, heading: float) -> bool:
        """Whether the vehicle looks along ``heading`` [rad]."""
        return abs(wrap(heading - state.yaw)) <= self.tolerances.yaw_goal_tolerance

    def reset(self) -> None:
        """Forgets that the goal was reached."""
        self._reached = None


def turn_to_heading(now: State, heading: float, limits: Limits) -> Twist:
    """Velocity that turns on the spot to ``heading`` [rad] by the shorter way, braking in time."""
    return Twist(0.0, turn_rate_over(wrap(heading - now.yaw), limits))
