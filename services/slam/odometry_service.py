"""Wheels, gyroscope and the map's correction -> odometry, pose and motion of a ground vehicle, 50 times a second."""

from math import isfinite
from typing import Annotated

import numpy as np
from msgspec import Meta
from numpy.typing import NDArray

from schemas import topics
from schemas.convert import planar_pose, quaternion, seconds, stamp, yaw_of
from schemas.messages import FrameTransform, Imu, KeyValuePair, NavState, Odometry, PoseInFrame, Vector3, WheelTicks
from services.slam.odometry_filter import Noise, OdometryFilter
from uvf.maths.kinematics import Twist, move
from uvf.maths.planar import IDENTITY, Pose2, compose
from uvf.maths.rotations import from_euler, matrix
from uvf.runtime.service import Outputs, Params, Service, every, optional
from uvf.runtime.vehicle_file import VehicleFile

Floats = NDArray[np.float64]
Positive = Annotated[float, Meta(gt=0)]

MAX_PREDICTION = 0.1  # s, wheel data older than this is not extrapolated further
MAX_GAP = 0.1  # s between two wheel messages above which the gyroscope's samples do not cover the interval
JUMP = 10.0  # times the vehicle's greatest speed: what the wheels never turn

LEFT, RIGHT, BIAS = "left_ticks", "right_ticks", "gyro_bias"
"""What the odometry carries beside the pose, for an instance that is to go on after it."""


class OdometryParams(Params, frozen=True):
    distance_noise: Positive = 0.02  # m per square root of m driven
    gyro_noise: Positive = 0.005  # rad/s
    bias_walk: Positive = 1e-4  # rad/s per square root of s
    bias_start: Positive = 0.05  # rad/s
    slip_noise: Positive = 1.0  # rad/s, turn rate told by the wheels
    rest_noise: Positive = 0.01  # rad/s, the same while they stand still
    map_sigma: Positive = 0.02  # m, of a pose just corrected by the map


