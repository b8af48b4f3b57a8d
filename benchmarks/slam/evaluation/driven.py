"""A lidar and a wheel odometry that drive through a made-up building: a log whose truth is known."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from benchmarks.slam.evaluation.building import cast
from uvf.maths.se2 import Pose2
from uvf.maths.se2_arrays import composed, inverted, steps, wrapped
from uvf.slam.logs.laser_log import LaserLog, OdometryTrack
from uvf.slam.reading import Beams, Reading

Floats = NDArray[np.float64]

SCAN_HZ = 5.0
SPEED, TURN_RATE = 0.6, 0.6  # m/s, rad/s
WEAVE, WAVE = 0.25, 11.0  # m to either side, m from one to the next
RANGE_NOISE = 0.012  # m, 1 sigma


@dataclass(frozen=True)
class Driven:
    """A log and the true poses (readings, 3) of the base, in the frame of the first."""

    log: LaserLog
    map_from_base: Floats


@dataclass(frozen=True)
class Wear:
    """What the odometry gets wrong: shares of way and turn that it loses for good, veering [rad/m], noise per root of m and rad."""

    along: float = 0.01
    turning: float = -0.03
    heading_drift: float = 0.002
    noise: tuple[float, float, float] = (0.02, 0.03, 0.004)


def route(corners: Floats) -> Floats:
    """(n, 3) poses at SCAN_HZ of a vehicle that drives from corner to corner (m, 2) and turns on the spot."""
    legs = [(p, q - p, float(np.arctan2(*(q - p)[::-1]))) for p, q in pairwise(corners)]
    parts, heading = [], legs[0][2]
    for start, way, wanted in legs:
        parts += [_turn(start, heading, wanted), _leg(start, way, wanted)]
        heading = wanted
    return np.concatenate(parts)


def _turn(place: Floats, heading: float, wanted: float) -> Floats:
    turn = float(wrapped(np.array(wanted - heading)))
    share = np.linspace(0.0, 1.0, max(2, int(abs(turn) / TURN_RATE * SCAN_HZ)), endpoint=False)
    return np.column_stack((np.tile(place, (len(share), 1)), heading + share * turn))


def _leg(start: Floats, way: Floats, heading: float) -> Floats:
    """Weaves a little, as people drive."""
    length = float(np.hypot(*way))
    s = np.arange(0.0, length, SPEED / SCAN_HZ)
    weave = WEAVE * np.sin(2 * np.pi * s / WAVE) * np.minimum(1.0, np.minimum(s, length - s))
    along, across = way / length, np.array((-way[1], way[0])) / length
    yaw = heading + np.arctan(np.gradient(weave, s))
    return np.column_stack((start + s[:, None] * along + weave[:, None] * across, yaw))


def drive(poses: Floats, walls: Floats, beams: Beams, wear: Wear, seed: int) -> Driven:
    """A log of ``poses`` (n, 3): ranges with noise, rounded to a centimetre; odometry that wears."""
    rng = np.random.default_rng(seed)
    true = composed(inverted(poses[0]), poses)
    lidar = composed(poses, np.array((*beams.origin, 0.0)))
    ranges = np.array([cast(p, beams.directions, walls, beams.range_max) for p in lidar])
    returned = ranges < beams.range_max
    noisy = np.where(returned, np.round(ranges + RANGE_NOISE * rng.standard_normal(ranges.shape), 2), beams.range_max + 1.0)
    odometry = _worn(steps(poses), wear, rng)
    times = np.arange(len(poses)) / SCAN_HZ
    readings = [Reading(t, r, beams, Pose2(*o)) for t, r, o in zip(times.tolist(), noisy, odometry.tolist(), strict=True)]
    return Driven(LaserLog("building", readings, times, OdometryTrack(times, odometry)), true)


def _worn(moved: Floats, wear: Wear, rng: np.random.Generator) -> Floats:
    way, turn = np.hypot(moved[:, 0], moved[:, 1]), np.abs(moved[:, 2])
    along, turning, heading_drift = wear.noise
    off = np.zeros_like(moved)
    off[:, 0] = wear.along * moved[:, 0] + along * np.sqrt(way) * rng.standard_normal(len(way))
    off[:, 2] = wear.turning * moved[:, 2] + wear.heading_drift * way
    off[:, 2] += (turning * np.sqrt(turn) + heading_drift * np.sqrt(way)) * rng.standard_normal(len(way))
    poses = np.zeros((len(moved) + 1, 3))
    for i, step in enumerate(moved + off):
        poses[i + 1] = composed(poses[i], step)
    return poses
