"""Lets air that turns act on a JSBSim model, which takes no such thing from outside: its turbulence has angular gusts of its own only.

While a model is loaded, its aerodynamics' rates through the air are replaced by rates less those of the gust, which are properties
that can be written. With a gust of nothing the model computes what it did before, to the last bit.
"""

import copy
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from xml.etree.ElementTree import Element, ElementTree, SubElement

from uvf.models.jsbsim.model_parts import read

AXES = ("p", "q", "r")
GUST_RATES = tuple(f"gust/{axis}-rad_sec" for axis in AXES)
"""rad/s, rotation of the air about the body's forward, right and down axes."""


@contextmanager
def with_gust_rates(path: Path) -> Iterator[Path]:
    """Adds rotation of the air to the model at ``path``; yields the folder of the changed ``<model>/<model>.xml``. Raises BadInput."""
    with TemporaryDirectory() as folder:
        copied = Path(shutil.copytree(path.parent, Path(folder) / path.parent.name))
        ElementTree(_changed(read(path))).write(copied / path.name)
        yield Path(folder)


def _changed(model: Element) -> Element:
    changed = copy.deepcopy(model)
    for tag in [*changed.findall("output"), *changed.findall("input")]:
        changed.remove(tag)  # files and sockets of the model's own
    for section in changed.findall("aerodynamics"):
        for tag in section.iter():
            for axis in AXES:
                if tag.text and tag.text.strip().lstrip("-") == f"velocities/{axis}-aero-rad_sec":
                    tag.text = tag.text.replace("velocities/", "gust/")
        for i, tag in enumerate([*map(_made, GUST_RATES), *map(_less, AXES)]):
            section.insert(i, tag)
    return changed


def _made(name: str) -> Element:
    """A property that begins at nothing."""
    tag = Element("property", value="0")
    tag.text = name
    return tag


def _less(axis: str) -> Element:
    """The rate through the air: the body's own less that of the air."""
    function = Element("function", name=f"gust/{axis}-aero-rad_sec")
    difference = SubElement(function, "difference")
    SubElement(difference, "property").text = f"velocities/{axis}-aero-rad_sec"
    SubElement(difference, "property").text = f"gust/{axis}-rad_sec"
    return function
