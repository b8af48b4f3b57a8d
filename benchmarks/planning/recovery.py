"""Eight places where navigation stacks get stuck: what can be solved is to be solved, the rest given up soon and with the right reason.

The robot is that of BARN with its simulation. ``right`` is 1 where a case ended as it should in every trial; ``contacts`` counts
trials that touched something. Poses are those of the odometry, but for the case with a map, where the true pose is given.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.planning.barn.contacts import Contacts
from benchmarks.planning.barn.controllers import HZ
from benchmarks.planning.barn.jackal import JACKAL, Drive
from benchmarks.planning.barn.movers import Movers, Track, movers_of
from benchmarks.planning.barn.odometry import Odometry
from benchmarks.planning.barn.simulation import DT, LATE, READ, STOP, Surroundings
from benchmarks.planning.barn.stack import SIZE, STACK_LIMITS, Beams
from benchmarks.planning.barn.worlds import World
from launch.commands.bench import Figures
from launch.commands.bench_selection import Selection
from uvf.maths.kinematics import Twist
from uvf.maths.rotations import wrap
from uvf.maths.se2 import Pose2, compose, inverse
from uvf.planning.costmap.footprint import RobotFootprint
from uvf.planning.costmap.inflation import LETHAL
from uvf.planning.global_planner import GlobalPlanner, PlannedBody
from uvf.planning.local.controller import ControllerSettings, LocalController
from uvf.planning.local.mppi import Mppi, MppiSettings
from uvf.planning.navigation.execution import Executor
from uvf.planning.navigation.failures import Failure
from uvf.planning.navigation.global_routes import GlobalRoutes
from uvf.planning.navigation.navigator import NavigationGoal, Navigator, NavigatorSettings, RouteSource, Status
from uvf.planning.navigation.routes import LayerRoutes

Floats = NDArray[np.float64]

OPTIONS = frozenset({"trials", "seed"})
LIMIT = 90.0  # s
GIVE_UP = 30.0  # s within which what cannot be solved is to be given up
THICK = 0.1  # m, of walls
RESOLUTION = 0.05  # m, of the map that one case has


@dataclass(frozen=True)
class Case:
    """One place: a world whose start is the origin of odometry and whose goal is in the same frame, and how it should end.

    later: goals (t [s], x, y [m]) given after the first; ghosts: boxes (n, 4) of obstacles that are remembered and not there; mapped: boxes
    (n, 4) that are drawn on the map besides those of the world, None = no map.
    """

    world: World
    failure: Failure = Failure.NONE
    later: tuple[tuple[float, float, float], ...] = ()
    ghosts: Floats = field(default_factory=lambda: np.zeros((0, 4)))
    mapped: Floats | None = None


def walls(*lines: tuple[float, float, float, float]) -> Floats:
    """Boxes (n, 4) x, y of the middle, sizes [m] of upright and level walls from (x0, y0) to (x1, y1)."""
    return np.array([((a + c) / 2, (b + d) / 2, abs(c - a) + THICK, abs(d - b) + THICK) for a, b, c, d in lines])


def _world(name: str, boxes: Floats, goal: tuple[float, float], movers: Movers | None = None) -> World:
    made = World(name, Pose2(0.0, 0.0, 0.0), goal, np.zeros((0, 3)), boxes)
    return made if movers is None else replace(made, movers=movers)


HALL = ((-4.0, -3.0, 10.0, -3.0), (-4.0, 3.0, 10.0, 3.0), (-4.0, -3.0, -4.0, 3.0), (10.0, -3.0, 10.0, 3.0))
CORRIDOR = ((-3.0, -0.7, 9.0, -0.7), (-3.0, 0.7, 9.0, 0.7), (-3.0, -0.7, -3.0, 0.7))


def _person() -> Movers:
    """Walks into the corridor, stands in it for 20 s, and goes on; then far away until its period is over."""
    keys = ((0.0, 3.0, 3.0), (2.0, 3.0, 0.0), (22.0, 3.0, 0.0), (24.0, 3.0, -3.0), (26.0, 3.0, -30.0), (500.0, 3.0, -30.0))
    return movers_of([Track(0.45, 500.0, np.array(keys))], "linear")


def cases() -> dict[str, Case]:
    """The eight by name."""
    dead_end = walls(*HALL, (1.5, -1.2, 4.0, -1.2), (1.5, 1.2, 4.0, 1.2), (4.0, -1.2, 4.0, 1.2))
    box = walls(*HALL, (-0.9, -0.32, 0.45, -0.32), (-0.9, 0.32, 0.45, 0.32), (0.45, -0.32, 0.45, 0.32))
    room = walls((-1.5, -1.5, 1.5, -1.5), (-1.5, 1.5, 1.5, 1.5), (-1.5, -1.5, -1.5, 1.5), (1.5, -1.5, 1.5, 1.5))
    facing = walls(*HALL, (0.37, -2.0, 0.37, 2.0))
    behind = walls((-3.0, -0.7, 1.0, -0.7), (-3.0, 0.7, 1.0, 0.7), (1.0, -0.7, 1.0, 0.7))
    doors = walls((-3.0, -0.7, 2.5, -0.7), (3.5, -0.7, 9.0, -0.7), (-3.0, 0.7, 2.5, 0.7), (3.5, 0.7, 9.0, 0.7), (-3.0, -0.7, -3.0, 0.7))
    swinging = tuple((3.0 * k, 4.0, 2.0 if k % 2 else -2.0) for k in range(1, 8))
    return {
        "ghost in the local map": Case(_world("ghost_local", behind, (-6.0, 0.0)), ghosts=walls((-0.6, -0.6, -0.6, 0.6))),
        "ghost in the map": Case(_world("ghost_map", walls(*CORRIDOR), (7.0, 0.0)), mapped=walls((3.0, -0.7, 3.0, 0.7))),
        "facing a wall": Case(_world("facing_wall", facing, (5.0, 0.0))),
        "dead end": Case(_world("dead_end", dead_end, (7.0, 0.0))),
        "boxed, gap behind": Case(_world("boxed", box, (6.0, 0.0))),
        "closed room": Case(_world("closed_room", room, (6.0, 0.0)), Failure.NO_VALID_PATH),
        "swinging goals": Case(_world("swinging", walls(*HALL), (4.0, -2.0)), later=swinging),
        "person in the corridor": Case(_world("person", doors, (7.0, 0.0), _person())),
    }


@dataclass(frozen=True)
class Outcome:
    """How a trial ended: the navigator's status, s taken, recoveries, contact, and the log (t [s], text)."""

    status: Status
    failure: Failure
    time: float
    recoveries: int
    contact: bool
    log: list[tuple[float, str]]
    driven: Floats
    """(n, 3) x, y, yaw, true."""

    def is_right(self, case: Case) -> bool:
        """Whether it ended as it should."""
        if self.contact:
            return False
        if case.failure == Failure.NONE:
            return self.status == Status.REACHED
        return self.status == Status.ABORTED and self.failure == case.failure and self.time <= GIVE_UP


