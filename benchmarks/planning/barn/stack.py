"""Navigation without a map, as the benchmark's robot does it: odometry and scans alone.

Paths lead over what has been seen so far, with unknown ground taken for free, and are planned anew five times a second.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchmarks.planning.barn.controllers import Briefing, Scanner
from uvf.maths.kinematics import Twist
from uvf.maths.se2 import Pose2
from uvf.planning.costmap.costmap import Cell, Costmap
from uvf.planning.costmap.footprint import RobotFootprint
from uvf.planning.costmap.inflation import Inflation
from uvf.planning.local.controller import ControllerSettings, LocalController
from uvf.planning.local.dwa import Dwa, DwaSettings
from uvf.planning.local.planner import Limits
from uvf.planning.local.planners import make_local_planner
from uvf.planning.search.grid_search import GridSearch
from uvf.planning.smoothing import resample

Floats = NDArray[np.float64]

SIZE = 24.0  # m, of the window that paths are planned over
REPLAN = 0.2  # s
INSET = 0.3  # m from the window's border to where a goal beyond it is sought
STACK_LIMITS = Limits(
    min_speed=-0.5, max_speed=1.4, max_turn_rate=2.0, acceleration=2.5, angular_acceleration=6.0, lateral_acceleration=2.0
)
DWA_LIMITS = Limits(0.1, 0.5, 1.57, 10.0, 20.0, 10.0)
MOVE_BASE_HALF, MOVE_BASE_PADDING = (0.21, 0.165), 0.1  # m
"""What move_base has on the Jackal: jackal_helper/configs/params of the challenge."""


@dataclass(frozen=True)
class Beams:
    """The scanner's directions (n, 2) and place [m], base frame."""

    rays: Floats
    eye: tuple[float, float]

    @staticmethod
    def of(scanner: Scanner) -> "Beams":
        """Those of a scanner."""
        angles = scanner.angle_min + scanner.angle_increment * np.arange(scanner.beams)
        return Beams(np.column_stack((np.cos(angles), np.sin(angles))), (scanner.forward, 0.0))

    def points(self, ranges: Floats, farthest: float) -> Floats:
        """Ends (n, 2) [m, base frame]; those without return at ``farthest`` [m]."""
        points: Floats = self.rays * np.where(ranges > 0.0, ranges, farthest)[:, None] + np.array(self.eye)
        return points


class MaplessStack:
    """A controller of the benchmark: A* over the obstacle layer and a local planner."""

    def __init__(self, scanner: Scanner, controller: LocalController) -> None:
        self._local = controller
        self._beams = Beams.of(scanner)
        self._goal: Floats = np.zeros(2)
        self._path: Floats = np.zeros((0, 2))
        self._planned_at = -np.inf

    def reset(self, goal_in_odom: Pose2) -> None:
        """Takes a goal."""
        self._goal = np.array(goal_in_odom[:2])
        self._path, self._planned_at = np.zeros((0, 2)), -np.inf

    def command(self, t: float, ranges: Floats, odom_from_base: Pose2, velocity: Twist) -> tuple[float, float]:
        """Velocity [m/s, rad/s]."""
        points = self._beams.points(ranges, self._local.settings.obstacle_range)
        self._local.see(t, odom_from_base, self._beams.eye, points, ranges)
        if t >= self._planned_at + REPLAN - 1e-9:
            self._planned_at = t
            self._plan(odom_from_base)
        result = self._local.drive(odom_from_base, (velocity.linear, velocity.angular), self._path)
        return result.speed, result.turn_rate

    def _plan(self, pose: Pose2) -> None:
        """A new path; the old one is kept where none is found."""
        costs = self._local.leaving(self._local.costmap(), pose)
        found = GridSearch(costs.values, self._local.factors).astar(costs.cell(pose[0], pose[1]), self._goal_cell(costs, pose))
        if found is not None:
            points = costs.points(found.cells)
            points[0] = pose[:2]
            self._path = resample(points)

    def _goal_cell(self, costs: Costmap, pose: Pose2) -> Cell:
        """The goal's cell, or the place in its direction where the window ends."""
        cell = costs.cell(self._goal[0], self._goal[1])
        if costs.holds(cell):
            return cell
        ahead = self._goal - np.array(pose[:2])
        ahead *= (SIZE / 2 - INSET) / np.abs(ahead).max()
        return costs.cell(pose[0] + ahead[0], pose[1] + ahead[1])


def move_base_stack(briefing: Briefing) -> MaplessStack:
    """The dynamic window approach at 0.5 m/s with the challenge's parameters of move_base on the Jackal, but without its recoveries."""
    x, y = (half + MOVE_BASE_PADDING for half in MOVE_BASE_HALF)
    footprint = RobotFootprint.polygon(np.array(((-x, -y), (x, -y), (x, y), (-x, y))))
    settings = ControllerSettings(size=SIZE, inflation=Inflation(0.3, 10.0), margin=0.0, obstacle_range=2.5)
    planner = Dwa(DWA_LIMITS, footprint, DwaSettings())
    return MaplessStack(briefing.robot.scanner, LocalController(footprint, DWA_LIMITS, planner, settings))


def stack_of(name: str, briefing: Briefing) -> MaplessStack:
    """The stack with the local planner of a name as it is by default."""
    footprint = RobotFootprint.polygon(briefing.robot.footprint)
    planner = make_local_planner(name, STACK_LIMITS, footprint, briefing.seed)
    return MaplessStack(briefing.robot.scanner, LocalController(footprint, STACK_LIMITS, planner, ControllerSettings(size=SIZE)))
