"""What one cycle of local planning costs: the costmap of a scan, the window that a planner looks at, and each planner's choice.

The robot and the scanner (720 beams) are those of BARN, among posts that stand and discs that move. Times are CPU time of the planning
thread, after one round that warms up. ``costmap`` marks and clears by all beams and inflates 100 x 100 cells; ``window`` adds the way to
go, the way off the path and the shut headings on a window of 6 m; ``mppi 2000 x 56`` draws so many futures of so many steps, at places
where nothing moves, and then among six discs that do.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from benchmarks.measuring.timing import on_thread
from benchmarks.planning.barn.jackal import JACKAL
from benchmarks.planning.barn.simulation import Surroundings
from benchmarks.planning.barn.stack import STACK_LIMITS, Beams
from benchmarks.planning.barn.worlds import World
from launch.commands.bench import Figures
from uvf.maths.se2 import Pose2, transform
from uvf.planning.costmap.costmap import Costmap
from uvf.planning.costmap.footprint import RobotFootprint
from uvf.planning.costmap.inflation import Inflation
from uvf.planning.costmap.obstacle_layer import BeamObservation, ObstacleLayer
from uvf.planning.costmap.own_ground import leaving_factors
from uvf.planning.local.mppi import Mppi, MppiSettings
from uvf.planning.local.planner import LocalPlanner, LocalSituation, State
from uvf.planning.local.planners import LOCAL_PLANNERS, make_local_planner
from uvf.planning.local.window import Grids, WindowSettings, local_window

Floats = NDArray[np.float64]

PLACES, WAY = 60, 12.0  # along a way of so many m
POSTS, MOVING = 120, 6
LANE, SIDE = 0.7, 8.0  # m from the way within which no post stands, and up to which they do
SIDE_OF_COSTMAP, RESOLUTION = 5.0, 0.05  # m
SIDE_OF_WINDOW = 7.0  # m
INFLATION = Inflation(0.55, 4.0)
SAMPLES, STEPS = 2000, 56
SPEED = 0.8  # m/s


class Place(NamedTuple):
    """Where the robot is, what its scanner sees [m], and what moves about it (m, 5)."""

    pose: Pose2
    ranges: Floats
    obstacles: Floats


@dataclass
class Cycle:
    """The parts of a cycle at one place after the other, each with what it took [ms]."""

    footprint: RobotFootprint
    beams: Beams
    path: Floats

    def costmap(self, place: Place, side: float) -> tuple[float, Costmap]:
        """Of one scan, in an empty window about the place."""
        layer = ObstacleLayer(side, RESOLUTION)
        layer.recentre(place.pose[:2])
        (eye,) = transform(place.pose, np.array((self.beams.eye,))).tolist()
        ends = transform(place.pose, self.beams.points(place.ranges, JACKAL.scanner.range_max))
        seen = BeamObservation(0.0, 0.0, (eye[0], eye[1]), ends, place.ranges > 0.0)

        def made() -> Costmap:
            layer.observe(seen)
            return layer.costmap(self.footprint, INFLATION)

        return on_thread(made)

    def window(self, place: Place) -> tuple[float, Grids]:
        """Of a costmap that is there."""
        costs, factors = self.costmap(place, SIDE_OF_WINDOW)[1], leaving_factors(4.0, 1.0)
        return on_thread(lambda: local_window(costs, place.pose[:2], self.path, factors, WindowSettings()))

    def choice(self, planner: LocalPlanner, place: Place, grids: Grids) -> float:
        """Of one velocity."""
        now = LocalSituation(State(*place.pose, SPEED, 0.0), grids, self.path, place.obstacles)
        return on_thread(lambda: planner.command(now))[0]


def measure(data: Path | None) -> Figures:
    """A row for each part of a cycle."""
    path = np.column_stack((np.linspace(-WAY / 2, WAY / 2 + SIDE_OF_WINDOW, 200), np.zeros(200)))
    cycle = Cycle(RobotFootprint.polygon(JACKAL.footprint), Beams.of(JACKAL.scanner), path)
    places = list(_places(np.random.default_rng(5)))
    windows = [cycle.window(place) for place in places]
    cells = round(SIDE_OF_COSTMAP / RESOLUTION)
    rows = {
        f"costmap {cells} x {cells}, {JACKAL.scanner.beams} beams": [cycle.costmap(place, SIDE_OF_COSTMAP)[0] for place in places],
        "window": [took for took, _ in windows],
    }
    large = f"mppi {SAMPLES} x {STEPS}"
    planners: dict[str, LocalPlanner] = {
        name: Mppi(STACK_LIMITS, cycle.footprint, MppiSettings(samples=SAMPLES, steps=STEPS), 1)
        for name in (large, f"{large}, {MOVING} moving")
    }
    planners |= {name: make_local_planner(name, STACK_LIMITS, cycle.footprint, 1) for name in LOCAL_PLANNERS}
    for name, planner in planners.items():
        seen = [place._replace(obstacles=place.obstacles[:0]) for place in places] if name == large else places
        rows[name] = [cycle.choice(planner, place, grids) for place, (_, grids) in zip(seen, windows, strict=True)]
    return {name: _row(taken[1:]) for name, taken in rows.items()}


def _places(rng: np.random.Generator) -> Iterator[Place]:
    """Along the way, each among its own posts and moving discs."""
    for x in np.linspace(-WAY / 2, WAY / 2, PLACES):
        discs = np.column_stack((rng.uniform((x - SIDE, -SIDE), (x + SIDE, SIDE), (POSTS, 2)), rng.uniform(0.05, 0.3, POSTS)))
        discs = discs[np.abs(discs[:, 1]) - discs[:, 2] > LANE]
        at = rng.uniform((x + 1.0, -3.0), (x + 3.0, 3.0), (MOVING, 2))
        obstacles = np.column_stack((at, rng.uniform(-1.0, 1.0, (MOVING, 2)), np.full(MOVING, 0.25)))
        world = World("posts", Pose2(0.0, 0.0, 0.0), (WAY, 0.0), discs, np.zeros((0, 4)))
        pose = Pose2(float(x), float(rng.normal(0.0, 0.05)), float(rng.normal(0.0, 0.1)))
        yield Place(pose, Surroundings(world, 0.0).scan(np.array(pose), rng), obstacles)


def _row(taken: list[float]) -> dict[str, float]:
    return {"n": float(len(taken)), "ms": float(np.median(taken)), "p95 ms": float(np.percentile(taken, 95)), "worst ms": max(taken)}
