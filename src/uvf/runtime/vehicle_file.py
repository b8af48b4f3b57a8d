"""``vehicles/<name>/vehicle.yaml``: what a vehicle is, as data."""

import math
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec
from msgspec import Meta

from uvf.runtime.params import BadInput, Place, load_yaml, nearest

Positive = Annotated[float, Meta(ge=1e-9, le=1e9)]
NotNegative = Annotated[float, Meta(ge=0, le=1e9)]
Offset = Annotated[float, Meta(ge=-100, le=100)]
Triple = tuple[Offset, Offset, Offset]
SensorRate = Annotated[float, Meta(ge=0.01, le=1000)]
Deflection = Annotated[float, Meta(ge=0.01, le=1.6)]
PhysicsRate = Annotated[float, Meta(ge=20, le=5000)]
Name = Annotated[str, Meta(pattern=r"^[A-Za-z0-9_][A-Za-z0-9_./-]*$", max_length=80)]  # of a file, frame or joint


class Mount(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Pose of a sensor in base_link (FLU)."""

    xyz: Triple = (0.0, 0.0, 0.0)  # m
    rpy: Triple = (0.0, 0.0, 0.0)  # rad


class Lidar(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A 2-D scanner; ``range`` outside the limits is sent as 0 = no return."""

    mount: Mount
    hz: SensorRate
    beams: Annotated[int, Meta(ge=1, le=4096)]
    angle_min: Annotated[float, Meta(ge=-7, le=7)]  # rad
    angle_increment: Positive  # rad, counter-clockwise
    range_min: NotNegative  # m
    range_max: Positive  # m
    noise: NotNegative = 0.0  # m, 1 sigma
    frame: Name = "lidar"


class ImuSensor(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    mount: Mount
    hz: SensorRate
    gyro_noise: NotNegative = 0.0  # rad/s, 1 sigma per sample
    gyro_bias: NotNegative = 0.0  # rad/s, 1 sigma of the constant drawn from the seed
    accel_noise: NotNegative = 0.0  # m/s^2
    accel_bias: NotNegative = 0.0  # m/s^2
    mag_noise: NotNegative = 0.0  # T
    frame: Name = "imu"


class Encoders(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    hz: SensorRate
    ticks_per_turn: Annotated[int, Meta(ge=1, le=10_000_000)]


class GnssSensor(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    hz: SensorRate
    horizontal_noise: NotNegative = 0.0  # m, 1 sigma per axis
    vertical_noise: NotNegative = 0.0  # m
    speed_noise: NotNegative = 0.0  # m/s
    latency: NotNegative = 0.0  # s


class AirDataSensor(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    hz: SensorRate
    static_noise: NotNegative = 0.0  # Pa
    differential_noise: NotNegative = 0.0  # Pa
    static_bias: NotNegative = 0.0  # Pa, 1 sigma
    differential_bias: NotNegative = 0.0  # Pa, 1 sigma


class Camera(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    mount: Mount
    hz: SensorRate
    width: Annotated[int, Meta(ge=16, le=1920)]
    height: Annotated[int, Meta(ge=16, le=1080)]
    fov: Annotated[float, Meta(gt=0, lt=3.1)]  # rad, horizontal
    far: Positive = 100.0  # m
    frame: Name = "camera"


class Sensors(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What the vehicle carries; absent = not fitted."""

    lidar: Lidar | None = None
    imu: ImuSensor | None = None
    encoders: Encoders | None = None
    gnss: GnssSensor | None = None
    air_data: AirDataSensor | None = None
    camera: Camera | None = None


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
    motor_torque: Positive  # N m, at the wheel
    physics_hz: PhysicsRate = 200.0
    lateral_friction: Positive = 1.0


class BatteryPack(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """An ideal pack whose voltage falls in a straight line with its charge."""

    energy: Positive  # J
    full: Positive  # V
    empty: Positive  # V
    avionics: NotNegative = 0.0  # W, drawn at all times


class AirBody(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A JSBSim aircraft: the model's name in the vehicle's folder and how to command it."""

    model: Name
    physics_hz: PhysicsRate
    trim_speed: Positive  # m/s
    max_aileron: Deflection  # rad
    max_elevator: Deflection  # rad
    max_rudder: Deflection  # rad
    servo_rate: Positive  # rad/s
    servo_lag: NotNegative  # s
    mesh: Name | None = None
    battery: BatteryPack | None = None


class VehicleFile(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The whole of vehicle.yaml. ``params``: service name -> that service's parameters."""

    kind: Literal["ground", "fixed_wing"]
    about: str
    sensors: Sensors
    ground: GroundBody | None = None
    air: AirBody | None = None
    params: dict[str, dict[str, Any]] = {}


def load_vehicle(vehicles: Path, name: str) -> VehicleFile:
    """Reads ``vehicles/<name>/vehicle.yaml``. Raises BadInput."""
    folder = vehicles / name
    if not (folder / "vehicle.yaml").is_file():
        known = [p.parent.name for p in vehicles.glob("*/vehicle.yaml")]
        raise BadInput(f"no vehicle '{name}' in {vehicles}; {nearest(name, known)}")
    vehicle = load_yaml(folder / "vehicle.yaml", VehicleFile)
    place = Place(str(folder / "vehicle.yaml"))
    section = "ground" if vehicle.kind == "ground" else "air"
    if getattr(vehicle, section) is None:
        raise BadInput(f"{place.at('kind')}: kind is '{vehicle.kind}' but there is no '{section}:' section")
    _check_lidar(vehicle.sensors.lidar, place.at("sensors", "lidar"))
    ground, air = vehicle.ground, vehicle.air
    if ground is not None and ground.left_joint == ground.right_joint:
        raise BadInput(f"{place.at('ground', 'right_joint')}: the left wheel's joint too; name the right one")
    if air is not None and air.battery is not None and air.battery.empty >= air.battery.full:
        raise BadInput(f"{place.at('air', 'battery')}: empty at {air.battery.empty:g} V, full at {air.battery.full:g} V; exchange them")
    return vehicle


def _check_lidar(lidar: Lidar | None, place: Place) -> None:
    if lidar is None:
        return
    if lidar.range_min >= lidar.range_max:
        raise BadInput(f"{place.at('range_min')}: {lidar.range_min:g} m is not below range_max, {lidar.range_max:g} m")
    sweep = (lidar.beams - 1) * lidar.angle_increment
    if sweep > 2 * math.pi + 1e-6:
        raise BadInput(f"{place.at('angle_increment')}: {lidar.beams} beams make {sweep:.3g} rad, more than a full turn; lower it")
