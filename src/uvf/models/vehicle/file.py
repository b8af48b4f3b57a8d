"""``vehicles/<name>/vehicle.yaml``: what a vehicle is, as data."""

from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec

from uvf.maths.kinematics import Twist
from uvf.models.keys import key, plain
from uvf.models.quantities import Name, NotNegative, PhysicsRate, Positive
from uvf.models.vehicle.air import AirBody, BatteryPack, check_air, check_battery
from uvf.models.vehicle.drive import AnyDrive, JointName, check_drive
from uvf.models.vehicle.joints import Spring, check_joints
from uvf.models.vehicle.layers import file_of, fill_vehicle, folders_of
from uvf.models.vehicle.sensors import Sensors, check_sensors, check_sensors_of_aircraft
from uvf.models.yaml_data import BadInput, FileLocation, load_yaml, nearest


class Motor(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A wheel's motor with its gear, at the wheel; a first-order lag lies between the command and what it holds."""

    stall_torque: Annotated[Positive, key("N m", "Torque at the wheel when it stands still at full voltage.")]
    no_load_speed: Annotated[Positive, key("rad/s", "Speed of the wheel without load at full voltage.")]
    lag: Annotated[NotNegative, key("s", "Time constant between the command and the motor.")] = 0.0


class Friction(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Coulomb coefficients on the ground: of the wheels along their rolling and across it, and of the links that only slide."""

    mu: Annotated[Positive, key("", "Coulomb coefficient of the wheels along their rolling direction.")] = 1.0
    mu2: Annotated[Positive, key("", "Coulomb coefficient of the wheels across it.")] = 1.0
    castor: Annotated[NotNegative, key("", "Coulomb coefficient of the links that only slide.")] = 0.02


class GroundBody(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A ground vehicle: its URDF, its drive and its limits."""

    urdf: Annotated[Name, plain("URDF or xacro file in the vehicle's folder.")]
    drive: Annotated[AnyDrive, plain("The driven wheels and how the vehicle turns by them; its `kind` decides which keys it has.")]
    radius: Annotated[
        Positive, key("m", "Radius of the circle about base_link that holds the whole body; the planner keeps it from obstacles.")
    ]
    max_linear: Annotated[Positive, key("m/s", "Largest speed.")]
    max_angular: Annotated[Positive, key("rad/s", "Largest turn rate.")]
    max_linear_acceleration: Annotated[Positive, key("m/s^2", "Largest acceleration.")]
    max_angular_acceleration: Annotated[Positive, key("rad/s^2", "Largest angular acceleration.")]
    motor: Annotated[Motor, plain("Motors of the driven wheels.")]
    friction: Annotated[Friction, plain("Friction on the ground.")] = Friction()
    battery: Annotated[BatteryPack | None, plain("Battery; left out: the vehicle has none and never runs empty.")] = None
    joints: Annotated[
        list[JointName],
        plain("Joints of the URDF that are moved on command: lift, pan, arm. Their `<limit>` gives range, `velocity` and `effort`."),
    ] = []
    springs: Annotated[
        dict[JointName, Spring],
        plain("Joints that give way on springs, by their names in the URDF. Joints named nowhere are held fast at zero."),
    ] = {}
    physics_hz: Annotated[PhysicsRate, key("Hz", "Physics steps per second of simulation time.")] = 200.0

    @property
    def turning_joints(self) -> tuple[str, ...]:
        """All whose positions are measured: of driven wheels, of the steering, of what is moved on command or on springs."""
        return (*self.drive.joints, *self.drive.steered_wheels, *self.joints, *self.springs)

    @property
    def max_twist(self) -> Twist:
        """Largest velocity in each direction; sideways 0 for a drive that does not go there."""
        return Twist(self.max_linear, self.max_angular, self.max_linear if self.drive.kinematics.goes_sideways else 0.0)


class VehicleFile(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The whole of vehicle.yaml. ``params``: service name -> that service's parameters.

    variant_of: another vehicle, whose file holds what this one does not say.
    """

    kind: Annotated[Literal["ground", "fixed_wing"], plain("`ground` needs a `ground` section, `fixed_wing` an `air` section.")]
    about: Annotated[str, plain("One sentence for lists.")]
    sensors: Annotated[Sensors, plain("What the vehicle carries. SLAM and planner need a lidar and encoders.")]
    ground: Annotated[GroundBody | None, plain("Body of a ground vehicle.")] = None
    air: Annotated[AirBody | None, plain("Body of a JSBSim aircraft.")] = None
    params: Annotated[
        dict[str, dict[str, Any]],
        plain("Parameters by service: `params: {planner: {patience: 12.0}}`; see [parameters](service-parameters.md)."),
    ] = {}
    variant_of: Annotated[Name | None, plain("Another vehicle whose file holds what this one leaves out.")] = None

    @property
    def has_battery(self) -> bool:
        """Whether there is anything to charge."""
        body = self.ground or self.air
        return body is not None and body.battery is not None


def load_vehicle(vehicles: str | Path, name: str, named_at: FileLocation | None = None) -> VehicleFile:
    """Reads ``<vehicles>/<name>/vehicle.yaml`` in the folder of all vehicles; ``named_at``: what names it. Raises BadInput."""
    folder = Path(vehicles) / name
    if not (folder / "vehicle.yaml").is_file():
        known = [p.parent.name for p in Path(vehicles).glob("*/vehicle.yaml")]
        raise BadInput(f"{f'{named_at}: ' if named_at else ''}no vehicle '{name}' in {vehicles}; {nearest(name, known)}")
    vehicle = load_yaml(folder / "vehicle.yaml", VehicleFile, fill_vehicle)
    place = FileLocation(str(folder / "vehicle.yaml"))
    section = "ground" if vehicle.kind == "ground" else "air"
    if getattr(vehicle, section) is None:
        raise BadInput(f"{place.at('kind')}: kind is '{vehicle.kind}' but there is no '{section}:' section")
    check_sensors(vehicle.sensors, place.at("sensors"))
    ground, air = vehicle.ground, vehicle.air
    if ground is not None:
        check_drive(ground.drive, place.at("ground", "drive"))
        check_joints(ground.joints, ground.springs, (*ground.drive.all_wheels, *ground.drive.steered_wheels), place.at("ground"))
    if ground is not None and ground.battery is not None:
        _check_ground_battery(ground.battery, place.at("ground", "battery"))
    if air is not None:
        check_air(air, place.at("air"))
        check_sensors_of_aircraft(vehicle.sensors, place.at("sensors"))
    return vehicle if vehicle.variant_of is None else _with_files(vehicle, folders_of(folder))


def _check_ground_battery(pack: BatteryPack, place: FileLocation) -> None:
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
