"""One run: robot, world, sensors and a controller, in steps of 5 ms.

Every 25 ms the odometry reads, every 50 ms the controller gets a fresh scan and answers; what it answers reaches the wheels 25 ms
later, for the time that a scan and a controller take. Everything follows from the run's seed.
"""

import time
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchmarks.planning.barn.contacts import Contacts
from benchmarks.planning.barn.controllers import HZ, Briefing, Controller
from benchmarks.planning.barn.jackal import JACKAL, SCANNER, Drive
from benchmarks.planning.barn.odometry import Odometry
from benchmarks.planning.barn.registry import CHECKS, CONTROLLERS
from benchmarks.planning.barn.scanning import clearance_to_boxes, clearance_to_discs, see_discs, see_segments, sides
from benchmarks.planning.barn.scoring import Ending, Referee, score
from benchmarks.planning.barn.worlds import World
from uvf.maths.kinematics import Twist
from uvf.maths.rotations import wrap
from uvf.maths.se2 import Pose2, compose, inverse, transform

Floats = NDArray[np.float64]

DT = 0.005  # s
READ, DECIDE, LATE = 5, round(1 / HZ / DT), 5  # steps between readings of the odometry, commands, and until a command counts
PHASES = 60.0  # s, up to which the moving discs are ahead at the start of a run
HALF = (JACKAL.half_length, JACKAL.half_width)
ANGLES = (SCANNER.angle_min, SCANNER.angle_increment)
STOP = Twist(0.0, 0.0)


@dataclass(frozen=True)
class Trial:
    """A run to make: seed is that of the benchmark; number that of the trial; controller a name."""

    number: int
    seed: int
    controller: str


@dataclass(frozen=True)
class Run:
    """What became of a run. In the world's frame, at each command: true and believed poses (n, 3) x, y [m], yaw [rad].

    time: s on the clock; score: None where none is counted; clearance: least distance [m] of the footprint to anything; end: pose (3,);
    seen: (k, 2) [m] what the last scan has hit, from the true pose; movers: (m, 3) x, y, radius [m] at the end.
    mean_ms, worst_ms: what a command took.
    """

    world: str
    trial: int
    ending: Ending
    time: float
    score: float | None
    clearance: float
    end: Floats
    true: Floats
    believed: Floats
    seen: Floats
    movers: Floats
    mean_ms: float
    worst_ms: float


class Surroundings:
    """What stands and moves round the robot at a time of the run."""

    def __init__(self, world: World, phase: float) -> None:
        """phase: s, by which the moving discs are ahead of the run's time."""
        self._world, self._phase = world, phase
        self._sides = sides(world.boxes)
        self.movers = world.movers.at(phase)

    def move(self, t: float) -> None:
        """To the time ``t`` [s] of the run."""
        if len(self._world.movers):
            self.movers = self._world.movers.at(t + self._phase)

    def scan(self, pose: Floats, rng: np.random.Generator) -> Floats:
        """Ranges (beams,) [m] from base_link at ``pose`` (3,), with noise, 0 = no return."""
        scanner = np.array((pose[0] + SCANNER.forward * np.cos(pose[2]), pose[1] + SCANNER.forward * np.sin(pose[2]), pose[2]))
        ranges = np.full(SCANNER.beams, np.inf)
        see_discs(scanner, self._world.discs, ANGLES, ranges)
        see_discs(scanner, self.movers, ANGLES, ranges)
        see_segments(scanner, self._sides, ANGLES, ranges)
        ranges += SCANNER.noise * rng.standard_normal(SCANNER.beams)
        ranges[(ranges < SCANNER.range_min) | (ranges > SCANNER.range_max)] = 0.0
        return ranges

    def clearance(self, pose: Floats) -> float:
        """m from the footprint to the nearest thing."""
        standing = min(clearance_to_discs(pose, HALF, self._world.discs), clearance_to_boxes(pose, HALF, self._world.boxes))
        return min(standing, clearance_to_discs(pose, HALF, self.movers))


