"""The ground of an imported world brought to z = 0, and the floor's extent."""

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import msgspec
import numpy as np
from numpy.typing import NDArray

from uvf.models.importing.heights import terrain_floor
from uvf.models.importing.notes import Notes
from uvf.models.importing.sdf.shapes import Thing
from uvf.models.shapes.mesh import triangles
from uvf.models.shapes.scene import still
from uvf.models.shapes.solid import Solid
from uvf.models.world.file import LARGEST_FLOOR, Box, Colour, Cylinder, Field, Mesh, Origin, Sphere, Terrain, WorldFile
from uvf.models.world.geometry import solids

Floats = NDArray[np.float64]
Planes = Sequence[tuple[float, Colour | None]]

LEVEL = 1e-3  # m
MARGIN = 1.0  # m of floor about the outermost thing
SLAB_SHARE = 0.5  # of the floor that a level surface covers to count as the ground, and of the things that stand above it
OVER_TILES = 0.8  # of the other things that stand over slabs laid side by side that are the ground
THICKEST_SLAB = 1.5  # m
SHORTEST_SLAB = 3.0  # m
DEEP, SUNK_SHARE, SUNK_AREA = 0.1, 0.05, 1.0  # m below the ground, share of all level floor, and m^2, from which on it is told of
MOST_SLOPE = np.radians(1.0)  # of a level surface
SAME_LEVEL = 0.005  # m, between surfaces of one level
SUNK = 0.002  # m, by which a building's own floor lies below the ground: the engine feels the edges between its triangles
FARTHEST = 1e4  # m
WIDEST = 1000.0  # m
PALE: Colour = (0.5, 0.5, 0.48)
BARE = WorldFile(about="", origin=Origin(0.0, 0.0), floor=(-10.0, -10.0, 10.0, 10.0))


class _Storey(NamedTuple):
    """A wide level surface of things. height [m]; extents: x_min, y_min, x_max, y_max [m] of each; is_slab: they are nothing else."""

    things: tuple[Thing, ...]
    height: float
    extents: tuple[tuple[float, float, float, float], ...]
    is_slab: bool


class _Level(NamedTuple):
    """A level surface of a thing that looks up: height [m], area [m^2]."""

    height: float
    area: float


