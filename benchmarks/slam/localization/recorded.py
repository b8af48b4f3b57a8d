"""Localization on a known map, over every log with relations below DATA/slam.

The map is made by the default method from the first half of a log (from all of it, where the first half closes no loop and makes a map
that the second contradicts: ``map %``), the vehicle is localized on the second half. Cases are LOG:WHAT.
``tracked``: from a start pose that is off by 0.1 m and 3 deg (1 sigma); ``odometry``: the same with noise added to the odometry until its
sigma is 1.5 times what it was, and 5 deg of veering a metre; ``corrupted``: with a fifth of all beams saying anything.
``global``: from nothing; ``kidnapped``: carried to another place, of which the odometry knows nothing. Found is who is within 0.3 m and
5 deg of the tracked pose after at most 10 m, and stays so until 12 m, wherever the map knows the place; ``sure of a wrong place`` is who
has said to be localized where he was not. Seeds choose places that the map knows, and half of the next 10 m.
Relations are those within the second half, in rooms that the first has not seen, too; those whose two places the map knows are in
``known m`` and ``known deg``; ``LOST %`` are sweeps at which it was looked for. Times are those of the thread, per sweep.
"""

import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from functools import cache, partial
from multiprocessing import get_context
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.slam.evaluation.odometry_noise import EstimatedNoise, disturbed
from benchmarks.slam.evaluation.variants import halves
from benchmarks.slam.logs import has_relations, logs_below
from launch.commands.bench import Case, Figures
from launch.commands.slam import DEFAULT_METHOD
from launch.slam.opening import open_log
from uvf.maths.se2 import Pose2, compose, inverse
from uvf.maths.se2_arrays import composed, inverted, steps
from uvf.slam.evaluation.relations import Relations, read_relations, relation_errors
from uvf.slam.localization import known_map
from uvf.slam.localization.beams import beams_of, field_of, fits_at
from uvf.slam.localization.localizer import Localizer, LocalizerState
from uvf.slam.localization.params import FilterParams
from uvf.slam.logs.laser_log import LaserLog
from uvf.slam.methods import make_method, method_params
from uvf.slam.reading import Reading

Floats = NDArray[np.float64]
Drive = list[Reading]

SEEDS = {"tracked": 50, "odometry": 10, "corrupted": 10, "global": 50, "kidnapped": 50}
WORKERS = 2
PARAMS = FilterParams()
START = (0.1, 0.1, np.radians(3.0))
NEAR, NEAR_TURN = 0.3, np.radians(5.0)
GIVEN, WATCHED = 10.0, 12.0  # m
KNOWN = 0.5
"""Share of a sweep's beams on walls of the map where the tracked pose is, from which on the map knows the place."""
BEFORE = 150  # readings before a kidnapping
BIAS = np.radians(5.0)  # rad per m
CORRUPTED = 0.2


@dataclass(frozen=True)
class Prepared:
    """part: of the log that the map is made from, 0..1; reference: (n, 3) tracked poses; fits: (n,) share of each sweep's beams on walls
    there; way: (n,) m; lost: whether the vehicle was looked for on the way."""

    part: float
    log: LaserLog
    relations: Relations
    known: known_map.KnownMap
    reference: Floats
    fits: Floats
    way: Floats
    lost: bool

    @property
    def places(self) -> NDArray[np.int64]:
        """Readings that the map knows, and half of those of the next metres."""
        ends = np.searchsorted(self.way, self.way + GIVEN)
        known = np.concatenate(((0,), np.cumsum(self.fits > KNOWN)))
        begins = np.arange(len(self.way))
        ahead = (known[ends] - known[begins]) / np.maximum(ends - begins, 1)
        return np.flatnonzero((self.fits > KNOWN) & (ahead > 0.5) & (self.way < self.way[-1] - WATCHED))


@cache
def prepared(path: Path) -> Prepared:
    """On the map of the first half; of the whole log, where the first half makes a map that the second contradicts. Raises BadInput."""
    log, relations = open_log(path), read_relations(next(path.parent.glob("*.relations")))
    found = _prepared(log, relations, 0.5)
    return _prepared(log, relations, 1.0) if found.lost else found


