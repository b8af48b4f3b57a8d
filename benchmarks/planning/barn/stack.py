"""Navigation without a map, as the benchmark's robot does it: odometry and scans alone.

Paths lead over what has been seen so far, with unknown ground taken for free, and are planned anew five times a second.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchmarks.planning.barn.controllers import Briefing, Scanner
from uvf.maths.kinematics import Twist
from uvf.maths.se2 import Pose2
from uvf.planning.costmap.footprint import RobotFootprint
from uvf.planning.costmap.inflation import Inflation
from uvf.planning.local.controller import ControllerSettings, LocalController
from uvf.planning.local.dwa import Dwa, DwaSettings
from uvf.planning.local.planner import Limits
from uvf.planning.local.planners import make_local_planner
from uvf.planning.navigation.execution import Executor
from uvf.planning.navigation.navigator import NavigationGoal, Navigator, NavigatorSettings
from uvf.planning.navigation.progress import ProgressSettings
from uvf.planning.navigation.routes import LayerRoutes

Floats = NDArray[np.float64]

SIZE = 24.0  # m, of the window that paths are planned over
REPLAN = 0.2  # s
SIDESLIP = 0.09  # s, of the Jackal on its tyres: at 3.5 m/s^2 across it slides at 0.3 m/s
PATIENCE, OSCILLATION_TIME = 6.0, 40.0  # s: who makes way for what moves stands and goes back now and then
STACK_LIMITS = Limits(
    min_speed=-0.5,
    max_speed=1.4,
    max_turn_rate=2.0,
    acceleration=2.5,
    angular_acceleration=6.0,
    lateral_acceleration=1.5,
    sideslip=SIDESLIP,
)
EVASION_LIMITS = Limits(
    min_speed=-2.0,
    max_speed=2.0,
    max_turn_rate=3.0,
    acceleration=4.0,
    angular_acceleration=10.0,
    lateral_acceleration=3.5,
    sideslip=SIDESLIP,
)
"""What the Jackal can do."""
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


class Slide:
    """The odometry's pose with the way that the wheels slide out of curves, which no encoder tells."""

    def __init__(self, sideslip: float) -> None:
        """sideslip: s, as ``Limits`` have it."""
        self._sideslip, self._gone = sideslip, np.zeros(2)
        self._last: tuple[float, float] | None = None

    def corrected(self, t: float, pose: Pose2, velocity: Twist) -> Pose2:
        """The pose [m, m, rad] at ``t`` [s], by the velocity since the last call."""
        aside = -self._sideslip * velocity.linear * velocity.angular
        if self._last is not None:
            mean = 0.5 * (aside + self._last[1]) * (t - self._last[0])
            self._gone += mean * np.array((-np.sin(pose.yaw), np.cos(pose.yaw)))
        self._last = t, aside
        return Pose2(pose.x + float(self._gone[0]), pose.y + float(self._gone[1]), pose.yaw)


class MaplessStack:
    """A controller of the benchmark: the navigator over the obstacle layer, and a local planner."""

    def __init__(self, scanner: Scanner, controller: LocalController) -> None:
        self._beams = Beams.of(scanner)
        self.executor = Executor(controller)
        progress = ProgressSettings(movement_time_allowance=PATIENCE, oscillation_time=OSCILLATION_TIME)
        settings = NavigatorSettings(
            replan_period=REPLAN, circumscribed_radius=controller.footprint.circumscribed_radius, progress=progress
        )
        self.navigator = Navigator(LayerRoutes(controller), settings)
        self._goal = NavigationGoal(0.0, 0.0)
        self._slide = Slide(controller.limits.sideslip)

    def reset(self, goal_in_odom: Pose2) -> None:
        """Takes a goal."""
        self._goal = NavigationGoal(goal_in_odom[0], goal_in_odom[1])

    def command(self, t: float, ranges: Floats, odom_from_base: Pose2, velocity: Twist) -> tuple[float, float]:
        """Velocity [m/s, rad/s]."""
        controller = self.executor.controller
        odom_from_base = self._slide.corrected(t, odom_from_base, velocity)
        points = self._beams.points(ranges, controller.settings.obstacle_range)
        controller.see(t, odom_from_base, self._beams.eye, points, ranges)
        if not self.navigator.is_busy:  # a goal that was given up is tried again: what moves frees the way sooner or later
            self.navigator.start(t, self._goal)
        directive = self.navigator.step(t, odom_from_base, self.executor.report)
        wanted = self.executor.step(t, odom_from_base, velocity, directive)
        return wanted.linear, wanted.angular


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
    settings = ControllerSettings(size=SIZE, evasion=EVASION_LIMITS, stops_for_fast=False)
    return MaplessStack(briefing.robot.scanner, LocalController(footprint, STACK_LIMITS, planner, settings))
