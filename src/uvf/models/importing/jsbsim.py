"""A JSBSim aircraft of others: which file is its model, and a copy of all the files that it is made of."""

import re
import shutil
from pathlib import Path

from uvf.models.jsbsim.model_parts import ModelPart, parts, read
from uvf.models.yaml_data import BadInput

UNFIT = re.compile(r"[^A-Za-z0-9_.-]")
PLACES = {"engine": "engine", "thruster": "engine", "system": "systems"}


def jsbsim_model(source: Path) -> Path | None:
    """The JSBSim model file that ``source`` is, or that lies in this folder under its name; None where it is none of JSBSim's."""
    path = source / f"{source.resolve().name}.xml" if source.is_dir() else source
    if path.suffix != ".xml" or not path.is_file() or b"<fdm_config" not in path.read_bytes():
        return None
    return path


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
