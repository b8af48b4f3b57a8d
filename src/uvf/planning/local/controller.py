"""Drives along a path among what the sensors see: obstacle layer, moving things, a local planner, and the stop that nothing bypasses."""

from dataclasses import dataclass, field
from enum import Enum
from math import cos, hypot, sin

import numpy as np
from numpy.typing import NDArray

from uvf.maths.kinematics import Twist
from uvf.maths.rotations import wrap
from uvf.maths.se2 import Pose2, inverse, transform
from uvf.planning.costmap.costmap import Costmap
from uvf.planning.costmap.footprint import RobotFootprint
from uvf.planning.costmap.hidden_obstacles import HiddenObstacles
from uvf.planning.costmap.inflation import Inflation
from uvf.planning.costmap.obstacle_layer import BeamObservation, ObstacleLayer
from uvf.planning.costmap.own_ground import WAY_OUT, leaving_factors, with_way_out
from uvf.planning.local.goal_checker import GoalChecker, GoalTolerances, turn_to_heading
from uvf.planning.local.planner import STOP, Limits, LocalPlanner, LocalSituation, State, within
from uvf.planning.local.swept_stop import safe_share
from uvf.planning.local.window import WindowSettings, local_window
from uvf.planning.moving.tracks import BESIDE, MovingObjects, SeenFrom

Floats = NDArray[np.float64]

FAST = 0.4  # m/s, what moves slower is stopped for
EDGE = 0.05  # m beyond its radius within which a point belongs to what moves
EVADED = 6.0  # m within which what moves may have to be evaded
NEAR = 4.0  # m, farther points cannot be reached before the next scan
REMEMBERED = 1.0  # m within which the stop heeds obstacles that are out of view
TURN_COUNTS = 0.3  # m/rad
BACKING = 0.1  # m behind the outline that must be known of who backs up without looking


@dataclass(frozen=True)
class ControllerSettings:
    """How obstacles are remembered and kept away from."""

    size: float = 8.0  # m, side of the window in which obstacles are remembered
    resolution: float = 0.05  # m
    obstacle_memory: float = 6.0  # m of travel (a radian counts as 0.3 m) after which an obstacle not seen again is forgotten
    obstacle_range: float = 10.0  # m, farther ones are not marked
    inflation: Inflation = field(default_factory=lambda: Inflation(0.55, 4.0))
    cost_travel_multiplier: float = 4.0
    margin: float = 0.02  # m round the footprint, for plans
    stop_margin: float = 0.01  # m round the footprint, for the stop
    slip: float = 0.01  # s^2, of speed times turn rate: what is added to it where wheels slide sideways in a curve
    window: WindowSettings = field(default_factory=WindowSettings)
    period: float = 0.05  # s from one command to the next
    delay: float = 0.05  # s from a measurement to the wheels
    reaction: float = 0.1  # s from sight to braking
    braking: float = 4.0  # m/s^2
    angular_braking: float = 10.0  # rad/s^2
    goal: GoalTolerances = field(default_factory=GoalTolerances)
    evasion: Limits | None = None
    """Limits while something moves near by, for a vehicle that makes way for it also where it would stand; None: it only stops."""
    stops_for_fast: bool = True
    """Whether the stop heeds what moves fast, too. A vehicle as quick as what comes at it leaves that to the local planner."""


class Drive(Enum):
    """How a cycle went."""

    DRIVING = "driving"
    NO_PATH = "there is no path"
    NO_VALID_CONTROL = "every velocity leads into an obstacle"
    STOPPED = "stopped before an obstacle"
    ARRIVED = "the path's end is reached"


@dataclass(frozen=True)
class DriveResult:
    """Velocity for now, and how it came about."""

    velocity: Twist
    how: Drive


