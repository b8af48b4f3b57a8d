"""Everything that is wrong with a vehicle's folder, in one run."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from launch.vehicles.aircraft_rules import aircraft_faults
from launch.vehicles.trial_drive import trial_faults
from services.sim_camera.build import camera_faults
from services.sim_ground.build import rate_faults
from uvf.models.checks.body_rules import body_faults, body_notes
from uvf.models.keys import hints_of
from uvf.models.urdf.model import read_urdf
from uvf.models.urdf.robot import UrdfModel
from uvf.models.urdf.rules import model_faults, wheel_faults
from uvf.models.vehicle.air import AirBody
from uvf.models.vehicle.file import GroundBody, VehicleFile, load_vehicle
from uvf.models.vehicle.joints import joint_faults, mount_faults
from uvf.models.vehicle.layers import file_of, folders_of
from uvf.models.vehicle.sensors import Sensors
from uvf.models.yaml_data import BadInput, FileLocation, convert, nearest, read_yaml

SECTIONS = {"ground": GroundBody, "air": AirBody}


@dataclass
class Inspection:
    """Result of an inspection. faults: what must be fixed, a line each; notes: what is worth a look; file and model as far as readable."""

    folder: Path
    faults: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    file: VehicleFile | None = None
    model: UrdfModel | None = None


def folder_of(name: str, vehicles: Path) -> Path:
    """The folder of a vehicle given by its name in ``vehicles`` or by its path. Raises BadInput."""
    folder = next((f for f in (vehicles / name, Path(name)) if (f / "vehicle.yaml").is_file()), None)
    if folder is None:
        known = [p.parent.name for p in vehicles.glob("*/vehicle.yaml")]
        raise BadInput(f"no vehicle '{name}': no {name}/vehicle.yaml in {vehicles} nor here; {nearest(name, known)}")
    return folder.resolve()


def inspect(folder: Path) -> Inspection:
    """Finds all faults of the vehicle's files, of its URDF, and between the two."""
    found = Inspection(folder)
    try:
        found.file = load_vehicle(folder.parent, folder.name)
    except BadInput as error:
        found.faults.append(str(error))
        found.faults += [line for line in _section_faults(folder) if line not in found.faults]
    if found.file is not None and found.file.air is not None:
        faults, found.notes = aircraft_faults(folder, found.file.air)
        found.faults += faults
        return found
    if found.file is not None and found.file.ground is not None:
        place = FileLocation(str(folder / "vehicle.yaml"))
        found.faults += rate_faults(found.file.sensors, found.file.ground, place)
        found.faults += camera_faults(found.file.sensors, place)
    urdf = _urdf(folder, found.file)
    if urdf is not None:
        _inspect_body(found, urdf)
    if found.file is not None and found.file.ground is not None and not found.faults:
        found.faults += trial_faults(folder, found.file.ground)
    return found


def _section_faults(folder: Path) -> Iterator[str]:
    """The first fault of each section, where the file as a whole is refused."""
    path = folder / "vehicle.yaml"
    try:
        data = read_yaml(path)
    except BadInput:
        return
    sections = [((key,), data[key], type_) for key, type_ in SECTIONS.items() if key in data] if isinstance(data, dict) else []
    sensors = data.get("sensors") if isinstance(data, dict) else None
    hints = hints_of(Sensors)
    known = {k: v for k, v in sensors.items() if k in hints} if isinstance(sensors, dict) else {}
    for keys, value, type_ in (*sections, *((("sensors", k), v, hints[k]) for k, v in known.items())):
        if isinstance(value, dict) and ("preset" in value or "variant_of" in data):
            continue  # not whole without what it refers to
        try:
            convert(value, type_, str(path), keys)
        except BadInput as error:
            yield str(error)


def _urdf(folder: Path, file: VehicleFile | None) -> Path | None:
    """The URDF, also of a vehicle.yaml that is refused for something else."""
    if file is not None:
        return folder / file.ground.urdf if file.ground is not None else None
    try:
        data: Any = read_yaml(folder / "vehicle.yaml")
        name = data["ground"]["urdf"]
        return folder / file_of(folders_of(folder), str(name))
    except (BadInput, KeyError, TypeError):
        return None


def _inspect_body(found: Inspection, urdf: Path) -> None:
    try:
        found.model = model = read_urdf(urdf)
    except BadInput as error:
        found.faults += [line for line in [str(error)] if line not in found.faults]  # told already where a sensor sits on a link
        return
    ground = found.file.ground if found.file is not None else None
    wheels = ground.drive.all_wheels if ground is not None else ()
    steering = tuple(ground.drive.steered_wheels) if ground is not None else ()
    faults = [str(fault) for fault in (*wheel_faults(model, wheels, steering), *model_faults(model))]
    if found.file is not None and ground is not None:
        faults += joint_faults(model, ground.joints, ground.springs, ground.physics_hz)
        faults += mount_faults(model, ground.joints, found.file.sensors, FileLocation(str(found.folder / "vehicle.yaml")).at("sensors"))
    found.faults += [line for line in dict.fromkeys(faults) if line not in found.faults]
    if found.file is not None and ground is not None and len(model.roots) == 1 and all(j in model.joints for j in (*wheels, *steering)):
        found.faults += body_faults(model, found.file, found.folder / "vehicle.yaml")
        found.notes += body_notes(model, found.file)
