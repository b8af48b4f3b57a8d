"""How noisy a log's odometry is, told from a trajectory that is better; and logs whose odometry is worse.

The noise is modelled as a random walk along the way (Thrun, Burgard & Fox, "Probabilistic Robotics", 2005, section 5.4): variances
grow with the metres driven and the radians turned. What is the same all along (a wheel that is larger than the other) is no noise.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import nnls

from uvf.maths.se2 import Pose2, compose
from uvf.maths.se2_arrays import composed, interpolated, inverted, steps, wrapped
from uvf.slam.logs.laser_log import LaserLog, OdometryTrack

Floats = NDArray[np.float64]

STRETCH, LEVER = 2.0, 0.5
"""m of way, and those that a radian counts as: the noise is told from stretches so long that errors of the matching vanish beside it."""
FEWEST = 10
"""Stretches, below which there is no telling."""
OUTLIER = 3.0
"""In root mean squares: larger ones are wheels that slipped, not noise."""


@dataclass(frozen=True)
class EstimatedNoise:
    """1 sigma. along: m per m^1/2 driven, in the direction of travel; turning: rad per rad^1/2 turned; veering: rad per m^1/2 driven.

    The figures here are those of a usual small indoor vehicle.
    """

    along: float = 0.04
    turning: float = 0.05
    heading_drift: float = 0.03

    def times(self, factor: float) -> "EstimatedNoise":
        """The same, ``factor`` times as large."""
        return EstimatedNoise(factor * self.along, factor * self.turning, factor * self.heading_drift)

    @classmethod
    def of(cls, odom_from_base: Floats, map_from_base: Floats) -> "EstimatedNoise":
        """Of odometry (n, 3), told from better poses (n, 3) of the same readings; the usual figures where the way is too short."""
        driven, turned = _ways(odom_from_base)
        marks = np.unique(np.searchsorted(way := driven + LEVER * turned, np.arange(0.0, way[-1], STRETCH)))
        if len(marks) <= FEWEST:
            return cls()
        told, known = (composed(inverted(poses[marks[:-1]]), poses[marks[1:]]) for poses in (odom_from_base, map_from_base))
        length, angle = np.diff(driven[marks]), np.diff(turned[marks])
        ahead = known[:, :2] / np.maximum(np.hypot(known[:, 0], known[:, 1]), 1e-9)[:, None]
        forward = _unsteady(((told - known)[:, :2] * ahead).sum(axis=1), length[None])
        heading = _unsteady(wrapped(told[:, 2] - known[:, 2]), np.stack((length, wrapped(known[:, 2]))))
        along = _variances(forward, length[None])
        heading_drift, turning = _variances(heading, np.stack((length, angle)))
        return cls(float(np.sqrt(along[0])), float(np.sqrt(turning)), float(np.sqrt(heading_drift)))


def _unsteady(errors: Floats, motions: Floats) -> Floats:
    """What is left of errors (n,) without their parts that are proportional to the motions (k, n)."""
    left: Floats = errors - np.linalg.lstsq(motions.T, errors, rcond=None)[0] @ motions
    return left


def _variances(errors: Floats, spans: Floats) -> Floats:
    """Variance per unit of each span (k, n) that explain the errors (n,), none of them negative; outliers left out."""
    squares = np.square(errors)
    usual = squares <= OUTLIER**2 * squares.mean()
    found: Floats = nnls(spans[:, usual].T, squares[usual])[0]
    return found


def _ways(poses: Floats) -> tuple[Floats, Floats]:
    """(n,) m driven and rad turned until each pose."""
    moved = steps(poses)
    driven = np.concatenate(((0.0,), np.cumsum(np.hypot(moved[:, 0], moved[:, 1]))))
    return driven, np.concatenate(((0.0,), np.cumsum(np.abs(moved[:, 2]))))


def disturbed(log: LaserLog, noise: EstimatedNoise, seed: int) -> LaserLog:
    """The log with a random walk added to its odometry."""
    return _with_odometry(log, _walked(log.odom_from_base, noise, np.random.default_rng(seed)))


def exaggerated(log: LaserLog, map_from_base: Floats) -> LaserLog:
    """The log with all errors of its odometry doubled, steady ones too, as better poses (n, 3) tell them step by step."""
    told, known = steps(log.odom_from_base), steps(map_from_base)
    return _with_odometry(log, _chained(composed(told, composed(inverted(known), told))))


def _with_odometry(log: LaserLog, noisy: Floats) -> LaserLog:
    """The readings get these poses (n, 3), the raw track goes with them."""
    readings = [replace(r, odom_from_base=Pose2(*pose)) for r, pose in zip(log, noisy.tolist(), strict=True)]
    if log.odometry is None:
        return replace(log, readings=readings)
    times, wanted = np.array([r.t for r in log]), log.odometry.t
    before, after = (interpolated(_track(times, poses), wanted) for poses in (log.odom_from_base, noisy))
    # What the track is off the readings' poses stays.
    carried = composed(inverted(before), log.odometry.odom_from_base)
    return replace(log, readings=readings, odometry=OdometryTrack(wanted, composed(after, carried)))


def _track(times: Floats, poses: Floats) -> Floats:
    """(n, 4) rows t, x, y, yaw, yaws without leaps."""
    return np.column_stack((times, poses[:, :2], np.unwrap(poses[:, 2])))


def _walked(poses: Floats, noise: EstimatedNoise, rng: np.random.Generator) -> Floats:
    moved = steps(poses)
    driven, turned = np.hypot(moved[:, 0], moved[:, 1]), np.abs(moved[:, 2])
    along = rng.normal(size=len(moved)) * noise.along * np.sqrt(driven)
    heading = rng.normal(size=len(moved)) * np.sqrt(noise.turning**2 * turned + noise.heading_drift**2 * driven)
    direction = np.arctan2(moved[:, 1], moved[:, 0])
    # The turn is uncertain while it is made: half of it before the step, half of it after.
    shifted = np.column_stack((along * np.cos(direction), along * np.sin(direction), np.zeros(len(moved))))
    half = np.column_stack((np.zeros((len(moved), 2)), heading / 2.0))
    return _chained(composed(composed(half, moved + shifted), half))


def _chained(moved: Floats) -> Floats:
    """(n + 1, 3) poses from zero on, one step (n, 3) after the other."""
    found = [Pose2(0.0, 0.0, 0.0)]
    for step in moved.tolist():
        found.append(compose(found[-1], Pose2(*step)))
    return np.array(found)
