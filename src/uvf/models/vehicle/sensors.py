"""``sensors:`` of a vehicle.yaml: what a vehicle carries, where, and how it errs, as data."""

import math
from collections.abc import Sequence
from typing import Annotated

import msgspec
from msgspec import Meta

from uvf.models.quantities import Name, NotNegative, Positive
from uvf.models.yaml_data import BadInput, FileLocation

Offset = Annotated[float, Meta(ge=-100, le=100)]
Triple = tuple[Offset, Offset, Offset]
SensorRate = Annotated[float, Meta(ge=0.01, le=1000)]
Probability = Annotated[float, Meta(ge=0, le=1)]
Bearing = Annotated[float, Meta(ge=-7, le=7)]


class Mount(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Pose of a sensor in base_link (FLU). Where a file names a URDF's ``link`` instead, it is that link's."""

    xyz: Triple = (0.0, 0.0, 0.0)  # m
    rpy: Triple = (0.0, 0.0, 0.0)  # rad
    link: Name | None = None


class Delivery(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """How a sensor's readings come to their readers: late, and some not at all. Their stamp is the moment they are valid for."""

    latency: Annotated[float, Meta(ge=0, le=10)] = 0.0  # s
    dropout: Probability = 0.0  # that a reading is lost and a burst of losses begins
    burst: Annotated[int, Meta(ge=1, le=1_000_000)] = 1  # readings lost in a row


class Lidar(Delivery, frozen=True, forbid_unknown_fields=True):
    """A 2-D scanner; ``range`` outside the limits is sent as 0 = no return. ``preset``: lds01, utm30lx or ust10.

    The stamp of a scan is that of the beam that is measured first.
    """

    mount: Mount
    hz: SensorRate
    beams: Annotated[int, Meta(ge=1, le=4096)]
    angle_min: Annotated[float, Meta(ge=-7, le=7)]  # rad
    angle_increment: Positive  # rad, counter-clockwise
    range_min: NotNegative  # m
    range_max: Positive  # m
    noise: NotNegative = 0.0  # m, 1 sigma of each beam
    frame: Name = "lidar"
    bias: NotNegative = 0.0  # m, 1 sigma of the constant of all beams
    preset: str = ""
    sweep_time: Annotated[float, Meta(ge=0, le=1)] = 0.0  # s from the first beam to the last; 0: all are taken at once
    clockwise: bool = False  # the beam at angle_min is measured last


class ImuSensor(Delivery, frozen=True, forbid_unknown_fields=True):
    """Six axes and a magnetometer; ``preset``: book. Noise is 1 sigma per sample: a data sheet's density times the root of ``hz``."""

    mount: Mount
    hz: SensorRate
    gyro_noise: NotNegative = 0.0  # rad/s, 1 sigma per sample
    gyro_bias: NotNegative = 0.0  # rad/s, 1 sigma of the constant drawn from the seed
    accel_noise: NotNegative = 0.0  # m/s^2
    accel_bias: NotNegative = 0.0  # m/s^2
    mag_noise: NotNegative = 0.0  # T
    frame: Name = "imu"
    gyro_scale: NotNegative = 0.0  # 1 sigma of the scale factor's error
    gyro_instability: NotNegative = 0.0  # rad/s, 1 sigma of the bias that comes and goes within instability_time
    gyro_random_walk: NotNegative = 0.0  # rad/s/sqrt(s), growth of the bias that walks
    gyro_range: Positive = math.inf  # rad/s, saturation
    gyro_resolution: NotNegative = 0.0  # rad/s, step of quantisation
    accel_scale: NotNegative = 0.0
    accel_instability: NotNegative = 0.0  # m/s^2
    accel_random_walk: NotNegative = 0.0  # m/s^2/sqrt(s)
    accel_range: Positive = math.inf  # m/s^2
    accel_resolution: NotNegative = 0.0  # m/s^2
    instability_time: Positive = 100.0  # s
    mag_bias: NotNegative = 0.0  # T, 1 sigma
    mag_hz: SensorRate | None = None  # None = hz; the last field is repeated in the readings between
    preset: str = ""


class Encoders(Delivery, frozen=True, forbid_unknown_fields=True):
    hz: SensorRate
    ticks_per_turn: Annotated[int, Meta(ge=1, le=10_000_000)]


class GnssSensor(Delivery, frozen=True, forbid_unknown_fields=True):
    """A satellite receiver. ``preset``: book (drifts as in Beard & McLain, chapter 7) or good (does not)."""

    hz: SensorRate
    horizontal_noise: NotNegative = 0.0  # m, 1 sigma per axis
    vertical_noise: NotNegative = 0.0  # m
    speed_noise: NotNegative = 0.0  # m/s
    horizontal_drift: NotNegative = 0.0  # m, 1 sigma per axis of the slow part
    vertical_drift: NotNegative = 0.0  # m
    drift_time: Positive = 1100.0  # s
    preset: str = ""
    mount: Mount = Mount()  # of a ground vehicle; an aircraft's is at base_link

    @property
    def accuracy(self) -> tuple[float, float]:
        """m, 1 sigma of the whole error: horizontal per axis, vertical."""
        return math.hypot(self.horizontal_noise, self.horizontal_drift), math.hypot(self.vertical_noise, self.vertical_drift)


class Sonar(Delivery, frozen=True, forbid_unknown_fields=True):
    """A cone of sound: the range of the nearest thing in it; outside the limits it is sent as 0 = no return."""

    mount: Mount
    hz: SensorRate
    fov: Annotated[float, Meta(gt=0, lt=3.1)]  # rad
    range_min: NotNegative  # m
    range_max: Positive  # m
    noise: NotNegative = 0.0  # m, 1 sigma
    frame: Name = "sonar"


class RangeFinder(Delivery, frozen=True, forbid_unknown_fields=True):
    """A laser's single beam along its mount's x axis; outside the limits it is sent as 0 = no return. Look down: rpy [0, 1.5708, 0]."""

    mount: Mount
    hz: SensorRate
    range_min: NotNegative  # m
    range_max: Positive  # m
    noise: NotNegative = 0.0  # m, 1 sigma
    frame: Name = "rangefinder"


class Bumper(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A sector of the body's outline that feels touches."""

    name: Name
    angle_min: Bearing  # rad from base_link's x axis, counter-clockwise
    angle_max: Bearing  # rad

    def feels(self, bearing: float) -> bool:
        return (bearing - self.angle_min) % (2 * math.pi) <= self.angle_max - self.angle_min


class AirDataSensor(Delivery, frozen=True, forbid_unknown_fields=True):
    """Absolute and differential pressure; ``preset``: book."""

    hz: SensorRate
    static_noise: NotNegative = 0.0  # Pa
    differential_noise: NotNegative = 0.0  # Pa
    static_bias: NotNegative = 0.0  # Pa, 1 sigma
    differential_bias: NotNegative = 0.0  # Pa, 1 sigma
    preset: str = ""


class Camera(Delivery, frozen=True, forbid_unknown_fields=True):
    mount: Mount
    hz: SensorRate
    width: Annotated[int, Meta(ge=16, le=1920)]
    height: Annotated[int, Meta(ge=16, le=1080)]
    fov: Annotated[float, Meta(gt=0, lt=3.1)]  # rad, horizontal
    far: Positive = 100.0  # m
    frame: Name = "camera"
    depth: bool = False  # depth pictures too, of the same size and rate
    depth_noise: NotNegative = 0.0  # 1/m: 1 sigma is this times the square of the depth


class Chase(Camera, frozen=True, forbid_unknown_fields=True):
    """Behind and above its vehicle, which it sees."""

    frame: Name = "chase"


class Gimbal(Camera, frozen=True, forbid_unknown_fields=True):
    """A camera on three joints: pan about its mount's z axis, then roll, then tilt; it begins along its mount."""

    frame: Name = "gimbal"
    slew: Positive = 2.0  # rad/s, of each joint
    pan_max: Annotated[float, Meta(ge=0, le=3.1416)] = 3.1416  # rad, to both sides; half a turn or more: it goes round without a stop
    roll_max: Annotated[float, Meta(ge=0, le=1.5)] = 0.8  # rad, to both sides
    tilt_min: Annotated[float, Meta(ge=-1.5708, le=0)] = -0.5  # rad, down positive
    tilt_max: Annotated[float, Meta(ge=0, le=3.1416)] = 2.1  # rad; more than straight down, to stay there when the nose goes up


class Sensors(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What the vehicle carries; absent = not fitted."""

    lidar: Lidar | None = None
    imu: ImuSensor | None = None
    encoders: Encoders | None = None
    gnss: GnssSensor | None = None
    air_data: AirDataSensor | None = None
    camera: Camera | None = None
    chase: Chase | None = None
    gimbal: Gimbal | None = None
    sonars: list[Sonar] = []
    rangefinders: list[RangeFinder] = []
    bumpers: list[Bumper] = []


Sampled = Lidar | ImuSensor | Encoders | GnssSensor | AirDataSensor | Sonar | RangeFinder | Camera


def check_sensors(sensors: Sensors, place: FileLocation) -> None:
    """Raises BadInput for what cannot be meant."""
    _check_lidar(sensors.lidar, place.at("lidar"))
    _check_rangers("sonar", sensors.sonars, place.at("sonars"))
    _check_rangers("range finder", sensors.rangefinders, place.at("rangefinders"))
    _check_bumpers(sensors.bumpers, place.at("bumpers"))


def check_sensors_of_aircraft(sensors: Sensors, place: FileLocation) -> None:
    """What only ground vehicles have would be silent."""
    for kind in ("encoders", "bumpers"):
        if getattr(sensors, kind):
            raise BadInput(f"{place.at(kind)}: an aircraft has no {kind}; leave them out")
    if sensors.gnss is not None and sensors.gnss.mount != Mount():
        raise BadInput(f"{place.at('gnss', 'mount')}: an aircraft's receiver is at its centre of gravity; leave it out")
    if sensors.lidar is not None and sensors.lidar.sweep_time > 0.0:
        raise BadInput(f"{place.at('lidar', 'sweep_time')}: an aircraft's lidar takes all beams at once; leave it out")
    for kind in ("imu", "lidar", "camera", "chase", "gimbal"):
        sensor = getattr(sensors, kind)
        if sensor is not None and sensor.mount.link is not None:
            raise BadInput(f"{place.at(kind, 'mount', 'link')}: an aircraft's model has no links; give xyz and rpy")


def _check_lidar(lidar: Lidar | None, place: FileLocation) -> None:
    if lidar is None:
        return
    if lidar.range_min >= lidar.range_max:
        raise BadInput(f"{place.at('range_min')}: {lidar.range_min:g} m is not below range_max, {lidar.range_max:g} m")
    sweep = (lidar.beams - 1) * lidar.angle_increment
    if sweep > 2 * math.pi + 1e-6:
        raise BadInput(f"{place.at('angle_increment')}: {lidar.beams} beams make {sweep:.3g} rad, more than a full turn; lower it")
    if lidar.sweep_time * lidar.hz > 1.0 + 1e-9:
        period = 1 / lidar.hz
        raise BadInput(f"{place.at('sweep_time')}: {lidar.sweep_time:g} s is longer than from scan to scan, {period:g} s; lower it")


def _check_rangers(kind: str, sonars: Sequence[Sonar | RangeFinder], place: FileLocation) -> None:
    for i, sonar in enumerate(sonars):
        if sonar.range_min >= sonar.range_max:
            raise BadInput(f"{place.at(i, 'range_min')}: {sonar.range_min:g} m is not below range_max, {sonar.range_max:g} m")
        if sonar.frame in (other.frame for other in sonars[:i]):
            raise BadInput(f"{place.at(i)}: a second {kind} with frame '{sonar.frame}'; give each a frame of its own")


def _check_bumpers(bumpers: list[Bumper], place: FileLocation) -> None:
    for i, bumper in enumerate(bumpers):
        if bumper.angle_min >= bumper.angle_max:
            raise BadInput(f"{place.at(i, 'angle_min')}: {bumper.angle_min:g} rad is not below angle_max, {bumper.angle_max:g} rad")