class Driver:
    """A controller with what it is told, and a record of it. Checks are told the truth."""

    def __init__(self, world: World, trial: Trial, rng: np.random.Generator) -> None:
        self._world, self._name = world, trial.controller
        self._is_check = trial.controller in CHECKS
        make = CHECKS[trial.controller] if self._is_check else CONTROLLERS[trial.controller]
        seed = int(rng.integers(2**31))
        self._controller: Controller = make(Briefing(JACKAL, seed, world if self._is_check else None))
        goal = compose(inverse(world.start), Pose2(*world.goal, world.start.yaw))
        self._controller.reset(goal)
        self.true: list[tuple[float, float, float]] = []
        self.believed: list[tuple[float, float, float]] = []
        self.ms: list[float] = []

    def command(self, t: float, ranges: Floats, drive: Drive, odometry: Odometry) -> Twist:
        """What the controller answers at ``t`` [s]. Raises ValueError for what is no velocity."""
        x, y, yaw = drive.pose.tolist()
        true = compose(inverse(self._world.start), Pose2(x, y, wrap(yaw)))
        pose, twist = (true, drive.twist) if self._is_check else (odometry.pose, odometry.twist)
        began = time.perf_counter()
        linear, angular = self._controller.command(t, ranges, pose, twist)
        self.ms.append(1e3 * (time.perf_counter() - began))
        if not (np.isfinite(linear) and np.isfinite(angular)):
            raise ValueError(f"controller {self._name}: commands v {linear} m/s, w {angular} rad/s at {t:.2f} s; both must be finite")
        self.true.append((x, y, yaw))
        self.believed.append(compose(self._world.start, odometry.pose))
        return Twist(float(linear), float(angular))


class Simulation:
    """A run that goes on step by step."""

    def __init__(self, world: World, trial: Trial) -> None:
        phases, seeds, odometry, self._noise = np.random.default_rng([trial.seed, trial.number, *world.name.encode()]).spawn(4)
        self._world, self._trial = world, trial
        self._surroundings = Surroundings(world, float(phases.uniform(0.0, PHASES)))
        self._driver = Driver(world, trial, seeds)
        self._drive, self._odometry = Drive(world.start, DT), Odometry(READ * DT, odometry)
        self._contacts = Contacts(world, JACKAL)
        self._referee = Referee(world.start[:2], world.goal)
        self._waiting = self._command = STOP
        self._clearance, self._step = np.inf, 0
        self._ranges = np.zeros(SCANNER.beams)

    @property
    def t(self) -> float:
        """Time of the run [s]."""
        return self._step * DT

    def step(self) -> Ending | None:
        """Looks whether the run has ended; if not, moves on by ``DT``."""
        pose = self._drive.pose
        self._surroundings.move(self.t)
        self._clearance = min(self._clearance, self._surroundings.clearance(pose))
        touches = self._contacts.touches(pose, self._surroundings.movers)
        if ending := self._referee.look(self.t, (float(pose[0]), float(pose[1])), touches):
            return ending
        if self._step % READ == 0 and self._step:
            self._odometry.read(self._drive.rolled, float(pose[2]) - self._world.start.yaw)
        if self._step % DECIDE == 0:
            self._ranges = self._surroundings.scan(pose, self._noise)
            self._waiting = self._driver.command(self.t, self._ranges.copy(), self._drive, self._odometry)
        if self._step % DECIDE == LATE:
            self._command = self._waiting
        self._drive.step(self._command)
        self._step += 1
        return None

    def result(self, ending: Ending) -> Run:
        """What became of the run that has ended so."""
        time_taken, optimal, driver = self._referee.time(self.t), self._world.optimal_time, self._driver
        return Run(
            world=self._world.name,
            trial=self._trial.number,
            ending=ending,
            time=time_taken,
            score=None if optimal is None else score(ending, time_taken, optimal),
            clearance=float(self._clearance),
            end=self._drive.pose.copy(),
            true=np.array(driver.true).reshape(-1, 3),
            believed=np.array(driver.believed).reshape(-1, 3),
            seen=_seen(driver, self._ranges),
            movers=self._surroundings.movers,
            mean_ms=float(np.mean(driver.ms)) if driver.ms else 0.0,
            worst_ms=max(driver.ms, default=0.0),
        )

    def close(self) -> None:
        """Ends the engine."""
        self._contacts.close()


def run(world: World, trial: Trial) -> Run:
    """Makes one run."""
    simulation = Simulation(world, trial)
    try:
        while (ending := simulation.step()) is None:
            pass
        return simulation.result(ending)
    finally:
        simulation.close()


def _seen(driver: Driver, ranges: Floats) -> Floats:
    if not driver.true:
        return np.zeros((0, 2))
    x, y, yaw = driver.true[-1]
    hit = ranges > 0.0
    angles = SCANNER.angle_min + SCANNER.angle_increment * np.flatnonzero(hit)
    from_scanner = ranges[hit, np.newaxis] * np.column_stack((np.cos(angles), np.sin(angles)))
    return transform(Pose2(x, y, yaw), from_scanner + np.array((SCANNER.forward, 0.0)))
