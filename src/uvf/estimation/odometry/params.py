"""The odometry's parameters."""

from typing import Annotated, Literal

from msgspec import Meta

from uvf.estimation.odometry.calibration import Scales
from uvf.estimation.odometry.states import Noise
from uvf.models.params import Params

Positive = Annotated[float, Meta(gt=0)]
Part = Annotated[float, Meta(gt=0, le=0.3)]
Scale = Annotated[float, Meta(ge=0.7, le=1.4)]


class OdometryParams(Params, frozen=True):
    filter: Annotated[Literal["ekf", "ukf"], Meta(description="extended (derivatives) or unscented (sigma points)")] = "ekf"
    distance_noise: Positive = 0.005  # m per square root of m that a wheel rolls
    skid_noise: Part = 0.05  # of a turn, by which the wheels may tell it wrong
    turn_noise: Positive = 0.003  # rad per square root of rad turned
    gyro_noise: Positive = 3e-4  # rad per square root of s
    bias_walk: Positive = 3e-5  # rad/s per square root of s
    bias_start: Positive = 0.05  # rad/s
    rest_noise: Positive = 0.001  # rad/s, of the gyroscope beside its noise while standing
    accel_noise: Positive = 0.01  # m/s per square root of s
    offset_walk: Positive = 0.005  # m/s^2 per square root of s: slopes that the gyroscope does not feel
    scale_start: Part = 0.01  # of each wheel's radius
    left_scale: Scale = 1.0  # true radius of the left wheel over the vehicle file's
    right_scale: Scale = 1.0
    track_scale: Scale = 1.0
    calibrate: Annotated[Literal["apply", "tell", "off"], Meta(description="what becomes of scales that scans have made certain")] = "tell"
    map_sigma: Positive = 0.02  # m, of a pose just corrected by the map
    map_drift: Positive = 0.01  # m per square root of m driven, of the map beside satellites
    position_start: Positive = 0.1  # m, 1 sigma of the start's position beside satellites
    heading_start: Positive = 0.1  # rad, 1 sigma of the start's heading beside satellites
    correction_speed: Positive = 0.2  # m/s, how fast the pose told follows what satellites correct

    @property
    def scales(self) -> Scales:
        return Scales(self.left_scale, self.right_scale, self.track_scale)

    def noise(self, resolution: float) -> Noise:
        """resolution: m, way of a wheel from one tick to the next."""
        return Noise(
            distance=self.distance_noise,
            resolution=resolution,
            skid=self.skid_noise,
            turn=self.turn_noise,
            gyro=self.gyro_noise,
            bias_walk=self.bias_walk,
            bias_start=self.bias_start,
            accel=self.accel_noise,
            offset_walk=self.offset_walk,
            scale_start=self.scale_start,
            rest=self.rest_noise,
        )
