"""A JSBSim aircraft of others: which file is its model, and a copy of all the files that it is made of."""

import re
import shutil
from pathlib import Path

from uvf.models.jsbsim.model_parts import ModelPart, parts, read
from uvf.models.yaml_data import BadInput

UNFIT = re.compile(r"[^A-Za-z0-9_.-]")
PLACES = {"engine": "engine", "thruster": "engine", "system": "systems"}


def jsbsim_model(source: Path) -> Path | None:
    """The JSBSim model file that ``source`` is or names, as FlightGear's ``-set.xml`` do, or that lies in this folder.

    None where it is none of JSBSim's. Raises BadInput where it is not clear which.
    """
    if source.is_dir():
        own = source / f"{source.resolve().name}.xml"
        models = [own] if _is_model(own) else sorted(path for path in source.glob("*.xml") if _is_model(path))
        if len(models) > 1:
            raise BadInput(f"{source}: {len(models)} JSBSim models lie there, {', '.join(path.name for path in models)}: name one of them")
        return models[0] if models else None
    if _is_model(source):
        return source
    return _of_set_file(source) if source.suffix == ".xml" and source.is_file() and b"<PropertyList" in source.read_bytes() else None


def _is_model(path: Path) -> bool:
    return path.suffix == ".xml" and path.is_file() and b"<fdm_config" in path.read_bytes()


def _of_set_file(path: Path) -> Path:
    """The model that an aircraft's set file of FlightGear names."""
    sim = read(path).find("sim")
    kind, name = ((sim.findtext(tag) or "").strip() if sim is not None else "" for tag in ("flight-model", "aero"))
    model = path.parent / f"{name}.xml"
    if kind != "jsb" or not name:
        raise BadInput(
            f"{path}: a file of FlightGear with the flight model '{kind or 'none'}'; give an aircraft whose flight model is 'jsb'"
        )
    if not _is_model(model):
        raise BadInput(f"{path}: its JSBSim model {model.name} is not there; put it beside this file, or name it")
    return model


def has_actuators(path: Path) -> bool:
    """Whether the control system of a model has servos of its own (``actuator``)."""
    files = {path, *(part.found for part in parts(path) if part.found is not None)}
    return any(next(read(file).iter("actuator"), None) is not None for file in files)


def copy_model(path: Path, folder: Path) -> str:
    """Copies a model and all its files into a vehicle's folder; returns the model's name there. Raises BadInput for what is missing."""
    name = UNFIT.sub("_", path.stem)
    used = parts(path)
    for part in used:
        if part.found is None:
            raise BadInput(f"{part.by}: no '{part.name}' for the {part.kind}; put it into {part.folders[0]} and begin again")
        target = folder / _place(part, name)
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(part.found, target)
    (folder / name).mkdir(exist_ok=True)
    shutil.copyfile(path, folder / name / f"{name}.xml")
    read(folder / name / f"{name}.xml")
    return name


def _place(part: ModelPart, model: str) -> Path:
    """Where JSBSim finds it again."""
    name = f"{part.name.removesuffix('.xml')}.xml"
    return Path(PLACES.get(part.kind, model)) / name
