"""URDF and xacro files as models, and as the plain files that engines load."""

from collections.abc import Iterable
from dataclasses import replace
from functools import lru_cache
from pathlib import Path

import numpy as np

from uvf.models.generated_file import handed_file
from uvf.models.urdf.inertia import joined, moved
from uvf.models.urdf.reader import read_model
from uvf.models.urdf.robot import Inertial, Link, UrdfModel
from uvf.models.urdf.rules import model_faults, wheel_faults
from uvf.models.urdf.source import read_xml
from uvf.models.urdf.writer import urdf_text
from uvf.models.yaml_data import BadInput

NO_MASS = Inertial(1e-6, np.zeros(3), np.eye(3) * 1e-9)
"""For frames: to engines a link that gives no mass weighs 1 kg, and a root of no mass stands fixed in the world."""
MARGIN = 1e-6
"""Share by which the largest moment stays below the other two together, against rounding in the text."""


def read_urdf(path: Path) -> UrdfModel:
    """Model of a URDF file, with all that is wrong with its elements in ``faults``. Raises BadInput where it is no URDF at all."""
    robot = read_xml(path)
    if robot.tag != "robot":
        raise BadInput(f"{path}: the outermost tag is <{robot.tag}>; a URDF begins with <robot>")
    return read_model(path, robot)


def load_urdf(path: Path) -> UrdfModel:
    """Model of a URDF file without faults. Raises BadInput for the first fault."""
    model = read_urdf(path)
    for fault in model_faults(model):
        raise BadInput(str(fault))
    return model


def check_urdf(path: Path, wheels: Iterable[str], steering: Iterable[str] = ()) -> UrdfModel:
    """Model of a URDF file without faults. Raises BadInput for the first fault.

    wheels, steering: names of joints that must be there and turn.
    """
    model = read_urdf(path)
    for fault in (*wheel_faults(model, tuple(wheels), tuple(steering)), *model_faults(model)):
        raise BadInput(str(fault))
    return model


def engine_urdf(path: Path) -> Path:
    """Path of the URDF as a plain file that names its meshes by their whole paths; the file is named by its content. Raises BadInput."""
    return _written(path, *_state(path))


def _state(path: Path) -> tuple[int, int]:
    """What changes when somebody writes the file; included files are looked at when a process begins."""
    try:
        found = path.stat()
    except OSError:
        return 0, 0
    return found.st_mtime_ns, found.st_size


@lru_cache(maxsize=64)
def _written(path: Path, _changed: int, _size: int) -> Path:
    model = load_urdf(path)
    links = {name: _with_mass(link) for name, link in _with_heavy_root(model).items()}
    text = urdf_text(replace(model, links=links), lambda mesh: str(mesh.resolve()))
    return handed_file(path.stem, ".urdf", text.encode())


def _with_heavy_root(model: UrdfModel) -> dict[str, Link]:
    """The links; where the root has no mass, it has that of what is fast to it: engines take little for heavy on light."""
    root = model.roots[0]
    if model.links[root].inertial is not None:
        return model.links
    body, poses = model.rigid_with(root), model.link_poses()
    given = [moved(inertial, poses[name]) for name in sorted(body) if (inertial := model.links[name].inertial) is not None]
    light = {name: replace(model.links[name], inertial=None) for name in body}
    return {**model.links, **light, root: replace(model.links[root], inertial=joined(given))}


def _with_mass(link: Link) -> Link:
    return replace(link, inertial=_within_triangle(link.inertial) if link.inertial is not None else NO_MASS)


def _within_triangle(inertial: Inertial) -> Inertial:
    """Figures of a flat body that were rounded just beyond the triangle rule, brought within: Bullet takes no inertia at all instead."""
    (a, b, c), axes = np.linalg.eigh(inertial.inertia)
    largest = (a + b) * (1 - MARGIN)
    return inertial if c <= largest else replace(inertial, inertia=axes @ np.diag((a, b, largest)) @ axes.T)
