"""The same log under harder conditions: what holds on it only is worth nothing.

Each takes a log with the relations that are known of it, and the best poses (readings, 3) that a run over it has found, and gives back
log and relations of the harder one. Relations are kept between readings that are still there.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from benchmarks.slam.evaluation.odometry_noise import EstimatedNoise, disturbed, exaggerated
from uvf.maths.se2 import Pose2
from uvf.maths.se2_arrays import composed, inverted
from uvf.slam.evaluation.relations import Relations, index_of
from uvf.slam.logs.laser_log import LaserLog, OdometryTrack
from uvf.slam.reading import Beams, Reading

Floats = NDArray[np.float64]
Known = tuple[LaserLog, Relations]
Variant = Callable[[LaserLog, Relations, Floats], Known]

MIRROR = np.array((1.0, -1.0, -1.0))
SEED = 7


def unchanged(log: LaserLog, relations: Relations, best: Floats) -> Known:
    """The log as it is."""
    return log, relations


def mirrored(log: LaserLog, relations: Relations, best: Floats) -> Known:
    """Left and right exchanged: a lidar that turns the other way, in a building that is the image of the real one."""
    shapes: dict[int, Beams] = {}
    for reading in log:
        b = reading.beams
        if id(b) not in shapes:
            shapes[id(b)] = replace(b, origin=(b.origin[0], -b.origin[1]), bearings=-b.bearings)
    readings = [replace(r, beams=shapes[id(r.beams)], odom_from_base=Pose2(*(MIRROR * r.odom_from_base).tolist())) for r in log]
    track = log.odometry and OdometryTrack(log.odometry.t, log.odometry.odom_from_base * MIRROR)
    image = Relations(relations.stamps, relations.first_from_second * MIRROR)
    return replace(log, name=f"{log.name} mirrored", readings=readings, odometry=track), image


def noisier(log: LaserLog, relations: Relations, best: Floats) -> Known:
    """The odometry's noise doubled: a random walk of as much again is added."""
    noise = EstimatedNoise.of(log.odom_from_base, best).times(np.sqrt(3.0))
    return replace(disturbed(log, noise, SEED), name=f"{log.name} noisier"), relations


def worse(log: LaserLog, relations: Relations, best: Floats) -> Known:
    """Every error of the odometry doubled, steady ones and slipping wheels too."""
    return replace(exaggerated(log, best), name=f"{log.name} worse"), relations


def every_third(log: LaserLog, relations: Relations, best: Floats) -> Known:
    """Two of three readings dropped."""
    return _only(log, relations, np.arange(len(log)) % 3 == 0, "every third")


def from_the_middle(log: LaserLog, relations: Relations, best: Floats) -> Known:
    """Without the first half of its readings."""
    return _only(log, relations, np.arange(len(log)) >= len(log) // 2, "from the middle")


VARIANTS: dict[str, Variant] = {
    "plain": unchanged,
    "mirrored": mirrored,
    "noise-x2": noisier,
    "error-x2": worse,
    "every-third": every_third,
    "from-middle": from_the_middle,
}


def halves(log: LaserLog, relations: Relations, share: float = 0.5) -> tuple[LaserLog, LaserLog, Relations]:
    """Cut in two after a ``share`` of the readings, as if two robots had driven, and the relations across the cut.

    Neither knows of the other: each odometry begins at zero.
    """
    first = np.arange(len(log)) < round(share * len(log))
    ends = index_of(log.stamps, relations.stamps)
    known: NDArray[np.bool_] = ends.min(axis=1) >= 0
    across = known & (np.sum(first[ends], axis=1) == 1)
    nothing = relations.only(np.zeros(len(relations), dtype=np.bool_))
    parts = [_only(log, nothing, mask, name)[0] for mask, name in ((first, "first part"), (~first, "second part"))]
    return parts[0], parts[1], relations.only(across)


def _only(log: LaserLog, relations: Relations, kept: NDArray[np.bool_], name: str) -> Known:
    indices = np.flatnonzero(kept).tolist()
    start = inverted(np.array(log.readings[indices[0]].odom_from_base))
    poses = composed(start, log.odom_from_base[kept]).tolist()
    readings = [replace(log.readings[i], odom_from_base=Pose2(*pose)) for i, pose in zip(indices, poses, strict=True)]
    ends = index_of(log.stamps[kept], relations.stamps)
    track = log.odometry and _within(log.odometry, readings, start)
    part = replace(log, name=f"{log.name} {name}", readings=readings, stamps=log.stamps[kept], odometry=track, notes=())
    return part, relations.only(ends.min(axis=1) >= 0)


def _within(track: OdometryTrack, readings: list[Reading], start: Floats) -> OdometryTrack:
    """As much of a track as the readings last, and a second before and after."""
    inside = (track.t >= readings[0].t - 1.0) & (track.t <= readings[-1].t + 1.0)
    return OdometryTrack(track.t[inside], composed(start, track.odom_from_base[inside]))
