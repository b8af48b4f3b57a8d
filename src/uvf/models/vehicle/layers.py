"""What a vehicle.yaml only refers to, put in before it is read: the vehicle it is a variant of, presets, links that sensors sit on."""

import contextlib
from pathlib import Path
from typing import Any

import numpy as np

from uvf.maths.rotations import from_euler, to_euler
from uvf.maths.se3 import Transform, compose
from uvf.models.urdf.model import load_urdf
from uvf.models.vehicle.sensor_presets import fill_presets
from uvf.models.yaml_data import BadInput, FileLocation, nearest, read_yaml

VARIANT = "variant_of"
ZERO = (0.0, 0.0, 0.0)


def fill_vehicle(data: Any, place: FileLocation) -> Any:
    """The plain data of a vehicle.yaml with all that it refers to put in. Raises BadInput for what is not there."""
    if not isinstance(data, dict):
        return data  # what is wrong with it is found when it is converted
    folders = folders_of(Path(place.file).parent)
    for folder in folders[1:]:
        data = merged(read_yaml(folder / "vehicle.yaml"), data)
    return _fill_links(fill_presets(data, place), folders, place)


def folders_of(folder: Path) -> list[Path]:
    """A vehicle's folder, then that of the vehicle it is a variant of, and so on. Raises BadInput."""
    folders = [folder]
    while (name := _base_of(folders[-1])) is not None:
        place = FileLocation(str(folders[-1] / "vehicle.yaml")).at(VARIANT)
        base = folder.parent / name
        if not (base / "vehicle.yaml").is_file():
            known = [p.parent.name for p in folder.parent.glob("*/vehicle.yaml")]
            raise BadInput(f"{place}: no vehicle '{name}' beside it; {nearest(name, known)}")
        if base in folders:
            raise BadInput(f"{place}: '{name}' is a variant of this one; one of the two must stand for itself")
        folders.append(base)
    return folders


def _base_of(folder: Path) -> str | None:
    data = read_yaml(folder / "vehicle.yaml")
    name = data.get(VARIANT) if isinstance(data, dict) else None
    return name if isinstance(name, str) else None


def merged(base: Any, over: Any) -> Any:
    """``over`` laid on ``base``, mapping by mapping; lists and single values are replaced."""
    if not isinstance(base, dict) or not isinstance(over, dict):
        return over
    return {**base, **{key: merged(base.get(key), value) for key, value in over.items()}}


def holding(folders: list[Path], name: str) -> Path:
    """The first of the folders that has a file or folder of this name; where none has, the first."""
    for folder in folders:
        with contextlib.suppress(OSError):  # a name too long for the system is on no disk
            if (folder / name).exists():
                return folder
    return folders[0]


def file_of(folders: list[Path], name: str) -> str:
    """Path of a vehicle's file as seen from its own folder, which is the first."""
    found = holding(folders, name)
    return name if found == folders[0] else f"../{found.name}/{name}"


def _fill_links(data: dict[str, Any], folders: list[Path], place: FileLocation) -> dict[str, Any]:
    """``mount: {link: base_scan}`` becomes the pose of that link in the URDF; xyz and rpy beside it count from there."""
    sensors, ground = data.get("sensors"), data.get("ground")
    if not isinstance(sensors, dict) or not isinstance(ground, dict) or not isinstance(ground.get("urdf"), str):
        return data
    urdf = folders[0] / file_of(folders, ground["urdf"])
    filled = {
        kind: [_filled(s, urdf, place.at("sensors", kind, i)) for i, s in enumerate(sensor)]
        if isinstance(sensor, list)
        else _filled(sensor, urdf, place.at("sensors", kind))
        for kind, sensor in sensors.items()
    }
    return {**data, "sensors": filled}


def _filled(sensor: Any, urdf: Path, place: FileLocation) -> Any:
    mount = sensor.get("mount") if isinstance(sensor, dict) else None
    if not isinstance(mount, dict) or not isinstance(mount.get("link"), str):
        return sensor
    poses = load_urdf(urdf).link_poses()
    if mount["link"] not in poses:
        raise BadInput(f"{place.at('mount', 'link')}: no link '{mount['link']}' in {urdf.name}; {nearest(mount['link'], poses)}")
    try:
        rpy, xyz = (np.array(mount.get(key, ZERO), dtype=np.float64).reshape(3) for key in ("rpy", "xyz"))
    except (ValueError, TypeError):
        return sensor  # refused when it is converted
    base_from_sensor = compose(poses[mount["link"]], Transform(from_euler(*rpy), xyz))
    pose = {"xyz": base_from_sensor.translation.tolist(), "rpy": list(to_euler(base_from_sensor.rotation))}
    return {**sensor, "mount": {**mount, **pose}}
