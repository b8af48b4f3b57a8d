"""``vehicles/<name>/vehicle.yaml``: what a vehicle is, as data."""

from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec
from msgspec import Meta

from uvf.runtime.params import BadInput, load_yaml, nearest

Positive = Annotated[float, Meta(gt=0)]
NotNegative = Annotated[float, Meta(ge=0)]
Triple = tuple[float, float, float]


class Mount(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Pose of a sensor in base_link (FLU)."""

    xyz: Triple = (0.0, 0.0, 0.0)  # m
    rpy: Triple = (0.0, 0.0, 0.0)  # rad


class Lidar(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A 2-D scanner; ``range`` outside the limits is sent as 0 = no return."""

    mount: Mount
    hz: Positive
    beams: Annotated[int, Meta(ge=1)]
    angle_min: float  # rad
    angle_increment: float  # rad
    range_min: NotNegative  # m
    range_max: Positive  # m
    noise: NotNegative = 0.0  # m, 1 sigma
    frame: str = "lidar"


class ImuSensor(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    mount: Mount
    hz: Positive
    gyro_noise: NotNegative = 0.0  # rad/s, 1 sigma per sample
    gyro_bias: NotNegative = 0.0  # rad/s, 1 sigma of the constant drawn from the seed
    accel_noise: NotNegative = 0.0  # m/s^2
    accel_bias: NotNegative = 0.0  # m/s^2
    mag_noise: NotNegative = 0.0  # T
    frame: str = "imu"


class Encoders(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    hz: Positive
    ticks_per_turn: Annotated[int, Meta(ge=1)]


class GnssSensor(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    hz: Positive
    horizontal_noise: NotNegative = 0.0  # m, 1 sigma per axis
    vertical_noise: NotNegative = 0.0  # m
    speed_noise: NotNegative = 0.0  # m/s
    latency: NotNegative = 0.0  # s


class AirDataSensor(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    hz: Positive
    static_noise: NotNegative = 0.0  # Pa
    differential_noise: NotNegative = 0.0  # Pa
    static_bias: NotNegative = 0.0  # Pa, 1 sigma
    differential_bias: NotNegative = 0.0  # Pa, 1 sigma


class Camera(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    mount: Mount
    hz: Positive
    width: Annotated[int, Meta(ge=16, le=1920)]
    height: Annotated[int, Meta(ge=16, le=1080)]
    fov: Annotated[float, Meta(gt=0, lt=3.1)]  # rad, horizontal
    far: Positive = 100.0  # m
    frame: str = "camera"


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

    urdf: str
    left_joint: str
    right_joint: str
    wheel_radius: Positive  # m
    track: Positive  # m, between the wheels' contact points
    radius: Positive  # m, circle about base_link that holds the whole body
    max_linear: Positive  # m/s
    max_angular: Positive  # rad/s
    max_linear_acceleration: Positive  # m/s^2
    max_angular_acceleration: Positive  # rad/s^2
    motor_torque: Positive  # N m, at the wheel
    physics_hz: Positive = 200.0
    lateral_friction: Positive = 1.0


class BatteryPack(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """An ideal pack whose voltage falls in a straight line with its charge."""

    energy: Positive  # J
    full: Positive  # V
    empty: Positive  # V
    avionics: NotNegative = 0.0  # W, drawn at all times


class AirBody(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A JSBSim aircraft: the model's name in the vehicle's folder and how to command it."""

    model: str
    physics_hz: Positive
    trim_speed: Positive  # m/s
    max_aileron: Positive  # rad
    max_elevator: Positive  # rad
    max_rudder: Positive  # rad
    servo_rate: Positive  # rad/s
    servo_lag: NotNegative  # s
    mesh: str | None = None
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
    part = {"ground": vehicle.ground, "fixed_wing": vehicle.air}[vehicle.kind]
    if part is None:
        section = "ground" if vehicle.kind == "ground" else "air"
        raise BadInput(f"{folder / 'vehicle.yaml'}: kind is '{vehicle.kind}' but there is no '{section}:' section")
    return vehicle
