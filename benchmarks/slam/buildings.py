"""The default SLAM method in made-up corridor buildings of more than a kilometre of driving, whose truth is known.

Twice round an outer loop of 320 m, then through a corridor across it and back; doors at uneven places, rooms behind some. Buildings A
to C are driven by usual wheels (1 % of way, 3 % of turns, 0.1 degrees a metre lost), D by bad ones (5 %, 10 %, 1 degree a metre);
``odometry`` tells where dead reckoning would be. Nothing is aligned but the first pose. ``bend``: worst of the corridors' walls by
the points that beams have hit, in degrees over 50 m; ``scale %``: how much too far apart parallel walls are. Both are told of maps
that lie on the plan. Results of each case, with pictures, are put into ``runs/slam_building``.
"""

from functools import partial
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.slam.evaluation.building import corridors
from benchmarks.slam.evaluation.driven import Driven, Wear, drive, route
from benchmarks.slam.evaluation.straightness import hit_points, straight_walls, straightness
from benchmarks.slam.methods import RESOLUTION, WARM_UP, alone
from launch import settings
from launch.commands.bench import Figures
from launch.commands.slam import DEFAULT_METHOD
from launch.slam.known import Known
from launch.slam.results import Made, write_results
from launch.slam.scoring import figures
from uvf.maths.se2 import IDENTITY
from uvf.maths.se2_arrays import composed, inverted
from uvf.slam.evaluation.reference import Trajectory
from uvf.slam.evaluation.run import LogRun, run_over
from uvf.slam.methods import make_method, method_params
from uvf.slam.reading import Beams

Floats = NDArray[np.float64]

WIDE, DEEP, ACROSS = 110.0, 50.0, 60.0  # m: the outer loop, and where the corridor across it is
LIDAR = Beams((0.1, 0.0), np.radians(np.linspace(-90.0, 90.0, 181)), 0.1, 30.0)
NICHE = 1.5  # m, shorter walls are none of a corridor's
BAD = Wear(0.05, -0.1, 0.02, (0.06, 0.1, 0.015))
LIES_ON_IT = 2.0  # m, the farthest that a map may be off in which the walls of the plan are looked for
BUILDINGS = {"A": (Wear(), 1), "B": (Wear(), 2), "C": (Wear(), 3), "D": (BAD, 4)}


def building(wear: Wear, seed: int) -> tuple[Driven, Floats]:
    """A log, and the walls (n, 4) in the frame of its first pose."""
    ring = ((0.0, 0.0), (WIDE, 0.0), (WIDE, DEEP), (0.0, DEEP), (0.0, 0.0))
    middle = ((ACROSS, 0.0), (ACROSS, DEEP), (0.0, DEEP), (0.0, 0.0))
    poses = route(np.array((*ring, *ring[1:], *middle, *ring[1:3], (ACROSS, DEEP), middle[0])))
    lines = np.array([(*p, *q) for p, q in pairwise(ring)] + [(*middle[0], *middle[1])])
    walls = corridors(lines, np.random.default_rng(seed))
    back = inverted(poses[0])
    ends = [composed(back, np.column_stack((walls[:, i : i + 2], np.zeros(len(walls)))))[:, :2] for i in (0, 2)]
    return drive(poses, walls, LIDAR, wear, seed), np.column_stack(ends)


def measured(method: str, name: str) -> dict[str, float]:
    """Errors [m, deg] and speed of a method in one building; bend and scale of its walls where the map lies on the plan."""
    wear, seed = BUILDINGS[name]
    driven, walls = building(wear, seed)
    params = method_params(method, {}, "defaults")
    warm = make_method(method, params)
    for reading in driven.log.readings[:WARM_UP]:
        warm.add(reading)
    run = run_over(driven.log, make_method(method, params))
    known = Known({}, {"truth": Trajectory(driven.log.stamps, driven.map_from_base)})
    folder = settings.runs_folder() / "slam_building" / f"{name}-{method}"
    write_results(run, known, Made(method, params, RESOLUTION), figures(run, known), folder)
    row = _errors(run, driven) | {"x real time": run.times_real_time}
    return row | _shape(run, walls) if row["final max m"] < LIES_ON_IT else row


def _errors(run: LogRun, driven: Driven) -> dict[str, float]:
    way = float(np.hypot(*np.diff(driven.map_from_base[:, :2], axis=0).T).sum())
    row = {"driven m": way}
    for when, poses in (("final", run.final), ("online", run.online)):
        off = composed(inverted(driven.map_from_base), poses)
        distances = np.hypot(off[:, 0], off[:, 1])
        row[f"{when} RMSE m"] = float(np.sqrt((distances**2).mean()))
        row[f"{when} max m"] = float(distances.max())
        row[f"{when} RMSE deg"] = float(np.degrees(np.sqrt((off[:, 2] ** 2).mean())))
    return row


def _shape(run: LogRun, walls: Floats) -> dict[str, float]:
    lengths = np.hypot(walls[:, 2] - walls[:, 0], walls[:, 3] - walls[:, 1])
    found = straightness(hit_points(run.keyframes, IDENTITY), straight_walls(walls[lengths > NICHE].reshape(-1, 2, 2)))
    return {"walls": found.walls, "bend": float(np.degrees(found.bend)), "scale %": 100.0 * found.scale}


def _case(method: str, name: str, data: Path | None) -> Figures:
    return {f"{method}:{name}": alone(measured, method, name)}


CASES = {f"{method}:{name}": partial(_case, method, name) for method in (DEFAULT_METHOD, "odometry") for name in BUILDINGS}