class OdometryService(Service):
    """One filter per vehicle. The pose is the odometry seen through the newest ``map_from_odom``."""

    name = "odometry"
    hz = 50.0
    inputs = {"wheels": topics.WHEELS, "imu": optional(every(topics.IMU)), "correction": optional(topics.TF_MAP)}
    outputs = {"odometry": topics.ODOMETRY, "moving": topics.TF_ODOM, "pose": topics.POSE, "nav_state": topics.NAV_STATE}
    recalls = {"odometry": topics.ODOMETRY, "correction": topics.TF_MAP}
    params: OdometryParams
    fixed_params = frozenset({"bias_start"})

    def __init__(self, vehicle: str, file: VehicleFile, world_from_map: Pose2, params: OdometryParams) -> None:
        if file.ground is None:
            raise ValueError(f"{vehicle} is not a ground vehicle")
        self.params = params
        self._vehicle = vehicle
        self._radius, self._track, self._fastest = file.ground.wheel_radius, file.ground.track, file.ground.max_linear
        mount = file.sensors.imu.mount.rpy if file.sensors.imu else (0.0, 0.0, 0.0)
        self._up_from_imu: Floats = matrix(from_euler(*mount))[2]
        self._world_from_map = world_from_map
        self._map_from_odom: Pose2 = IDENTITY
        self._filter = OdometryFilter(_noise(params))
        self._last: WheelTicks | None = None
        self._waiting: list[Imu] = []
        self._variance_at_correction = 0.0

    def step(self, t: float, wheels: WheelTicks, imu: list[Imu], correction: FrameTransform | None) -> Outputs:
        self._filter.noise = _noise(self.params)
        self._move(wheels, imu)
        if correction is not None:
            self._correct(correction)
        ahead = min(t - seconds(wheels.timestamp), MAX_PREDICTION)
        odom_from_base = move(self._filter.pose, Twist(*self._filter.speeds), ahead)
        world_from_base = compose(self._world_from_map, compose(self._map_from_odom, odom_from_base))
        return {
            "odometry": self._odometry(t, odom_from_base),
            "moving": self._moving(t, odom_from_base),
            "pose": PoseInFrame(timestamp=stamp(t), frame_id="world", pose=planar_pose(*world_from_base)),
            "nav_state": self._nav_state(t, world_from_base),
        }

    def recall(self, odometry: Odometry | None = None, correction: FrameTransform | None = None) -> None:
        """Goes on at the last pose told; what was driven since then is in the ticks counted since then."""
        if odometry is not None:
            self._resume(odometry)
        if correction is not None:
            self._correct(correction)

    def _resume(self, odometry: Odometry) -> None:
        """Nothing from a message that somebody else has left: it lacks the ticks."""
        known = {pair.key: pair.value for pair in odometry.metadata}
        try:
            bias, left, right = float(known[BIAS]), int(known[LEFT]), int(known[RIGHT])
        except (KeyError, ValueError):
            return
        position = odometry.pose.position
        self._filter.resume(Pose2(position.x, position.y, yaw_of(odometry.pose.orientation)), bias if isfinite(bias) else 0.0)
        self._last = WheelTicks(timestamp=odometry.timestamp, left=left, right=right)

    def _move(self, wheels: WheelTicks, imu: list[Imu]) -> None:
        """Counters that jump, because they began anew or are broken, move nothing."""
        self._waiting += imu
        last, self._last = self._last, wheels
        now = seconds(wheels.timestamp)
        dt = now - seconds(last.timestamp) if last else 0.0
        if last is None or dt <= 0.0 or not 0.0 < wheels.radians_per_tick <= 2 * np.pi:
            return
        left = (wheels.left - last.left) * wheels.radians_per_tick * self._radius
        right = (wheels.right - last.right) * wheels.radians_per_tick * self._radius
        gyro = self._turn_rate_until(now)
        if max(abs(left), abs(right)) > JUMP * self._fastest * dt + wheels.radians_per_tick * self._radius:
            return
        self._filter.step((left + right) / 2, (right - left) / self._track, gyro if dt <= MAX_GAP else None, dt)

    def _turn_rate_until(self, now: float) -> float | None:
        """Mean of the gyroscope about the vehicle's upward axis [rad/s] over the interval that the wheels tell of."""
        due = [m.angular_velocity for m in self._waiting if seconds(m.timestamp) <= now]
        self._waiting = self._waiting[len(due) :]
        if not due:
            return None
        x, y, z = self._up_from_imu
        return float(sum(x * w.x + y * w.y + z * w.z for w in due) / len(due))

    def _correct(self, correction: FrameTransform) -> None:
        shift = correction.translation
        newest = Pose2(shift.x, shift.y, yaw_of(correction.rotation))
        if newest != self._map_from_odom:
            self._variance_at_correction = self._variance
            self._map_from_odom = newest

    @property
    def _variance(self) -> float:
        """Of the odometry's position, the larger axis [m^2]."""
        covariance = self._filter.covariance
        return float(max(covariance[0, 0], covariance[1, 1]))

    def _odometry(self, t: float, odom_from_base: Pose2) -> Odometry:
        linear, angular = self._filter.speeds
        covariance = np.zeros((6, 6))
        planar = np.ix_((0, 1, 5), (0, 1, 5))
        covariance[planar] = self._filter.covariance[:3, :3]
        ticks = self._last or WheelTicks()
        left_over = {LEFT: str(ticks.left), RIGHT: str(ticks.right), BIAS: repr(self._filter.bias)}
        return Odometry(
            timestamp=stamp(t),
            frame_id=f"{self._vehicle}/odom",
            body_frame_id=f"{self._vehicle}/base_footprint",
            pose=planar_pose(*odom_from_base),
            linear_velocity=Vector3(x=linear),
            angular_velocity=Vector3(z=angular),
            pose_covariance=covariance.ravel().tolist(),
            metadata=[KeyValuePair(key=k, value=v) for k, v in left_over.items()],
        )

    def _moving(self, t: float, odom_from_base: Pose2) -> FrameTransform:
        x, y, heading = odom_from_base
        return FrameTransform(
            timestamp=stamp(t),
            parent_frame_id=f"{self._vehicle}/odom",
            child_frame_id=f"{self._vehicle}/base_footprint",
            translation=Vector3(x=x, y=y),
            rotation=quaternion(from_euler(0.0, 0.0, heading)),
        )

    def _nav_state(self, t: float, world_from_base: Pose2) -> NavState:
        linear, angular = self._filter.speeds
        x, y, heading = world_from_base
        grown = max(self._variance - self._variance_at_correction, 0.0)
        return NavState(
            timestamp=stamp(t),
            position=Vector3(x=x, y=y),
            velocity=Vector3(x=linear * np.cos(heading), y=linear * np.sin(heading)),
            orientation=quaternion(from_euler(0.0, 0.0, heading)),
            angular_velocity=Vector3(z=angular),
            position_sigma=float(np.sqrt(self.params.map_sigma**2 + grown)),
        )


def _noise(p: OdometryParams) -> Noise:
    return Noise(p.distance_noise, p.gyro_noise, p.bias_walk, p.bias_start, p.slip_noise, p.rest_noise)