def _prepared(log: LaserLog, relations: Relations, part: float) -> Prepared:
    first, second, _ = halves(log, relations)
    method = make_method(DEFAULT_METHOD, method_params(DEFAULT_METHOD, {}, "defaults"))
    for reading in first if part < 1.0 else log:
        method.add(reading)
    method.finish()
    last = Pose2(*method.trajectory()[len(first) - 1].tolist())
    known = known_map.of_keyframes(tuple(method.keyframes()), log.name)
    between = compose(inverse(log.readings[len(first) - 1].odom_from_base), log.readings[len(first)].odom_from_base)
    told = list(timed(Localizer(known, PARAMS, 0, compose(last, between)), second))
    reference = np.array([pose for pose, _, _ in told])
    fits = np.array(
        [fits_at(pose[None], beams_of(r, PARAMS.beams), field_of(known)).fits[0] for pose, r in zip(reference, second, strict=True)]
    )
    ends = np.concatenate(((0.0,), np.cumsum(np.hypot(*steps(second.odom_from_base)[:, :2].T))))
    lost = any(state is LocalizerState.LOST for _, state, _ in told)
    return Prepared(part, second, relations, known, reference, fits, ends, lost)


def worse_odometry(log: LaserLog, reference: Floats, seed: int) -> LaserLog:
    """Its sigma is 1.5 times what it was, and it veers by BIAS [rad/m]."""
    noise = EstimatedNoise.of(log.odom_from_base, reference).times(np.sqrt(1.5**2 - 1.0))
    noisy = disturbed(log, noise, seed)
    moved = steps(noisy.odom_from_base)
    moved[:, 2] += BIAS * np.hypot(moved[:, 0], moved[:, 1])
    poses = [Pose2(*noisy.odom_from_base[0].tolist())]
    for step in moved.tolist():
        poses.append(compose(poses[-1], Pose2(*step)))
    return replace(noisy, readings=[replace(r, odom_from_base=p) for r, p in zip(noisy, poses, strict=True)])


def corrupted(log: LaserLog, reference: Floats, seed: int) -> LaserLog:
    """Of all beams a share of CORRUPTED says anything [m]."""
    rng = np.random.default_rng(seed)
    readings = []
    for r in log:
        ranges = r.ranges.copy()
        wrong = rng.random(len(ranges)) < CORRUPTED
        ranges[wrong] = rng.uniform(0.1, min(r.beams.range_max, 20.0), int(wrong.sum()))
        readings.append(replace(r, ranges=ranges))
    return replace(log, readings=readings)


def unchanged(log: LaserLog, reference: Floats, seed: int) -> LaserLog:
    """The log as it is."""
    return log


def timed(localizer: Localizer, readings: Iterable[Reading]) -> Iterator[tuple[Pose2, LocalizerState, float]]:
    """(map_from_base, state, CPU time [ms]) of each sweep."""
    for reading in readings:
        begun = time.thread_time()
        pose = localizer.add(reading).map_from_base
        yield pose, localizer.state, 1e3 * (time.thread_time() - begun)


def tracked(path: Path, spoil: Callable[[LaserLog, Floats, int], LaserLog], seed: int) -> dict[str, float]:
    """From a start pose that is a little off: errors of relations [m, deg], how often it was lost [%], and times [ms]."""
    p = prepared(path)
    log, rng = spoil(p.log, p.reference, seed), np.random.default_rng(seed)
    start = Pose2(*(p.reference[0] + rng.normal(size=3) * START).tolist())
    told = list(timed(Localizer(p.known, PARAMS, seed, start, np.diag(START) ** 2), log))
    poses, spent = np.array([pose for pose, _, _ in told]), [ms for _, _, ms in told]
    both = p.fits > KNOWN
    stamps = p.log.stamps
    of_known = relation_errors(p.relations, np.where(both, stamps, -1.0), poses)
    every = relation_errors(p.relations, stamps, poses)
    return {
        "m": float(every.freiburg_translation.mean()),
        "deg": float(np.degrees(every.rotation.mean())),
        "pairs": float(len(every.rotation)),
        "known m": float(of_known.freiburg_translation.mean()),
        "known deg": float(np.degrees(of_known.rotation.mean())),
        "known pairs": float(len(of_known.rotation)),
        "LOST %": 100.0 * float(np.mean([state is LocalizerState.LOST for _, state, _ in told])),
        "ms median": float(np.median(spent)),
        "ms mean": float(np.mean(spent)),
    }


