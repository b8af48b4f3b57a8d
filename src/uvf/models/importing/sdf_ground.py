"""The ground of an imported world brought to z = 0, and the floor's extent."""

from collections.abc import Sequence
from pathlib import Path

import msgspec
import numpy as np

from uvf.maths.rotations import from_euler, matrix
from uvf.models.importing.notes import Notes
from uvf.models.importing.sdf_shapes import Thing
from uvf.models.shapes.scene import still
from uvf.models.world.file import LARGEST_FLOOR, Box, Colour, Cylinder, Field, Mesh, Origin, Sphere, WorldFile
from uvf.models.world.geometry import solids

Planes = Sequence[tuple[float, Colour | None]]

LEVEL = 1e-3  # m
MARGIN = 1.0  # m of floor about the outermost thing
SLAB_SHARE = 0.5  # of the floor that a slab covers to count as the ground
THICKEST_SLAB = 0.5  # m
SHORTEST_SLAB = 3.0  # m
FARTHEST = 1e4  # m
ON_SLAB = 0.01  # m
WIDEST = 1000.0  # m
PALE: Colour = (0.5, 0.5, 0.48)
BARE = WorldFile(about="", origin=Origin(0.0, 0.0), floor=(-10.0, -10.0, 10.0, 10.0))


class SdfGround:
    """Finds the ground of an imported world; ``folder`` holds its meshes."""

    def __init__(self, folder: Path, notes: Notes) -> None:
        self._folder = folder
        self._notes = notes

    def levelled(self, world: WorldFile, things: Sequence[Thing], planes: Planes) -> WorldFile:
        """``world`` with the things, moved so that the ground that one drives on is z = 0. planes: height [m] and colour of level ones."""
        kept = [t for t in things if np.abs(_place(t)).max() < FARTHEST]
        if len(kept) < len(things):
            self._notes.add(f"things farther than {FARTHEST:g} m from the origin are left out", f"{len(things) - len(kept)}")
        height, colour = max(planes, key=lambda plane: plane[0], default=(0.0, None))
        floor, slab = self._floor(kept), self._slab(kept)
        fields = []
        if slab is not None and (not planes or _top(slab) >= height - LEVEL):
            height = _top(slab)
            kept.remove(slab)
            fields = [Field(_extent(slab), slab.colour)]
            self._notes.add("a slab under everything is the ground, z = 0", slab.name)
        if abs(height) > LEVEL:
            self._notes.add(f"the ground lies at {height:g} m; everything is moved by {-height:g} m so that it is z = 0")
            kept = [_moved(thing, -height) for thing in kept]
        return msgspec.structs.replace(_with(world, kept), floor=floor, fields=fields, ground_colour=colour or PALE)

    def _slab(self, things: Sequence[Thing]) -> Box | None:
        """A level box below the middles of all others that carries most of them."""
        level = [t for t in things if isinstance(t, Box) and abs(t.rpy[0]) + abs(t.rpy[1]) < 1e-6]
        boxes = [t for t in level if t.size[2] <= THICKEST_SLAB and min(t.size[:2]) >= SHORTEST_SLAB]
        if not boxes or len(things) < 2:
            return None
        widest = max(boxes, key=lambda b: b.size[0] * b.size[1])
        x_min, y_min, x_max, y_max = self._floor(things)
        covers = widest.size[0] * widest.size[1] >= SLAB_SHARE * (x_max - x_min - 2 * MARGIN) * (y_max - y_min - 2 * MARGIN)
        above = sum(_middle(t) > _top(widest) for t in things if t is not widest)
        return widest if covers and above >= SLAB_SHARE * (len(things) - 1) else None

    def _floor(self, things: Sequence[Thing]) -> tuple[float, float, float, float]:
        """The rectangle about everything; about the origin when there is nothing."""
        parts = still(solids(_with(BARE, things), self._folder))
        if len(parts.kinds) == 0:
            return BARE.floor
        low, high = parts.low[:, :2].min(axis=0) - MARGIN, parts.high[:, :2].max(axis=0) + MARGIN
        if np.prod(high - low) > LARGEST_FLOOR:
            middle = np.median((parts.low[:, :2] + parts.high[:, :2]) / 2, axis=0)
            low, high = np.maximum(low, middle - WIDEST / 2), np.minimum(high, middle + WIDEST / 2)
            self._notes.add(f"the drivable floor is cut to {WIDEST:g} m a side")
        x_min, y_min, x_max, y_max = (round(float(v), 2) for v in (*low, *high))
        return x_min, y_min, x_max, y_max


def _with(world: WorldFile, things: Sequence[Thing]) -> WorldFile:
    return msgspec.structs.replace(
        world,
        boxes=[t for t in things if isinstance(t, Box)],
        cylinders=[t for t in things if isinstance(t, Cylinder)],
        spheres=[t for t in things if isinstance(t, Sphere)],
        meshes=[t for t in things if isinstance(t, Mesh)],
    )


def _place(thing: Thing) -> tuple[float, float, float]:
    if isinstance(thing, Cylinder):
        return thing.base
    return thing.position if isinstance(thing, Mesh) else thing.centre


def _moved(thing: Thing, up: float) -> Thing:
    x, y, z = _place(thing)
    name = "base" if isinstance(thing, Cylinder) else "position" if isinstance(thing, Mesh) else "centre"
    return msgspec.structs.replace(thing, **{name: (x, y, z + up)})


def _top(box: Box) -> float:
    return box.centre[2] + box.size[2] / 2


def _middle(thing: Thing) -> float:
    """Height [m] of the middle, of a mesh a little above its origin: enough to tell what stands on a slab."""
    z = _place(thing)[2]
    return z + thing.height / 2 if isinstance(thing, Cylinder) else z + ON_SLAB if isinstance(thing, Mesh) else z


def _extent(box: Box) -> tuple[float, float, float, float]:
    """x_min, y_min, x_max, y_max [m]."""
    dx, dy, _ = np.abs(matrix(from_euler(*box.rpy))) @ (np.array(box.size) / 2)
    x, y, _ = box.centre
    x_min, y_min, x_max, y_max = (round(float(v), 3) for v in (x - dx, y - dy, x + dx, y + dy))
    return x_min, y_min, x_max, y_max
