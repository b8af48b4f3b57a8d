"""The estimates as messages."""

from math import cos, isfinite, sin, sqrt, tan
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from schemas.messages import EstimateQuality, Event, FrameTransform, KeyValuePair, NavState, Odometry, Pose, Vector3
from uvf.estimation.odometry.calibration import Scales, WheelCalibration
from uvf.estimation.odometry.filter import DriveFilter
from uvf.estimation.odometry.slip import sigma
from uvf.estimation.odometry.states import HEADING, POSE, SPEED
from uvf.maths.kinematics import Twist
from uvf.maths.rotations import from_euler
from uvf.maths.se2 import Pose2
from uvf.runtime.messages.convert import quaternion, stamp

Floats = NDArray[np.float64]

SOURCE = "odometry"
PLANAR = (0, 1, 5)  # rows of a covariance in space: x, y, heading
SIDEWAYS = 1e-4  # m^2/s^2, variance of a speed that most have none of


class Stance(NamedTuple):
    """Height [m], roll and pitch [rad] of the ground that the vehicle stands on."""

    height: float
    roll: float
    pitch: float

    def pose(self, seen_from_above: Pose2) -> Pose:
        """The pose in space."""
        x, y, yaw = seen_from_above
        return Pose(position=Vector3(x=x, y=y, z=self.height), orientation=quaternion(from_euler(self.roll, self.pitch, yaw)))


def odometry(t: float, vehicle: str, odom_from_base: Pose, drive: DriveFilter, left_over: dict[str, str]) -> Odometry:
    """Pose of base_footprint in the odom frame [m, rad], speeds and covariances as a message stamped ``t`` [s].

    left_over: what the next instance needs.
    """
    linear, angular, lateral = drive.velocity
    pose, twist = np.zeros((6, 6)), np.zeros((6, 6))
    pose[np.ix_(PLANAR, PLANAR)] = drive.covariance[POSE, POSE]
    twist[0, 0], twist[1, 1], twist[5, 5] = drive.covariance[SPEED, SPEED], SIDEWAYS, drive.turn_rate_variance
    return Odometry(
        timestamp=stamp(t),
        frame_id=f"{vehicle}/odom",
        body_frame_id=f"{vehicle}/base_footprint",
        pose=odom_from_base,
        linear_velocity=Vector3(x=linear, y=lateral),
        angular_velocity=Vector3(z=angular),
        pose_covariance=pose.ravel().tolist(),
        velocity_covariance=twist.ravel().tolist(),
        metadata=[KeyValuePair(key=k, value=v) for k, v in left_over.items()],
    )


def pose_covariance(told: Odometry) -> Floats:
    """Covariance (3, 3) of x, y [m^2] and heading [rad^2]; zero where the message has none."""
    if len(told.pose_covariance) != 36:
        return np.zeros((3, 3))
    found = np.array(told.pose_covariance).reshape(6, 6)[np.ix_(PLANAR, PLANAR)]
    is_one = bool(np.isfinite(found).all()) and np.allclose(found, found.T) and np.linalg.eigvalsh(found)[0] > -1e-9
    return found if is_one else np.zeros((3, 3))


def rate_sigmas(told: Odometry) -> tuple[float, float] | None:
    """1 sigma of the speed [m/s], sideways too, and of the turn rate [rad/s]; None where the message has none."""
    if len(told.velocity_covariance) != 36:
        return None
    forward, sideways, turn = np.diag(np.array(told.velocity_covariance).reshape(6, 6))[list(PLANAR)].tolist()
    is_one = all(isfinite(variance) and variance > 0.0 for variance in (forward, sideways, turn))
    return (sqrt(forward + sideways), sqrt(turn)) if is_one else None


def moving(t: float, vehicle: str, odom_from_base: Pose) -> FrameTransform:
    """The frame odom -> base_footprint stamped ``t`` [s]."""
    return FrameTransform(
        timestamp=stamp(t),
        parent_frame_id=f"{vehicle}/odom",
        child_frame_id=f"{vehicle}/base_footprint",
        translation=odom_from_base.position,
        rotation=odom_from_base.orientation,
    )


def nav_state(t: float, world_from_base: Pose2, stance: Stance, velocity: Twist, position_sigma: float) -> NavState:
    """Pose [m, rad, world] and velocity seen from above, as a message stamped ``t`` [s]; position_sigma [m]."""
    linear, angular, lateral = velocity
    c, s = cos(world_from_base.yaw), sin(world_from_base.yaw)
    pose, climbing = stance.pose(world_from_base), lateral * tan(stance.roll) - linear * tan(stance.pitch)
    return NavState(
        timestamp=stamp(t),
        position=pose.position,
        velocity=Vector3(x=linear * c - lateral * s, y=linear * s + lateral * c, z=climbing),
        orientation=pose.orientation,
        angular_velocity=Vector3(z=angular),
        position_sigma=position_sigma,
    )


def quality(t: float, position_sigma: float, drive: DriveFilter, satellites: tuple[bool, float]) -> EstimateQuality:
    """Quality of the estimate as a message stamped ``t`` [s]; position_sigma [m].

    satellites: (whether the position is measured, innovation ratio of the newest fix [-]).
    """
    return EstimateQuality(
        timestamp=stamp(t),
        position_known=satellites[0],
        position_sigma=position_sigma,
        yaw_sigma=sigma(drive.covariance[HEADING, HEADING]),
        position_ratio=satellites[1],
        slip_ratio=drive.slip_ratio,
    )


def slipping(t: float, cause: str) -> Event:
    """The event at ``t`` [s] that reports slipping wheels."""
    return Event(timestamp=stamp(t), severity=Event.WARNING, text="wheels slip: the odometry is less certain", cause=cause, source=SOURCE)


def calibrated(t: float, calibration: WheelCalibration, before: Scales, applied: bool) -> Event:
    """The event at ``t`` [s] that reports found wheel scales. before: the scales in force, which the found ones multiply."""
    found = Scales(*(a * b for a, b in zip(before, calibration.scales, strict=True)))
    sigmas = calibration.sigmas
    values = ", ".join(f"{n}_scale: {v:.4f}" for n, v in zip(Scales._fields, found, strict=True))
    verb = "in force now; to keep them" if applied else "to use them"
    text = f"wheels calibrated, {verb}: params: {{odometry: {{{values}}}}}"
    cause = f"{calibration.used} matched motions; 1 sigma {', '.join(f'{s:.4f}' for s in sigmas)}"
    return Event(timestamp=stamp(t), severity=Event.INFO, text=text, cause=cause, source=SOURCE)
