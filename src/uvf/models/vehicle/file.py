"""``vehicles/<name>/vehicle.yaml``: what a vehicle is, as data."""

from pathlib import Path
from typing import Any, Literal

import msgspec

from uvf.models.quantities import Name, NotNegative, PhysicsRate, Positive
from uvf.models.vehicle.air import AirBody, BatteryPack, check_air, check_battery
from uvf.models.vehicle.layers import file_of, fill_vehicle, folders_of
from uvf.models.vehicle.sensors import Sensors, check_sensors, check_sensors_of_aircraft
from uvf.models.yaml_data import BadInput, FileLocation, load_yaml, nearest


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
    place = FileLocation(str(folder / "vehicle.yaml"))
    section = "ground" if vehicle.kind == "ground" else "air"
    if getattr(vehicle, section) is None:
        raise BadInput(f"{place.at('kind')}: kind is '{vehicle.kind}' but there is no '{section}:' section")
    check_sensors(vehicle.sensors, place.at("sensors"))
    ground, air = vehicle.ground, vehicle.air
    if ground is not None and ground.left_joint == ground.right_joint:
        raise BadInput(f"{place.at('ground', 'right_joint')}: the left wheel's joint too; name the right one")
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
