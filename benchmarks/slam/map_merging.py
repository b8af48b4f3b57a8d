"""Merging of sessions whose robots know nothing of each other, over every log below DATA/slam.

``LOG:cut N``: a log with relations is cut in two after N % of its readings, as if two robots had driven; each begins at its own zero, the
second one's map is laid anywhere. What counts are the relations across the cut; ``unbroken m`` is the error of the same relations when
one robot drives all of it. ``LOG+LOG``: the first 40 % of logs of two buildings (two folders), which must not join.
CPU and wall time are those of the merging, after a warm-up; pictures are put into ``runs/slam/bench``.
"""

import time
from dataclasses import dataclass
from functools import cache, partial
from itertools import combinations
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.slam.evaluation.variants import halves
from benchmarks.slam.logs import has_relations, logs_below
from launch import settings
from launch.commands.bench import Case, Figures
from launch.commands.slam import DEFAULT_METHOD
from launch.maps.merging import draw_team
from launch.slam.opening import open_log
from launch.slam.results import grid_of
from services.slam.merging.build import warm_up
from uvf.maths.se2 import Pose2
from uvf.maths.se2_arrays import composed, inverted
from uvf.slam.evaluation.relations import Relations, read_relations, relation_errors
from uvf.slam.evaluation.run import LogRun, run_over
from uvf.slam.maps.session import MappingSession
from uvf.slam.merging.team import Team
from uvf.slam.methods import make_method, method_params

Floats = NDArray[np.float64]

CUTS = (50, 25)  # per cent
BEGINNING = 0.4
RESOLUTION = 0.05  # m
NOTHING = Relations(np.zeros((0, 2)), np.zeros((0, 3)))
ANYWHERE = 100.0  # m


@dataclass(frozen=True)
class Merged:
    """What has become of sessions that were put together, and the CPU and wall time [s] that it took."""

    team: Team
    cpu: float
    wall: float

    @property
    def figures(self) -> dict[str, float]:
        """Whether there is one map now, and both times [s]."""
        return {"joined": float(len(self.team.groups) == 1), "CPU s": round(self.cpu, 2), "wall s": round(self.wall, 2)}


def merged(sessions: dict[str, MappingSession]) -> Merged:
    """Sessions handed to a team one after the other, after a warm-up."""
    warm_up()
    wall, cpu, team = time.perf_counter(), time.process_time(), Team()
    for name, session in sessions.items():
        team.follow(name, session)
    team.finish()
    return Merged(team, time.process_time() - cpu, time.perf_counter() - wall)


@cache
def unbroken(path: Path) -> LogRun:
    """The whole log as one robot drives it."""
    return run_over(open_log(path), make_method(DEFAULT_METHOD, method_params(DEFAULT_METHOD, {}, "defaults")))


@cache
def parts(path: Path, share: float, both: bool) -> list[LogRun]:
    """Of the log up to a share of its readings, and of the rest if it is wanted."""
    logs = halves(open_log(path), NOTHING, share)[: 2 if both else 1]
    return [run_over(log, make_method(DEFAULT_METHOD, method_params(DEFAULT_METHOD, {}, "defaults"))) for log in logs]


def session_of(run: LogRun) -> MappingSession:
    """The session of a run whose method keeps one."""
    assert run.session is not None
    return run.session


def laid_anywhere(session: MappingSession, seed: int) -> MappingSession:
    """The session in a frame of its own: within ANYWHERE [m] and turned by anything."""
    x, y, yaw = np.random.default_rng(seed).uniform(-1.0, 1.0, 3).tolist()
    return session.moved(Pose2(x * ANYWHERE, y * ANYWHERE, yaw * np.pi))


def team_from_readings(run: LogRun, placed: Floats) -> Floats:
    """(readings, 3): each with the keyframe before it. placed: (keyframes, 3) team_from_base."""
    own = np.array([k.map_from_base for k in run.keyframes])
    stamps = np.array([k.reading.t for k in run.keyframes])
    of = np.maximum(np.searchsorted(stamps, [reading.t for reading in run.log], side="right") - 1, 0)
    return composed(placed[of], composed(inverted(own[of]), run.final))


def errors(relations: Relations, stamps: Floats, poses: Floats) -> dict[str, float]:
    """Of poses against relations: mean, median and worst [m], and the mean turn [deg]."""
    found = relation_errors(relations, stamps, poses)
    metres = found.freiburg_translation
    return {
        "pairs": len(metres),
        "m": float(metres.mean()),
        "median m": float(np.median(metres)),
        "worst m": float(metres.max()),
        "> 0.5 m": float((metres > 0.5).sum()),
        "deg": float(np.degrees(found.rotation.mean())),
    }


def cut(log: str, path: Path, per_cent: int, data: Path | None) -> Figures:
    """One log as two robots' after ``per_cent`` of its readings: whether they join, the errors across the cut, and times [s]."""
    first, second = parts(path, per_cent / 100.0, True)
    found = merged({"first": session_of(first), "second": laid_anywhere(session_of(second), per_cent)})
    row = found.figures
    if row["joined"]:
        group, whole = found.team.groups[0], unbroken(path)
        relations = halves(whole.log, read_relations(next(path.parent.glob("*.relations"))), per_cent / 100.0)[2]
        poses = [team_from_readings(run, group.joint.poses[name]) for run, name in ((first, "first"), (second, "second"))]
        row = {"joined": 1.0, **errors(relations, np.concatenate((first.log.stamps, second.log.stamps)), np.concatenate(poses))}
        row |= {"unbroken m": errors(relations, whole.log.stamps, whole.final)["m"], "closures": float(len(group.joint.crossings))}
        row |= {"agreement": round(group.quality, 3)} | found.figures
        folder = settings.runs_folder() / "slam" / "bench"
        folder.mkdir(parents=True, exist_ok=True)
        picture = folder / f"merge-{log.replace('/', '-')}-{per_cent}.png"
        draw_team(group, grid_of(found.team.session_of(group).keyframes, RESOLUTION), picture)
    return {f"{log}:cut {per_cent}": row}


def strangers(name: str, path: Path, other: Path, data: Path | None) -> Figures:
    """The beginnings of two buildings' logs, which must not join, and times [s]."""
    sessions = {of: session_of(parts(p, BEGINNING, False)[0]) for of, p in (("one", path), ("other", other))}
    return {name: merged(sessions).figures}


def cases(data: Path | None) -> dict[str, Case]:
    """Raises BadInput without a folder of logs."""
    logs = logs_below(data, "merge")
    found: dict[str, Case] = {}
    for log, path in logs.items():
        if has_relations(path):
            found |= {f"{log}:cut {n}": partial(cut, log, path, n) for n in CUTS}
    for (one, path), (other, other_path) in combinations(logs.items(), 2):
        if path.parent != other_path.parent:
            found[f"{one}+{other}"] = partial(strangers, f"{one}+{other}", path, other_path)
    return found


CASES = cases