class _Trial:
    """The simulation of one trial."""

    def __init__(self, case: Case, seed: int) -> None:
        self._case = case
        noise, odometry = np.random.default_rng(seed).spawn(2)
        self._noise = noise
        self._surroundings = Surroundings(case.world, 0.0)
        self._drive, self._odometry = Drive(case.world.start, DT), Odometry(READ * DT, odometry)
        self._contacts = Contacts(case.world, JACKAL)
        footprint = RobotFootprint.polygon(JACKAL.footprint)
        planner = Mppi(STACK_LIMITS, footprint, MppiSettings(), seed)
        self._controller = LocalController(footprint, STACK_LIMITS, planner, ControllerSettings(size=SIZE))
        self._executor = Executor(self._controller)
        settings = NavigatorSettings(replan_period=0.5, circumscribed_radius=footprint.circumscribed_radius)
        self._navigator = Navigator(self._source(), settings)
        self._beams = Beams.of(JACKAL.scanner)
        self._later = list(case.later)
        self._haunted = False

    def _source(self) -> RouteSource:
        if self._case.mapped is None:
            return LayerRoutes(self._controller)
        cells, origin = np.zeros((200, 320), dtype=np.int8), (-4.0, -5.0)
        for x, y, a, b in np.concatenate((self._case.world.boxes, self._case.mapped)).tolist():
            rows = slice(math.floor((y - b / 2 - origin[1]) / RESOLUTION), math.ceil((y + b / 2 - origin[1]) / RESOLUTION))
            columns = slice(math.floor((x - a / 2 - origin[0]) / RESOLUTION), math.ceil((x + a / 2 - origin[0]) / RESOLUTION))
            cells[max(rows.start, 0) : rows.stop, max(columns.start, 0) : columns.stop] = 100
        settings = self._controller.settings
        body = PlannedBody(self._controller.footprint.padded(settings.margin), settings.inflation, settings.cost_travel_multiplier)
        routes = GlobalRoutes(GlobalPlanner(body), self._controller.layer, self._controller.hidden)
        routes.take(cells, (RESOLUTION, origin))
        return routes

    def run(self) -> Outcome:
        """To the end."""
        waiting = command = STOP
        contact, step, driven = False, 0, []
        every = round(1 / HZ / DT)
        while (t := step * DT) < LIMIT and not contact:
            pose = self._drive.pose
            self._surroundings.move(t)
            contact = self._contacts.touches(pose, self._surroundings.movers)
            if step % READ == 0 and step:
                self._odometry.read(self._drive.rolled, float(pose[2]))
            if step % every == 0:
                driven.append(pose.copy())
                waiting = self._decide(t)
                if not self._navigator.is_busy and not self._later:
                    break
            if step % every == LATE:
                command = waiting
            self._drive.step(command)
            step += 1
        self._contacts.close()
        told = self._navigator.feedback
        return Outcome(told.status, told.failure, step * DT, told.recoveries, contact, self._navigator.log, np.array(driven))

    def _decide(self, t: float) -> Twist:
        x, y, yaw = self._drive.pose.tolist()
        pose = Pose2(x, y, wrap(yaw)) if self._case.mapped is not None else self._odometry.pose
        ranges = self._surroundings.scan(self._drive.pose, self._noise)
        points = self._beams.points(ranges, self._controller.settings.obstacle_range)
        self._controller.see(t, pose, self._beams.eye, points, ranges)
        if t == 0.0:
            self._haunt()
            goal = compose(inverse(self._case.world.start), Pose2(*self._case.world.goal, 0.0))
            self._navigator.start(t, NavigationGoal(goal[0], goal[1]))
        while self._later and t >= self._later[0][0]:
            _, gx, gy = self._later.pop(0)
            self._navigator.start(t, NavigationGoal(gx, gy))
        directive = self._navigator.step(t, pose, self._executor.report)
        return self._executor.step(t, pose, self._odometry.twist, directive)

    def _haunt(self) -> None:
        """Marks obstacles that are not there, as a sensor may have left them that does not look there any more."""
        layer = self._controller.layer
        n = len(layer.cells)
        at = (np.arange(n) + 0.5) * layer.resolution
        for x, y, a, b in self._case.ghosts.tolist():
            inside = (np.abs(at + layer.origin[1] - y) <= b / 2)[:, None] & (np.abs(at + layer.origin[0] - x) <= a / 2)
            layer.cells[inside] = LETHAL


def run(case: Case, seed: int) -> Outcome:
    """One trial; the same seed gives the same."""
    return _Trial(case, seed).run()


def measure(selection: Selection, data: Path | None) -> Figures:
    """A row for each case."""
    seed, trials = (1 if selection.seed is None else selection.seed), selection.trials or 1
    rows: Figures = {}
    for name, case in cases().items():
        found = [run(case, seed + k) for k in range(trials)]
        rows[f"recovery: {name}"] = {
            "right": float(np.mean([outcome.is_right(case) for outcome in found])),
            "contacts": sum(outcome.contact for outcome in found),
            "time s": float(np.mean([outcome.time for outcome in found])),
            "recoveries": float(np.mean([outcome.recoveries for outcome in found])),
        }
    return rows


def case_of(selection: Selection) -> Callable[[Path | None], Figures]:
    """The benchmark's case."""
    return partial(measure, selection)
