"""A rover explores a world, and comes again to be localized on the map of its first visit: error against the truth, in lockstep.

The map is made by the default method from what the first visit has recorded. The second visit begins at the same start pose, as its
mission says, or anywhere. Errors count from 10 s on, and after it was off by more than 0.3 m or 5 deg for the last time.
"""

import tempfile
from functools import partial
from pathlib import Path

import numpy as np
import yaml
from numpy.typing import NDArray

from launch.commands.bench import Figures
from launch.commands.slam import DEFAULT_METHOD
from launch.run import run_lockstep
from launch.scoring.truth import true_poses
from schemas import topics
from schemas.messages import MapFix
from uvf.maths.se2_arrays import composed, interpolated, wrapped
from uvf.models.scenario import load_scenario
from uvf.runtime.log.laser_log import read_mcap
from uvf.runtime.log.reading import read_log
from uvf.runtime.messages.convert import seconds
from uvf.slam.maps.session import NO_EDGES, MappingSession
from uvf.slam.methods import make_method, method_params

Floats = NDArray[np.float64]

STARTS = {"house": (2.2, 1.3, 0.5), "watkins": (1.0, 1.2, 0.0)}
MAPPING, VISIT = 240.0, 120.0  # s
VEHICLE = "rover"
SPACING = 1.5  # m between waypoints of the second visit
SETTLED = 10.0  # s
NEAR, NEAR_TURN = 0.3, np.radians(5.0)


def mission(world: str, seed: int, job: dict[str, object], maps: dict[str, object] | None) -> dict[str, object]:
    """Of one rover in a world, with a job and, on its second visit, with maps."""
    x, y, yaw = STARTS[world]
    entry = {"model": "burger", "system_id": 2, "start": {"x": x, "y": y, "yaw": yaw}, "job": job}
    return {"about": "A visit.", "world": world, "seed": seed, "vehicles": {VEHICLE: entry | ({"maps": maps} if maps else {})}}


def drive(folder: Path, name: str, content: dict[str, object], duration: float) -> Path:
    """Runs a mission for ``duration`` [s] in lockstep, and returns its log."""
    path = folder / f"{name}.yaml"
    path.write_text(yaml.safe_dump(content))
    log = folder / f"{name}.mcap"
    run_lockstep(load_scenario(path), duration, log)
    return log


def mapped(log: Path, folder: Path) -> tuple[float, float, float]:
    """Leaves known.npz in the folder; where its frame, the base at the first sweep, truly lies in the world."""
    readings = read_mcap(log, VEHICLE)
    method = make_method(DEFAULT_METHOD, method_params(DEFAULT_METHOD, {}, "defaults"))
    for reading in readings:
        method.add(reading)
    method.finish()
    MappingSession(tuple(method.keyframes()), NO_EDGES, DEFAULT_METHOD, {}).save(folder / "known.npz")
    x, y, yaw = interpolated(true_poses(read_log(log), VEHICLE), np.array(readings.stamps[:1]))[0].tolist()
    return x, y, yaw


def visits(world: str, data: Path | None) -> Figures:
    """A row for each way to begin the second visit: errors [m, deg] and NEES."""
    with tempfile.TemporaryDirectory() as name:
        folder, rows = Path(name), {}
        first = drive(folder, "first", mission(world, 1, {"explore": True}, None), MAPPING)
        known: dict[str, object] = {"known": "known.npz", "known_at": list(mapped(first, folder))}
        job: dict[str, object] = {"mission": _waypoints(true_poses(read_log(first), VEHICLE))}
        for begun in ("start", "anywhere"):
            log = drive(folder, begun, mission(world, 2, job, known | {"localize": begun}), VISIT)
            rows[f"{world} from {begun}"] = _row(log, STARTS[world])
        return rows


def _row(log: Path, world_from_map: tuple[float, float, float]) -> dict[str, float]:
    fixes = [MapFix.FromString(s.payload) for s in read_log(log) if s.key == topics.MAP_POSE.at(VEHICLE)]
    stamps = np.array([seconds(f.timestamp) for f in fixes])
    truth = true_poses(read_log(log), VEHICLE)
    told = composed(np.array(world_from_map), np.array([(f.x, f.y, f.yaw) for f in fixes]))
    off = told - interpolated(truth, stamps)
    off[:, 2] = wrapped(off[:, 2])
    wrong = np.flatnonzero((np.hypot(*off[:, :2].T) > NEAR) | (np.abs(off[:, 2]) > NEAR_TURN))
    settled = stamps > max(SETTLED, stamps[wrong[-1]] if len(wrong) else 0.0)
    in_map = composed(np.array((0.0, 0.0, -world_from_map[2])), np.column_stack((off[:, :2], np.zeros(len(off)))))
    in_map[:, 2] = off[:, 2]
    covariances = np.array([np.reshape(f.covariance, (3, 3)) for f in fixes])
    nees = np.einsum("ni,nij,nj->n", in_map, np.linalg.inv(covariances), in_map) / 3.0
    return {
        "RMSE m": float(np.sqrt((off[settled, :2] ** 2).sum(axis=1).mean())),
        "RMSE deg": float(np.degrees(np.sqrt((off[settled, 2] ** 2).mean()))),
        "max m": float(np.hypot(*off[settled, :2].T).max()),
        "NEES / 3": float(nees[settled].mean()),
        "last off by 0.3 m or 5 deg after s": float(stamps[wrong[-1]]) if len(wrong) else 0.0,
        "driven m": float(np.hypot(*np.diff(truth[:, 1:3], axis=0).T).sum()),
        "quality": float(np.mean([f.quality for f in fixes])),
    }


def _waypoints(truth: Floats) -> list[dict[str, float]]:
    """Along the way of the first visit."""
    way = np.concatenate(((0.0,), np.cumsum(np.hypot(*np.diff(truth[:, 1:3], axis=0).T))))
    marks = np.searchsorted(way, np.arange(SPACING, way[-1], SPACING))
    return [{"x": float(x), "y": float(y)} for x, y in truth[marks, 1:3]]


CASES = {world: partial(visits, world) for world in STARTS}
