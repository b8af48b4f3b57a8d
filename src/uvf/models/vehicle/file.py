"""``vehicles/<name>/vehicle.yaml``: what a vehicle is, as data."""

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec
import numpy as np
from msgspec import Meta

from uvf.maths.geodesy import LocalTangent
from uvf.models.quantities import Name, NotNegative, PhysicsRate, Positive
from uvf.models.vehicle.air import AirBody, BatteryPack, check_air, check_battery
from uvf.models.vehicle.layers import file_of, fill_vehicle, folders_of
from uvf.models.yaml_data import BadInput, Place, load_yaml, nearest
from uvf.sensors.errors import Errors
from uvf.sensors.instruments import InertialUnit, Receiver
from uvf.sensors.sampling import Dropout, Line
from uvf.sensors.sweeping import Sweeping

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

    @property
    def sweeping(self) -> Sweeping:
        return Sweeping(self.sweep_time, self.clockwise)


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

    @property
    def gyro(self) -> Errors:
        """rad/s."""
        return Errors(
            noise=self.gyro_noise,
            bias=self.gyro_bias,
            scale=self.gyro_scale,
            drift=self.gyro_instability,
            drift_time=self.instability_time,
            random_walk=self.gyro_random_walk,
            limit=self.gyro_range,
            resolution=self.gyro_resolution,
        )

    @property
    def accel(self) -> Errors:
        """m/s^2."""
        return Errors(
            noise=self.accel_noise,
            bias=self.accel_bias,
            scale=self.accel_scale,
            drift=self.accel_instability,
            drift_time=self.instability_time,
            random_walk=self.accel_random_walk,
            limit=self.accel_range,
            resolution=self.accel_resolution,
        )

    @property
    def mag(self) -> Errors:
        """T."""
        return Errors(noise=self.mag_noise, bias=self.mag_bias)

    def unit(self, rng: np.random.Generator) -> InertialUnit:
        return InertialUnit(self.gyro, self.accel, self.mag, self.mag_hz or self.hz, rng)


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
    def position(self) -> Errors:
        """m, ENU."""
        noise = np.array((self.horizontal_noise, self.horizontal_noise, self.vertical_noise))
        drift = np.array((self.horizontal_drift, self.horizontal_drift, self.vertical_drift))
        return Errors(noise=noise, drift=drift, drift_time=self.drift_time)

    @property
    def accuracy(self) -> tuple[float, float]:
        """m, 1 sigma of the whole error: horizontal per axis, vertical."""
        return math.hypot(self.horizontal_noise, self.horizontal_drift), math.hypot(self.vertical_noise, self.vertical_drift)

    def receiver(self, tangent: LocalTangent, rng: np.random.Generator) -> Receiver:
        return Receiver(self.position, Errors(noise=self.speed_noise), tangent, rng)


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


def line_of(sensor: Sampled, rng: np.random.Generator) -> Line[Any]:
    """The way of a sensor's readings to their readers."""
    return Line(sensor.hz, sensor.latency, Dropout(sensor.dropout, sensor.burst, rng) if sensor.dropout else None)