def found(path: Path, carried: bool, seed: int) -> dict[str, float]:
    """From nothing or, ``carried``, from elsewhere: whether and after which way [m] it was found, and times [ms]."""
    p, rng = prepared(path), np.random.default_rng(seed)
    places = p.places
    begin = int(rng.choice(places))
    readings = p.log.readings[begin:]
    localizer = Localizer(p.known, PARAMS, seed)
    if carried:
        before = int(rng.choice(places[places < len(p.log.readings) - BEFORE]))
        localizer = Localizer(p.known, PARAMS, seed, Pose2(*p.reference[before].tolist()))
        for reading in p.log.readings[before : before + BEFORE]:
            localizer.add(reading)
        here = compose(p.log.readings[before + BEFORE - 1].odom_from_base, inverse(readings[0].odom_from_base))
        readings = [replace(r, odom_from_base=compose(here, r.odom_from_base)) for r in readings]
    way = p.way[begin:] - p.way[begin]
    told = list(timed(localizer, readings[: int(np.searchsorted(way, WATCHED))]))
    off = composed(inverted(p.reference[begin:][: len(told)]), np.array([pose for pose, _, _ in told]))
    wrong = (np.hypot(off[:, 0], off[:, 1]) > NEAR) | (np.abs(off[:, 2]) > NEAR_TURN)
    wrong &= p.fits[begin:][: len(told)] > KNOWN
    tracking = np.array([state is LocalizerState.TRACKING for _, state, _ in told])
    looked_for = np.flatnonzero(~tracking)
    noticed = int(looked_for[0]) if len(looked_for) else len(told)
    after = float(way[np.flatnonzero(wrong)[-1]]) if wrong.any() else 0.0
    return {
        "found %": 100.0 * (after < GIVEN),
        "found after m": after if after < GIVEN else np.nan,
        "noticed after m": float(way[noticed]) if noticed < len(told) else np.nan,
        "sure of a wrong place %": 100.0 * bool((tracking & wrong)[noticed:].any()),
        "ms median": float(np.median([ms for _, _, ms in told])),
        "ms mean": float(np.mean([ms for _, _, ms in told])),
    }


def over_seeds(one: "partial[dict[str, float]]", name: str, data: Path | None) -> Figures:
    """The mean of every column over the seeds, and the worst error [m]."""
    prepared(one.args[0])
    seeds = SEEDS[name.rpartition(":")[2]]
    with ProcessPoolExecutor(WORKERS, mp_context=get_context("fork")) as pool:
        rows = list(pool.map(one, range(seeds)))
    row = {column: float(np.nanmean([r[column] for r in rows])) for column in rows[0]}
    if "m" in row:
        row["worst m"] = float(np.max([r["m"] for r in rows]))
    return {name: {"seeds": seeds, "map %": 100.0 * prepared(one.args[0]).part, **row}}


def cases(data: Path | None) -> dict[str, Case]:
    """Raises BadInput without a folder of logs."""
    every: dict[str, Case] = {}
    for log, path in logs_below(data, "localization").items():
        if not has_relations(path):
            continue
        ways = {
            "tracked": partial(tracked, path, unchanged),
            "odometry": partial(tracked, path, worse_odometry),
            "corrupted": partial(tracked, path, corrupted),
            "global": partial(found, path, False),
            "kidnapped": partial(found, path, True),
        }
        every |= {f"{log}:{what}": partial(over_seeds, one, f"{log}:{what}") for what, one in ways.items()}
    return every


CASES = cases
