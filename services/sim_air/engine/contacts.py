"""The points at which an aircraft can touch the ground: wheels, and parts of its structure."""

from collections.abc import Collection
from itertools import count
from pathlib import Path
from typing import NamedTuple

import numpy as np

from services.sim_air.engine.wiring import Properties
from uvf.maths.rotations import Floats
from uvf.models.jsbsim.model_file import contact_names
from uvf.models.yaml_data import BadInput, FileLocation, nearest

INCH = 0.0254  # m
FT = 0.3048  # m


class GroundTouch(NamedTuple):
    """A point that touches the ground. carries: a wheel or a skid; speed: sink rate [m/s]."""

    name: str
    carries: bool
    speed: float


class Contacts:
    """The contact points of one loaded model."""

    def __init__(self, properties: Properties, known: Collection[str], path: Path, skids: Collection[str], place: FileLocation) -> None:
        """skids: names of parts of the structure that it may slide on; place: where they are told. Raises BadInput."""
        self._properties = properties
        self._nodes = list(_nodes(known))
        self.names = contact_names(path, len(self._nodes))
        for name in skids:
            if name not in self.names:
                raise BadInput(f"{place}: the model has no contact '{name}'; {nearest(name, self.names)}")
        self._carry = [node.startswith("gear") or name in skids for node, name in zip(self._nodes, self.names, strict=True)]

    @property
    def has_wheels(self) -> bool:
        """Whether any contact is a wheel."""
        return any(node.startswith("gear") for node in self._nodes)

    def points(self) -> Floats:
        """Positions (n, 3) [m] of the unloaded contact points from the centre of gravity, body FLU."""
        cg = self._place("inertia/cg-{}-in")
        return np.array([(self._place(node + "/{}-position") - cg) * (-1, -1, 1) for node in self._nodes]).reshape(-1, 3) * INCH

    def touches(self) -> list[GroundTouch]:
        """The points that touch the ground now."""
        now = []
        for node, name, carries in zip(self._nodes, self.names, self._carry, strict=True):
            if self._properties[f"{node}/WOW"]:
                now.append(GroundTouch(name, carries, self._properties[f"{node}/compression-velocity-fps"] * FT))
        return now

    def _place(self, name: str) -> Floats:
        return np.array([self._properties[name.format(axis)] for axis in "xyz"])


def _nodes(known: Collection[str]) -> list[str]:
    """JSBSim numbers wheels (gear) and structure (contact) together, in the order of the file."""
    found: list[str] = []
    for i in count():
        number = f"[{i}]" if i else ""
        node = next((n for n in (f"gear/unit{number}", f"contact/unit{number}") if f"{n}/WOW" in known), None)
        if node is None:
            return found
        found.append(node)
    return found