class LocalController:
    """One vehicle's; poses are in a frame that does not jump (odom), or one that seldom does (map)."""

    def __init__(self, footprint: RobotFootprint, limits: Limits, planner: LocalPlanner, settings: ControllerSettings) -> None:
        self.settings, self.limits = settings, limits
        self.footprint = footprint
        self.planner = planner
        self.layer = ObstacleLayer(settings.size, settings.resolution, settings.obstacle_memory)
        self.hidden = HiddenObstacles(settings.size, settings.resolution, settings.obstacle_memory)
        self.moving = MovingObjects()
        self._goal = GoalChecker(settings.goal)
        self._plan_footprint = footprint.padded(settings.margin)
        self._factors = leaving_factors(settings.cost_travel_multiplier, 1.0)
        self._odometer = 0.0  # m
        self._pose: Pose2 | None = None
        self._near: Floats = np.zeros((0, 2))
        self._shown: dict[int, Floats] = {}
        """(n, 2) m, the poses' frame: near ends of the last scan of each lidar."""
        self._last = STOP

    def see(self, t: float, pose: Pose2, eye: tuple[float, float], points: Floats, ranges: Floats, lidar: int = 0) -> None:
        """Takes a planar scan at ``t`` [s]: points (n, 2) [m, base frame] in the order of the beams, ranges (n,) [m], 0 = no return.

        A beam without return has its point where it would end at its farthest; it clears. eye: (x, y) [m, base frame] of the sensor. Of
        several lidars, told apart by their number, each shows what the others do not; what moves is followed by the scans of number 0.
        """
        ends = transform(pose, points)
        (x, y), *_ = transform(pose, np.array((eye,))).tolist()
        self.layer.recentre((pose[0], pose[1]))
        if lidar == 0:
            moves = self.moving.observe(t, ends, ranges, SeenFrom((x, y), self.layer.lately_free(t, (x, y), ends)))
        else:
            moves = self._moves(ends)
        hits = (ranges > 0.0) & (ranges <= self.settings.obstacle_range) & ~moves
        far = np.maximum(ranges, 1e-9) > self.settings.obstacle_range
        if far.any():
            share = np.where(far, self.settings.obstacle_range / np.maximum(ranges, 1e-9), 1.0)[:, None]
            ends = np.array((x, y)) + (ends - np.array((x, y))) * share
        self._travel(pose)
        self.layer.observe(BeamObservation(t, self._odometer, (x, y), ends, hits))
        self.layer.forget(self._odometer)
        for mx, my, _, _, radius in self.moving.moving():  # it was marked before it was known to move
            self.layer.free_disc((mx, my), radius + BESIDE)
        kept = (ranges > 0.0) & ~self._evaded(ends) & (np.abs(points) <= NEAR).all(axis=1)
        others = [transform(inverse(pose), shown) for number, shown in self._shown.items() if number != lidar]
        self._shown[lidar] = ends[kept]
        self._near = np.concatenate(
            (points[kept], *others, transform(inverse(pose), self.layer.lethal_near((pose[0], pose[1]), REMEMBERED)))
        )
        self.keep_out(self.hidden.points(self._odometer, (pose[0], pose[1]), self.settings.size / 2))

    def keep_out(self, points: Floats) -> None:
        """Points (n, 2) [m, the poses' frame] that are obstacles though no sensor sees them; told anew after each ``see``."""
        self.layer.mark(points, self._odometer)
        self.beware(points)

    def beware(self, points: Floats) -> None:
        """Points (n, 2) [m, the poses' frame] that only the stop heeds, until the next ``see``: something is about to be there."""
        if self._pose is not None:
            self._near = np.concatenate((self._near, transform(inverse(self._pose), points)))

    def _moves(self, ends: Floats, least: float = 0.0) -> NDArray[np.bool_]:
        """Mask (n,) of the points that belong to what moves, no slower than ``least`` [m/s]."""
        out = np.zeros(len(ends), dtype=np.bool_)
        for x, y, vx, vy, radius in self.moving.moving():
            if hypot(vx, vy) >= least:
                out |= (ends[:, 0] - x) ** 2 + (ends[:, 1] - y) ** 2 < (radius + EDGE) ** 2
        return out

    def _evaded(self, ends: Floats) -> NDArray[np.bool_]:
        """Mask (n,) of the points that belong to what moves so fast that the stop would not help against it: it hits who stands.

        The local planner evades it. Braking in its way would be worse, and so would be braking for what is about to pass.
        """
        return np.zeros(len(ends), dtype=np.bool_) if self.settings.stops_for_fast else self._moves(ends, FAST)

    def _travel(self, pose: Pose2) -> None:
        """What is remembered is known the worse the farther the vehicle has come since: odometry drifts by the way, not by time."""
        if self._pose is not None:
            turned = abs(wrap(pose[2] - self._pose[2]))
            self._odometer += hypot(pose[0] - self._pose[0], pose[1] - self._pose[1]) + TURN_COUNTS * turned
        self._pose = pose

    def costmap(self, size: float | None = None) -> Costmap:
        """What is known round the vehicle, or its middle of ``size`` [m], for planning."""
        return self.layer.costmap(self._plan_footprint, self.settings.inflation, size)

    @property
    def age(self) -> float:
        """What the lifetime of obstacles is measured by: m travelled."""
        return self._odometer

    @property
    def factors(self) -> Floats:
        """(256,) cost factors [-] by value, unknown ground like free."""
        return self._factors

    def has_room_to_turn(self, pose: Pose2) -> bool:
        """Whether no known obstacle is in the way of turning on the spot."""
        return self.layer.has_room((pose[0], pose[1]), self._plan_footprint.circumscribed_radius)

    def knows_behind(self, pose: Pose2) -> bool:
        """Whether the ground on which the vehicle would stand if it backed up a little has been seen."""
        outline = np.array(self.footprint.outline)
        return self.layer.is_known(transform(pose, outline[outline[:, 0] < 0.0] - np.array((BACKING, 0.0))))

    def leaving(self, costs: Costmap, pose: Pose2) -> Costmap:
        """The costmap in which the vehicle may leave a place that is too near to an obstacle."""
        return with_way_out(costs, costs.cell(pose[0], pose[1]), WAY_OUT)

    def drive(self, pose: Pose2, velocity: Twist, path: Floats, heading: float | None = None) -> DriveResult:
        """Velocity for now along ``path`` (n, 2) [m, the poses' frame]; velocity: measured.

        heading: [rad, the poses' frame] to turn to at the path's end; None = any.
        """
        if len(path) == 0:
            self._last = STOP
            return DriveResult(STOP, Drive.NO_PATH)
        limits = self._limits_now(pose)
        state = self._ahead(pose, velocity, limits)
        if self._goal.at_place(state, (float(path[-1, 0]), float(path[-1, 1]))):
            return self._at_goal(state, velocity, heading)
        return self._along((pose, velocity), state, limits, path)

    def hold(self, pose: Pose2, velocity: Twist) -> Twist:
        """Stands, as long as nothing that moves comes near; a vehicle that may evade makes way for it."""
        if self.settings.evasion is None or not self._is_among_moving(pose):
            return self.halt()
        limits = self.settings.evasion
        result = self._along((pose, velocity), self._ahead(pose, velocity, limits), limits, np.array((pose[:2],)))
        return result.velocity

    def _along(self, measured: tuple[Pose2, Twist], state: State, limits: Limits, path: Floats) -> DriveResult:
        """Along the path from the state that is expected when the command takes effect."""
        (pose, velocity), settings = measured, self.settings
        obstacles = self.moving.moving()
        obstacles[:, :2] += settings.delay * obstacles[:, 2:4]
        costs = self.leaving(self.costmap(settings.window.size + 1.0), pose)
        grids = local_window(costs, (pose[0], pose[1]), path, self._factors, settings.window)
        wanted = self.planner.command(LocalSituation(state, grids, path, obstacles, limits))
        if wanted is None:
            return DriveResult(self._reach(state, velocity, STOP, limits), Drive.NO_VALID_CONTROL)
        stopped = self._reach(state, velocity, wanted, limits) == STOP and wanted != STOP
        return DriveResult(self._last, Drive.STOPPED if stopped else Drive.DRIVING)

    def halt(self) -> Twist:
        """Zero velocity, as fast as the wheels can."""
        self._last = STOP
        return STOP

    def move(self, pose: Pose2, velocity: Twist, wanted: Twist) -> Twist:
        """A wanted velocity within the limits of acceleration; the stop has the last word."""
        return self._reach(self._ahead(pose, velocity, self.limits), velocity, wanted, self.limits)

    def _is_among_moving(self, pose: Pose2) -> bool:
        obstacles = self.moving.moving()
        return bool((np.hypot(obstacles[:, 0] - pose[0], obstacles[:, 1] - pose[1]) <= EVADED).any())

    def _limits_now(self, pose: Pose2) -> Limits:
        return self.settings.evasion if self.settings.evasion is not None and self._is_among_moving(pose) else self.limits

    def _reach(self, state: State, velocity: Twist, wanted: Twist, limits: Limits) -> Twist:
        reached = within(limits, state, wanted, self.settings.period)
        self._last = self.made_safe(reached, velocity)
        return self._last

    def _at_goal(self, state: State, velocity: Twist, heading: float | None) -> DriveResult:
        """Stands, or turns to the heading where that is not the wanted one yet."""
        if there := heading is None or self._goal.has_heading(state, heading):
            wanted = STOP
        else:
            wanted = turn_to_heading(state, heading, self.limits)
        if self._reach(state, velocity, wanted, self.limits) == STOP and wanted != STOP:
            return DriveResult(STOP, Drive.STOPPED)
        return DriveResult(self._last, Drive.ARRIVED if there else Drive.DRIVING)

    def made_safe(self, wanted: Twist, velocity: Twist) -> Twist:
        """The wanted velocity, slowed so that the vehicle can stop before everything that the last scan shows or that is
        remembered near it.

        velocity: the measured one; where it is the larger of the two, it counts.
        """
        s = self.settings
        brake = (s.reaction, s.braking, s.angular_braking)
        faster = Twist(*(m if abs(m) > abs(w) else w for w, m in zip(wanted, velocity, strict=True)))
        share = min(
            safe_share(self._near, v, self.footprint, s.stop_margin + s.slip * abs(v.linear * v.angular), brake) for v in (wanted, faster)
        )
        return Twist(*(share * part for part in wanted))

    def _ahead(self, pose: Pose2, velocity: Twist, limits: Limits) -> State:
        """Where the vehicle will be, and how fast, when the command takes effect.

        The last command counts as its velocity, as far as the measured one is near: measurements lag behind.
        """
        d, lag = self.settings.delay, 3 * self.settings.period
        dv, dw = limits.acceleration * lag, limits.angular_acceleration * lag
        v = min(max(self._last.linear, velocity.linear - dv), velocity.linear + dv)
        w = min(max(self._last.angular, velocity.angular - dw), velocity.angular + dw)
        side = min(max(self._last.lateral, velocity.lateral - dv), velocity.lateral + dv)
        middle = pose[2] + w * d / 2
        ahead, aside = v * d, (side - limits.sideslip * v * w) * d
        x, y = ahead * cos(middle) - aside * sin(middle), ahead * sin(middle) + aside * cos(middle)
        return State(pose[0] + x, pose[1] + y, pose[2] + w * d, v, w, side)