class Motor(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A wheel's motor with its gear, at the wheel; a first-order lag lies between the command and what it holds."""

    stall_torque: Positive  # N m
    no_load_speed: Positive  # rad/s
    lag: NotNegative = 0.0  # s


class Friction(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Coulomb coefficients on the ground: of the wheels along their rolling and across it, and of the links that only slide."""

    mu: Positive = 1.0
    mu2: Positive = 1.0
    castor: NotNegative = 0.02


class GroundBody(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A differential-drive vehicle: URDF joint names, kinematics and limits."""

    urdf: Name
    left_joint: Name
    right_joint: Name
    wheel_radius: Positive  # m
    track: Positive  # m, between the wheels' contact points
    radius: Positive  # m, circle about base_link that holds the whole body
    max_linear: Positive  # m/s
    max_angular: Positive  # rad/s
    max_linear_acceleration: Positive  # m/s^2
    max_angular_acceleration: Positive  # rad/s^2
    motor: Motor
    friction: Friction = Friction()
    battery: BatteryPack | None = None
    physics_hz: PhysicsRate = 200.0


class VehicleFile(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The whole of vehicle.yaml. ``params``: service name -> that service's parameters.

    variant_of: another vehicle, whose file holds what this one does not say.
    """

    kind: Literal["ground", "fixed_wing"]
    about: str
    sensors: Sensors
    ground: GroundBody | None = None
    air: AirBody | None = None
    params: dict[str, dict[str, Any]] = {}
    variant_of: Name | None = None


def load_vehicle(vehicles: Path, name: str) -> VehicleFile:
    """Reads ``vehicles/<name>/vehicle.yaml``. Raises BadInput."""
    folder = vehicles / name
    if not (folder / "vehicle.yaml").is_file():
        known = [p.parent.name for p in vehicles.glob("*/vehicle.yaml")]
        raise BadInput(f"no vehicle '{name}' in {vehicles}; {nearest(name, known)}")
    vehicle = load_yaml(folder / "vehicle.yaml", VehicleFile, fill_vehicle)
    place = Place(str(folder / "vehicle.yaml"))
    section = "ground" if vehicle.kind == "ground" else "air"
    if getattr(vehicle, section) is None:
        raise BadInput(f"{place.at('kind')}: kind is '{vehicle.kind}' but there is no '{section}:' section")
    _check_lidar(vehicle.sensors.lidar, place.at("sensors", "lidar"))
    _check_rangers("sonar", vehicle.sensors.sonars, place.at("sensors", "sonars"))
    _check_rangers("range finder", vehicle.sensors.rangefinders, place.at("sensors", "rangefinders"))
    _check_bumpers(vehicle.sensors.bumpers, place.at("sensors", "bumpers"))
    ground, air = vehicle.ground, vehicle.air
    if ground is not None and ground.left_joint == ground.right_joint:
        raise BadInput(f"{place.at('ground', 'right_joint')}: the left wheel's joint too; name the right one")
    if ground is not None and ground.battery is not None:
        _check_ground_battery(ground.battery, place.at("ground", "battery"))
    if air is not None:
        check_air(air, place.at("air"))
        _check_sensors_of_aircraft(vehicle.sensors, place.at("sensors"))
    return vehicle if vehicle.variant_of is None else _with_files(vehicle, folders_of(folder))


def _check_ground_battery(pack: BatteryPack, place: Place) -> None:
    """What the wheels' motors draw follows from their torque and speed."""
    check_battery(pack, place)
    for name in ("power", "rated"):
        if getattr(pack, name) is not None:
            raise BadInput(f"{place.at(name)}: is for an aircraft; leave it out, the motors' own figures say it")


def _with_files(vehicle: VehicleFile, folders: list[Path]) -> VehicleFile:
    """A variant's files where they are: beside it or in the folder of the vehicle it is a variant of."""
    ground, air = vehicle.ground, vehicle.air
    if ground is not None:
        ground = msgspec.structs.replace(ground, urdf=file_of(folders, ground.urdf))
    if air is not None and air.mesh is not None:
        air = msgspec.structs.replace(air, mesh=file_of(folders, air.mesh))
    return msgspec.structs.replace(vehicle, ground=ground, air=air)


def _check_sensors_of_aircraft(sensors: Sensors, place: Place) -> None:
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


def _check_lidar(lidar: Lidar | None, place: Place) -> None:
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


def _check_rangers(kind: str, sonars: Sequence[Sonar | RangeFinder], place: Place) -> None:
    for i, sonar in enumerate(sonars):
        if sonar.range_min >= sonar.range_max:
            raise BadInput(f"{place.at(i, 'range_min')}: {sonar.range_min:g} m is not below range_max, {sonar.range_max:g} m")
        if sonar.frame in (other.frame for other in sonars[:i]):
            raise BadInput(f"{place.at(i)}: a second {kind} with frame '{sonar.frame}'; give each a frame of its own")


def _check_bumpers(bumpers: list[Bumper], place: Place) -> None:
    for i, bumper in enumerate(bumpers):
        if bumper.angle_min >= bumper.angle_max:
            raise BadInput(f"{place.at(i, 'angle_min')}: {bumper.angle_min:g} rad is not below angle_max, {bumper.angle_max:g} rad")
