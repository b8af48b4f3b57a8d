"""The points at which an aircraft can touch the ground: wheels, and parts of its structure."""

from collections.abc import Collection
from itertools import count
from pathlib import Path
from typing import NamedTuple

import numpy as np

from services.sim_air.engine.wiring import Properties
from uvf.maths.rotations import Floats
from uvf.models.jsbsim.model_file import contact_names

INCH = 0.0254  # m
FT = 0.3048  # m


class GroundTouch(NamedTuple):
    """A point that touches the ground; speed: sink rate [m/s]."""

    name: str
    is_wheel: bool
    speed: float


class Contacts:
    """The contact points of one loaded model."""

    def __init__(self, properties: Properties, known: Collection[str], path: Path) -> None:
        self._properties = properties
        self._nodes = list(_nodes(known))
        self._names = contact_names(path, len(self._nodes))

    def points(self) -> Floats:
        """Positions (n, 3) [m] of the unloaded contact points from the centre of gravity, body FLU."""
        cg = self._place("inertia/cg-{}-in")
        return np.array([(self._place(node + "/{}-position") - cg) * (-1, -1, 1) for node in self._nodes]).reshape(-1, 3) * INCH

    def touches(self) -> list[GroundTouch]:
        """The points that touch the ground now."""
        now = []
        for node, name in zip(self._nodes, self._names, strict=True):
            if self._properties[f"{node}/WOW"]:
                now.append(GroundTouch(name, node.startswith("gear"), self._properties[f"{node}/compression-velocity-fps"] * FT))
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