class SdfGround:
    """Finds the ground of an imported world; ``folder`` holds its meshes."""

    def __init__(self, folder: Path, notes: Notes) -> None:
        self._folder = folder
        self._notes = notes

    def levelled(self, world: WorldFile, things: Sequence[Thing], planes: Planes, names_ground: bool) -> WorldFile:
        """``world`` with the things, moved so that the ground that one drives on is z = 0. planes: height [m] and colour of level ones.

        names_ground: the file includes Gazebo's own ground plane.
        """
        kept = [t for t in things if np.abs(_place(t)).max() < FARTHEST]
        if len(kept) < len(things):
            world = msgspec.structs.replace(world, looks=[k for k in world.looks if np.abs(k.position).max() < FARTHEST])
            self._notes.add(f"things farther than {FARTHEST:g} m from the origin are left out", f"{len(things) - len(kept)}")
        height, colour = max(planes, key=lambda plane: plane[0], default=(0.0, None))
        floor, storey = self._floor(kept), self._storey(kept)
        fields = []
        if storey is not None and (not planes or storey.height >= height - LEVEL):
            height = storey.height
            names = ", ".join(thing.name for thing in storey.things)
            kept = [thing for thing in kept if thing not in storey.things]
            if storey.is_slab:
                fields = [Field(e, thing.colour) for e, thing in zip(storey.extents, storey.things, strict=True) if not thing.hidden]
                self._notes.add("a slab under everything is the ground, z = 0", names)
            else:
                kept += [_moved(thing, -SUNK) for thing in storey.things]
                note = f"its floor is the ground, z = 0; it stands {1e3 * SUNK:g} mm lower, so that wheels run on the plane"
                self._notes.add(note, names)
        elif kept and not (planes or names_ground):
            self._notes.add("no ground in the file: a plane at z = 0 is put in")
        if abs(height) > LEVEL:
            self._notes.add(f"the ground lies at {height:g} m; everything is moved by {-height:g} m so that it is z = 0")
            kept = [_moved(thing, -height) for thing in kept]
            world = _looks_moved(world, -height)
        self._tell_sunk(kept)
        return msgspec.structs.replace(_with(world, kept), floor=floor, fields=fields, ground_colour=colour or PALE)

    def on_terrain(self, world: WorldFile, things: Sequence[Thing], terrain: Terrain, lowest: float) -> WorldFile:
        """``world`` with the things on a terrain, moved so that its lowest, at ``lowest`` [m], is z = 0."""
        if abs(lowest) > LEVEL:
            self._notes.add(f"the terrain's lowest lies at {lowest:g} m; everything is moved by {-lowest:g} m so that it is z = 0")
        moved = _with(_looks_moved(world, -lowest), [_moved(thing, -lowest) for thing in things])
        return msgspec.structs.replace(moved, terrain=terrain, floor=terrain_floor(terrain, self._notes))

    def _tell_sunk(self, things: Sequence[Thing]) -> None:
        """Floors below the ground, which is a plane, are nobody's to drive on."""
        levels = [level for thing in things for level in self._levels(thing)]
        low = [level for level in levels if level.height < -DEEP]
        sunk, whole = (sum(level.area for level in some) for some in (low, levels))
        if sunk > SUNK_SHARE * whole and sunk > SUNK_AREA:
            lowest = min(level.height for level in low)
            self._notes.add(f"level floor below the ground z = 0, where nothing drives: {sunk:.3g} m^2, down to {lowest:.3g} m")

    def _storey(self, things: Sequence[Thing]) -> _Storey | None:
        """The wide level surface that carries most of the others; of several the one nearest to z = 0, where Gazebo lets robots begin."""
        spans = [self._span(thing) for thing in things]
        x_min, y_min, x_max, y_max = self._floor(things)
        least = SLAB_SHARE * (x_max - x_min - 2 * MARGIN) * (y_max - y_min - 2 * MARGIN)
        found, tiles = [], []
        for thing, (low, high) in zip(things, spans, strict=True):
            if min(high[:2] - low[:2]) < SHORTEST_SLAB:
                continue
            x_low, y_low, x_high, y_high = (round(float(v), 3) for v in (*low[:2], *high[:2]))
            extent = x_low, y_low, x_high, y_high
            for height, area in self._levels(thing):
                is_slab = high[2] <= height + LEVEL and low[2] >= height - THICKEST_SLAB
                tiles += [(thing, height, area, extent)] if is_slab else []
                has_walls = high[2] > height + LEVEL
                carries = _above(spans, height) - bool(low[2] + high[2] > 2 * height) >= SLAB_SHARE * (len(things) - 1)
                if area >= least and carries and (has_walls or (is_slab and len(things) > 1)):
                    found.append(_Storey((thing,), round(height, 4), (extent,), is_slab))
        for _, height, _, _ in tiles:
            laid = [tile for tile in tiles if abs(tile[1] - height) < SAME_LEVEL]
            extents = tuple(tile[3] for tile in laid)
            if len(things) > len(laid) > 1 and _over(spans, height, extents) >= OVER_TILES * (len(things) - len(laid)):
                found.append(_Storey(tuple(tile[0] for tile in laid), round(height, 4), extents, True))
        return min(found, key=lambda storey: (abs(storey.height), -storey.height), default=None)

    def _levels(self, thing: Thing) -> list[_Level]:
        """The level surfaces of a thing that look up."""
        if not isinstance(thing, Box | Mesh):
            return []
        vertices, faces = triangles(*self._solids((thing,)))
        corners = vertices[faces]
        doubled = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        is_level = doubled[:, 2] > np.cos(MOST_SLOPE) * np.linalg.norm(doubled, axis=1)
        heights, areas = corners[is_level, :, 2].mean(axis=1), doubled[is_level, 2] / 2
        order = np.argsort(heights)
        groups = np.split(order, np.flatnonzero(np.diff(heights[order]) > SAME_LEVEL) + 1)
        return [_Level(float(np.average(heights[g], weights=areas[g])), float(areas[g].sum())) for g in groups if len(g)]

    def _solids(self, things: Sequence[Thing]) -> list[Solid]:
        return solids(_with(BARE, things), self._folder)

    def _span(self, thing: Thing) -> tuple[Floats, Floats]:
        """Lowest and highest corner (3,) [m] of the box about a thing."""
        parts = still(self._solids((thing,)))
        return parts.low.min(axis=0), parts.high.max(axis=0)

    def _floor(self, things: Sequence[Thing]) -> tuple[float, float, float, float]:
        """The rectangle about everything; about the origin when there is nothing."""
        parts = still(self._solids(things))
        if len(parts.kinds) == 0:
            return BARE.floor
        low, high = parts.low[:, :2].min(axis=0) - MARGIN, parts.high[:, :2].max(axis=0) + MARGIN
        if np.prod(high - low) > LARGEST_FLOOR:
            middle = np.median((parts.low[:, :2] + parts.high[:, :2]) / 2, axis=0)
            low, high = np.maximum(low, middle - WIDEST / 2), np.minimum(high, middle + WIDEST / 2)
            self._notes.add(f"the drivable floor is cut to {WIDEST:g} m a side")
        x_min, y_min, x_max, y_max = (round(float(v), 2) for v in (*low, *high))
        return x_min, y_min, x_max, y_max


def _above(spans: Sequence[tuple[Floats, Floats]], height: float) -> int:
    """How many of the things, by their spans, have their middle above a height [m]."""
    return sum(bool(low[2] + high[2] > 2 * height) for low, high in spans)


def _over(spans: Sequence[tuple[Floats, Floats]], height: float, extents: Sequence[tuple[float, float, float, float]]) -> int:
    """How many of the things have their middle above a height [m] and over one of the rectangles x_min, y_min, x_max, y_max [m]."""
    x, y, z = np.mean(np.array(spans), axis=1).T
    within = [(x >= x_low) & (x <= x_high) & (y >= y_low) & (y <= y_high) for x_low, y_low, x_high, y_high in extents]
    return int(np.count_nonzero((z > height) & np.any(within, axis=0)))


def _with(world: WorldFile, things: Sequence[Thing]) -> WorldFile:
    return msgspec.structs.replace(
        world,
        boxes=[t for t in things if isinstance(t, Box)],
        cylinders=[t for t in things if isinstance(t, Cylinder)],
        spheres=[t for t in things if isinstance(t, Sphere)],
        meshes=[t for t in things if isinstance(t, Mesh)],
    )


def _looks_moved(world: WorldFile, up: float) -> WorldFile:
    looks = [msgspec.structs.replace(k, position=(*k.position[:2], k.position[2] + up)) for k in world.looks]
    return msgspec.structs.replace(world, looks=looks)


def _place(thing: Thing) -> tuple[float, float, float]:
    if isinstance(thing, Cylinder):
        return thing.base
    return thing.position if isinstance(thing, Mesh) else thing.centre


def _moved(thing: Thing, up: float) -> Thing:
    x, y, z = _place(thing)
    name = "base" if isinstance(thing, Cylinder) else "position" if isinstance(thing, Mesh) else "centre"
    return msgspec.structs.replace(thing, **{name: (x, y, z + up)})
