"""The odometry's parameters."""

from typing import Annotated, Literal

from msgspec import Meta

from uvf.estimation.odometry.calibration import Scales
from uvf.estimation.odometry.states import Noise
from uvf.models.keys import key
from uvf.models.params import Params

Positive = Annotated[float, Meta(gt=0)]
Part = Annotated[float, Meta(gt=0, le=0.3)]
Scale = Annotated[float, Meta(ge=0.7, le=1.4)]


class OdometryParams(Params, frozen=True):
    """Parameters of the wheel odometry: noise, wheel calibration, and how the pose follows map and satellites."""

    filter: Annotated[Literal["ekf", "ukf"], Meta(description="extended (derivatives) or unscented (sigma points)")] = "ekf"
    distance_noise: Annotated[Positive, key("m/sqrt(m)", "1 sigma of the distance that a wheel rolls.")] = 0.005
    skid_noise: Annotated[Part, key("", "Relative error of wheel-derived rotation.")] = 0.05
    turn_noise: Annotated[Positive, key("rad/sqrt(rad)", "1 sigma of the heading by turning.")] = 0.003
    gyro_noise: Annotated[Positive, key("rad/sqrt(s)", "1 sigma of the heading by time.")] = 3e-4
    bias_walk: Annotated[Positive, key("rad/s/sqrt(s)", "Growth of the gyroscope's bias.")] = 3e-5
    bias_start: Annotated[Positive, key("rad/s", "1 sigma of the gyroscope's bias at the start.")] = 0.05
    rest_noise: Annotated[Positive, key("rad/s", "1 sigma of the gyroscope beside its noise while the vehicle stands.")] = 0.001
    accel_noise: Annotated[Positive, key("m/s/sqrt(s)", "1 sigma of the speed by the accelerometer.")] = 0.01
    offset_walk: Annotated[
        Positive, key("m/s^2/sqrt(s)", "Growth of the accelerometer's offset: slopes that the gyroscope does not feel.")
    ] = 0.005
    scale_start: Annotated[Part, key("", "1 sigma of each wheel's radius at the start, relative.")] = 0.01
    left_scale: Annotated[Scale, key("", "True radius of the left wheel over that of the vehicle file.")] = 1.0
    right_scale: Annotated[Scale, key("", "True radius of the right wheel over that of the vehicle file.")] = 1.0
    track_scale: Annotated[Scale, key("", "True track over that of the vehicle file.")] = 1.0
    calibrate: Annotated[Literal["apply", "tell", "off"], Meta(description="what becomes of scales that scans have made certain")] = "tell"
    map_sigma: Annotated[Positive, key("m", "1 sigma of a pose just corrected by the map.")] = 0.02
    map_drift: Annotated[Positive, key("m/sqrt(m)", "Growth of the map's error with the distance driven, with a satellite receiver.")] = (
        0.01
    )
    position_start: Annotated[Positive, key("m", "1 sigma of the start's position, with a satellite receiver.")] = 0.1
    heading_start: Annotated[Positive, key("rad", "1 sigma of the start's heading, with a satellite receiver.")] = 0.1
    correction_speed: Annotated[Positive, key("m/s", "Speed at which the published pose follows what satellites correct.")] = 0.2

    @property
    def scales(self) -> Scales:
        """The scales of wheel radii and track as given."""
        return Scales(self.left_scale, self.right_scale, self.track_scale)

    def noise(self, resolution: float) -> Noise:
        """Noise model for wheels with ``resolution`` [m], the distance rolled from one encoder tick to the next."""
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
