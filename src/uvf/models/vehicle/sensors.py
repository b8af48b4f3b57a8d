"""``sensors:`` of a vehicle.yaml: what a vehicle carries, where, and how it errs, as data."""

import math
from collections.abc import Sequence
from typing import Annotated

import msgspec
from msgspec import Meta

from uvf.models.keys import in_unit, key, plain
from uvf.models.quantities import Angles, Name, NotNegative, Positive
from uvf.models.yaml_data import BadInput, FileLocation

Offset = Annotated[float, Meta(ge=-100, le=100), in_unit("m")]
Triple = tuple[Offset, Offset, Offset]
SensorRate = Annotated[float, Meta(ge=0.01, le=1000)]
Probability = Annotated[float, Meta(ge=0, le=1)]
Bearing = Annotated[float, Meta(ge=-7, le=7)]


class Mount(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Pose of a sensor in base_link (FLU). Where a file names a URDF's ``link`` instead, it is that link's."""

    xyz: Annotated[Triple, plain("Position x forward, y left, z up [m], in base_link or in `link`.")] = (0.0, 0.0, 0.0)
    rpy: Annotated[Angles, plain("Roll, pitch, yaw [rad]; [0, 1.5708, 0] looks straight down.")] = (0.0, 0.0, 0.0)
    link: Annotated[Name | None, plain("Parent link of the mount, a link of the URDF; left out: base_link.")] = None


class Delivery(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """How a sensor's readings come to their readers: late, and some not at all. Their stamp is the moment they are valid for."""

    latency: Annotated[float, Meta(ge=0, le=10), key("s", "Time from the moment a reading is valid for until it is delivered.")] = 0.0
    dropout: Annotated[Probability, key("", "Probability that a reading is lost and a burst of losses begins.")] = 0.0
    burst: Annotated[int, Meta(ge=1, le=1_000_000), key("", "Readings lost in a row.")] = 1


class Lidar(Delivery, frozen=True, forbid_unknown_fields=True):
    """A 2-D scanner; ``range`` outside the limits is sent as 0 = no return. ``preset``: lds01, utm30lx or ust10.

    The stamp of a scan is that of the beam that is measured first.
    """

    mount: Annotated[Mount, plain("Where the sensor is.")]
    hz: Annotated[SensorRate, key("Hz", "Scans per second of simulation time.")]
    beams: Annotated[int, Meta(ge=1, le=4096), key("", "Beams of a scan.")]
    angle_min: Annotated[
        float, Meta(ge=-7, le=7), key("rad", "Direction of the first beam of the message, counter-clockwise from forward.")
    ]
    angle_increment: Annotated[Positive, key("rad", "Angle from beam to beam, counter-clockwise. 360 beams of a whole turn: 0.0174533.")]
    range_min: Annotated[NotNegative, key("m", "Ranges below this are sent as 0, no return.")]
    range_max: Annotated[Positive, key("m", "Ranges above this are sent as 0, no return.")]
    noise: Annotated[NotNegative, key("m", "1 sigma of each beam.")] = 0.0
    frame: Annotated[Name, plain("Name of the sensor's frame: `<vehicle>/<frame>`.")] = "lidar"
    bias: Annotated[NotNegative, key("m", "1 sigma of an offset that all beams share, drawn once per run.")] = 0.0
    preset: Annotated[str, plain("Values of a known instrument; keys given beside it count. See [presets](sensors.md#presets).")] = ""
    sweep_time: Annotated[
        float,
        Meta(ge=0, le=1),
        key("s", "Time from the first beam to the last; 0 takes all beams at once. At most 1/hz. Ground vehicles only."),
    ] = 0.0
    clockwise: Annotated[bool, plain("The scanner turns clockwise: the beam at `angle_min` is measured last.")] = False


class ImuSensor(Delivery, frozen=True, forbid_unknown_fields=True):
    """Six axes and a magnetometer; ``preset``: book. Noise is 1 sigma per sample: a data sheet's density times the root of ``hz``."""

    mount: Annotated[Mount, plain("Where the sensor is.")]
    hz: Annotated[SensorRate, key("Hz", "Readings per second of simulation time.")]
    gyro_noise: Annotated[NotNegative, key("rad/s", "1 sigma per sample: the density of a data sheet times the root of `hz`.")] = 0.0
    gyro_bias: Annotated[NotNegative, key("rad/s", "1 sigma of a constant drawn once per run.")] = 0.0
    accel_noise: Annotated[NotNegative, key("m/s^2", "1 sigma per sample.")] = 0.0
    accel_bias: Annotated[NotNegative, key("m/s^2", "1 sigma of a constant drawn once per run.")] = 0.0
    mag_noise: Annotated[NotNegative, key("T", "1 sigma per sample of the magnetometer.")] = 0.0
    frame: Annotated[Name, plain("Name of the sensor's frame: `<vehicle>/<frame>`.")] = "imu"
    gyro_scale: Annotated[NotNegative, key("", "1 sigma of the scale factor's error.")] = 0.0
    gyro_instability: Annotated[NotNegative, key("rad/s", "1 sigma of the bias that varies within `instability_time`.")] = 0.0
    gyro_random_walk: Annotated[NotNegative, key("rad/s/sqrt(s)", "Growth of the bias that walks.")] = 0.0
    gyro_range: Annotated[Positive, key("rad/s", "Largest rate; beyond it the reading saturates.")] = math.inf
    gyro_resolution: Annotated[NotNegative, key("rad/s", "Quantisation step.")] = 0.0
    accel_scale: Annotated[NotNegative, key("", "1 sigma of the scale factor's error.")] = 0.0
    accel_instability: Annotated[NotNegative, key("m/s^2", "1 sigma of the bias that varies within `instability_time`.")] = 0.0
    accel_random_walk: Annotated[NotNegative, key("m/s^2/sqrt(s)", "Growth of the bias that walks.")] = 0.0
    accel_range: Annotated[Positive, key("m/s^2", "Largest specific force; beyond it the reading saturates.")] = math.inf
    accel_resolution: Annotated[NotNegative, key("m/s^2", "Quantisation step.")] = 0.0
    instability_time: Annotated[Positive, key("s", "Correlation time of the bias instability.")] = 100.0
    mag_bias: Annotated[NotNegative, key("T", "1 sigma of a constant drawn once per run.")] = 0.0
    mag_hz: Annotated[
        SensorRate | None, key("Hz", "Readings per second of the magnetometer; the last one is repeated between. Left out: `hz`.")
    ] = None
    preset: Annotated[str, plain("Values of a known instrument; keys given beside it count. See [presets](sensors.md#presets).")] = ""


class Encoders(Delivery, frozen=True, forbid_unknown_fields=True):
    """Wheel encoders: ticks of each driven wheel."""

    hz: Annotated[SensorRate, key("Hz", "Readings per second of simulation time.")]
    ticks_per_turn: Annotated[int, Meta(ge=1, le=10_000_000), key("", "Ticks per turn of the wheel.")]


class GnssSensor(Delivery, frozen=True, forbid_unknown_fields=True):
    """A satellite receiver. ``preset``: book (drifts as in Beard & McLain, chapter 7) or good (does not)."""

    hz: Annotated[SensorRate, key("Hz", "Fixes per second of simulation time.")]
    horizontal_noise: Annotated[NotNegative, key("m", "1 sigma per axis.")] = 0.0
    vertical_noise: Annotated[NotNegative, key("m", "1 sigma.")] = 0.0
    speed_noise: Annotated[NotNegative, key("m/s", "1 sigma per axis.")] = 0.0
    horizontal_drift: Annotated[NotNegative, key("m", "1 sigma per axis of the slow error.")] = 0.0
    vertical_drift: Annotated[NotNegative, key("m", "1 sigma of the slow error.")] = 0.0
    drift_time: Annotated[Positive, key("s", "Correlation time of the slow error.")] = 1100.0
    preset: Annotated[str, plain("Values of a known instrument; keys given beside it count. See [presets](sensors.md#presets).")] = ""
    mount: Annotated[Mount, plain("Where the antenna is, on a ground vehicle; that of an aircraft is at base_link.")] = Mount()

    @property
    def accuracy(self) -> tuple[float, float]:
        """1 sigma [m] of the whole error of a fix: horizontal per axis, vertical."""
        return math.hypot(self.horizontal_noise, self.horizontal_drift), math.hypot(self.vertical_noise, self.vertical_drift)


class Sonar(Delivery, frozen=True, forbid_unknown_fields=True):
    """A cone of sound: the range of the nearest thing in it; outside the limits it is sent as 0 = no return."""

    mount: Annotated[Mount, plain("Where the sensor is.")]
    hz: Annotated[SensorRate, key("Hz", "Readings per second of simulation time.")]
    fov: Annotated[float, Meta(gt=0, lt=3.1), key("rad", "Opening angle of the cone.")]
    range_min: Annotated[NotNegative, key("m", "Ranges below this are sent as 0, no return.")]
    range_max: Annotated[Positive, key("m", "Ranges above this are sent as 0, no return.")]
    noise: Annotated[NotNegative, key("m", "1 sigma.")] = 0.0
    frame: Annotated[Name, plain("Name of the sensor's frame: `<vehicle>/<frame>`.")] = "sonar"


class RangeFinder(Delivery, frozen=True, forbid_unknown_fields=True):
    """A laser's single beam along its mount's x axis; outside the limits it is sent as 0 = no return. Look down: rpy [0, 1.5708, 0]."""

    mount: Annotated[Mount, plain("Where it is; the beam runs along the mount's x axis.")]
    hz: Annotated[SensorRate, key("Hz", "Readings per second of simulation time.")]
    range_min: Annotated[NotNegative, key("m", "Ranges below this are sent as 0, no return.")]
    range_max: Annotated[Positive, key("m", "Ranges above this are sent as 0, no return.")]
    noise: Annotated[NotNegative, key("m", "1 sigma.")] = 0.0
    frame: Annotated[Name, plain("Name of the sensor's frame: `<vehicle>/<frame>`.")] = "rangefinder"


class Bumper(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A sector of the body's outline that feels touches."""

    name: Annotated[Name, plain("Name that contact messages use.")]
    angle_min: Annotated[Bearing, key("rad", "Right end of the sector, counter-clockwise from forward.")]
    angle_max: Annotated[Bearing, key("rad", "Left end of the sector.")]

    def feels(self, bearing: float) -> bool:
        """Whether a touch at ``bearing`` [rad], counter-clockwise from forward, lies in the sector."""
        return (bearing - self.angle_min) % (2 * math.pi) <= self.angle_max - self.angle_min


class AirDataSensor(Delivery, frozen=True, forbid_unknown_fields=True):
    """Absolute and differential pressure; ``preset``: book."""

    hz: Annotated[SensorRate, key("Hz", "Readings per second of simulation time.")]
    static_noise: Annotated[NotNegative, key("Pa", "1 sigma of the static pressure.")] = 0.0
    differential_noise: Annotated[NotNegative, key("Pa", "1 sigma of the pitot pressure.")] = 0.0
    static_bias: Annotated[NotNegative, key("Pa", "1 sigma of a constant drawn once per run.")] = 0.0
    differential_bias: Annotated[NotNegative, key("Pa", "1 sigma of a constant drawn once per run.")] = 0.0
    preset: Annotated[str, plain("Values of a known instrument; keys given beside it count. See [presets](sensors.md#presets).")] = ""


class Camera(Delivery, frozen=True, forbid_unknown_fields=True):
    """A pin-hole camera; it looks along its mount's x axis."""

    mount: Annotated[Mount, plain("Where the camera is; it looks along the mount's x axis.")]
    hz: Annotated[SensorRate, key("Hz", "Pictures per second of simulation time.")]
    width: Annotated[int, Meta(ge=16, le=1920), key("px", "Width of the picture.")]
    height: Annotated[int, Meta(ge=16, le=1080), key("px", "Height of the picture.")]
    fov: Annotated[float, Meta(gt=0, lt=3.1), key("rad", "Horizontal field of view.")]
    far: Annotated[Positive, key("m", "Things farther away are not drawn.")] = 100.0
    frame: Annotated[Name, plain("Name of the sensor's frame: `<vehicle>/<frame>`.")] = "camera"
    depth: Annotated[bool, plain("Depth pictures of the same size and rate are sent too.")] = False
    depth_noise: Annotated[NotNegative, key("1/m", "1 sigma of a depth is this times the square of the depth.")] = 0.0


class Chase(Camera, frozen=True, forbid_unknown_fields=True):
    """Behind and above its vehicle, which it sees."""

    frame: Annotated[Name, plain("Name of the sensor's frame: `<vehicle>/<frame>`.")] = "chase"


class Gimbal(Camera, frozen=True, forbid_unknown_fields=True):
    """A camera on three joints: pan about its mount's z axis, then roll, then tilt; it begins along its mount."""

    frame: Annotated[Name, plain("Name of the sensor's frame: `<vehicle>/<frame>`.")] = "gimbal"
    slew: Annotated[Positive, key("rad/s", "Largest rate of each joint.")] = 2.0
    pan_max: Annotated[
        float, Meta(ge=0, le=3.1416), key("rad", "Largest pan to each side; from half a turn on it turns without a stop.")
    ] = 3.1416
    roll_max: Annotated[float, Meta(ge=0, le=1.5), key("rad", "Largest roll to each side.")] = 0.8
    tilt_min: Annotated[float, Meta(ge=-1.5708, le=0), key("rad", "Smallest tilt; down is positive.")] = -0.5
    tilt_max: Annotated[
        float, Meta(ge=0, le=3.1416), key("rad", "Largest tilt; more than straight down keeps the view when the nose rises.")
    ] = 2.1


class Sensors(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What the vehicle carries; absent = not fitted."""

    lidar: Annotated[Lidar | None, plain("2-D laser scanner; the one by whose scans SLAM places the vehicle.")] = None
    other_lidars: Annotated[list[Lidar], plain("Further 2-D laser scanners, for what the first one does not see.")] = []
    imu: Annotated[ImuSensor | None, plain("Gyroscopes, accelerometers and magnetometer.")] = None
    encoders: Annotated[Encoders | None, plain("Wheel encoders.")] = None
    gnss: Annotated[GnssSensor | None, plain("Satellite receiver.")] = None
    air_data: Annotated[AirDataSensor | None, plain("Static and pitot pressure.")] = None
    camera: Annotated[Camera | None, plain("Camera of the vehicle.")] = None
    chase: Annotated[Chase | None, plain("Camera behind the vehicle that shows the vehicle itself.")] = None
    gimbal: Annotated[Gimbal | None, plain("Camera on pan, roll and tilt joints.")] = None
    sonars: Annotated[list[Sonar], plain("Ultrasonic range sensors.")] = []
    rangefinders: Annotated[list[RangeFinder], plain("Single-beam lasers.")] = []
    bumpers: Annotated[list[Bumper], plain("Contact sensors.")] = []

    @property
    def lidars(self) -> list[Lidar]:
        """All 2-D laser scanners, the first one first."""
        return [*([self.lidar] if self.lidar is not None else []), *self.other_lidars]


Sampled = Lidar | ImuSensor | Encoders | GnssSensor | AirDataSensor | Sonar | RangeFinder | Camera


def check_sensors(sensors: Sensors, place: FileLocation) -> None:
    """Checks what the types of the ``sensors`` section do not say. Raises BadInput."""
    if sensors.lidar is not None:
        _check_lidar(sensors.lidar, place.at("lidar"))
    elif sensors.other_lidars:
        raise BadInput(f"{place.at('other_lidars')}: there is no first one; give one of them as 'lidar'")
    for i, lidar in enumerate(sensors.other_lidars):
        _check_lidar(lidar, place.at("other_lidars", i))
        if lidar.frame in (other.frame for other in sensors.lidars[: i + 1]):
            raise BadInput(f"{place.at('other_lidars', i)}: a second lidar with frame '{lidar.frame}'; give each a frame of its own")
    _check_rangers("sonar", sensors.sonars, place.at("sonars"))
    _check_rangers("range finder", sensors.rangefinders, place.at("rangefinders"))
    _check_bumpers(sensors.bumpers, place.at("bumpers"))


def check_sensors_of_aircraft(sensors: Sensors, place: FileLocation) -> None:
    """Checks that an aircraft has no sensors that only work on ground vehicles. Raises BadInput."""
    for kind in ("encoders", "bumpers", "other_lidars"):
        if getattr(sensors, kind):
            raise BadInput(f"{place.at(kind)}: an aircraft has no {kind.replace('_', ' ')}; leave them out")
    if sensors.gnss is not None and sensors.gnss.mount != Mount():
        raise BadInput(f"{place.at('gnss', 'mount')}: an aircraft's receiver is at its centre of gravity; leave it out")
    if sensors.lidar is not None and sensors.lidar.sweep_time > 0.0:
        raise BadInput(f"{place.at('lidar', 'sweep_time')}: an aircraft's lidar takes all beams at once; leave it out")
    for kind in ("imu", "lidar", "camera", "chase", "gimbal"):
        sensor = getattr(sensors, kind)
        if sensor is not None and sensor.mount.link is not None:
            raise BadInput(f"{place.at(kind, 'mount', 'link')}: an aircraft's model has no links; give xyz and rpy")


def _check_lidar(lidar: Lidar, place: FileLocation) -> None:
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
