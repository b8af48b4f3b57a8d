"""The area to cover: an outline with holes as people draw them, made into valid polygons, or refused with the reason.

A ring is an (n, 2) array of corners (east, north) [m], either way round, with or without its first corner repeated at the end.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import MultiPolygon, Polygon
from shapely.validation import explain_validity

Floats = NDArray[np.float64]

FARTHEST = 1e7  # m from the origin: beyond that, degrees or millimetres were meant
LEAST_AREA = 1e-6  # m^2, and of the whole area: smaller parts are left out
MITRE = 5.0  # limit of sharp corners of an offset outline
MOST_CORNERS = 20_000


@dataclass(frozen=True)
class CoverageField:
    """Polygons that do not overlap, with holes [m, east and north]. ``notes``: what had to be repaired, one sentence each."""

    shape: MultiPolygon
    notes: tuple[str, ...] = ()

    @cached_property
    def area(self) -> float:
        """Area [m^2], without the holes."""
        return float(self.shape.area)

    @cached_property
    def parts(self) -> tuple[tuple[Floats, tuple[Floats, ...]], ...]:
        """Outline (n, 2) and holes (n, 2) [m] of each polygon, not closed; outlines anticlockwise, holes clockwise."""
        turned = [shapely.orient_polygons(part) for part in self.shape.geoms]
        return tuple((_open(part.exterior), tuple(_open(hole) for hole in part.interiors)) for part in turned)

    @property
    def rings(self) -> Iterator[Floats]:
        """Every outline and hole, (n, 2) [m] each, not closed."""
        for outline, holes in self.parts:
            yield outline
            yield from holes

    @property
    def hole_count(self) -> int:
        """Number of holes in all parts."""
        return sum(len(holes) for _, holes in self.parts)

    @cached_property
    def edges(self) -> Floats:
        """All edges (m, 4) [m]: x, y of the beginning and of the end; the inside lies to the left of each."""
        return np.concatenate([np.hstack((ring, np.roll(ring, -1, axis=0))) for ring in self.rings])

    def shrunk(self, by: float) -> "CoverageField | None":
        """What lies at least ``by`` [m] inside every border; corners stay corners. None where nothing is left."""
        inner = _polygons(self.shape.buffer(-by, join_style="mitre", mitre_limit=MITRE))
        return CoverageField(inner) if inner.area > LEAST_AREA else None


def make_field(outline: Floats, holes: Sequence[Floats] = ()) -> CoverageField:
    """The field within ``outline`` (n, 2) and outside of ``holes`` [m, east and north].

    Repeated corners are dropped. A ring that crosses itself stands for the areas that it encloses an odd number of times; holes may
    overlap, touch or cross the outline, or lie outside. Raises ValueError for what encloses no area, or is no ring.
    """
    notes: list[str] = []
    shape = _solid(outline, "outline", notes)
    whole = shape.area
    for number, hole in enumerate(holes):
        cut = _solid(hole, f"hole {number}", notes)
        if not shape.intersects(cut):
            notes.append(f"hole {number} lies outside of the outline and is left out")
            continue
        before = len(shape.geoms)
        shape = _polygons(shape.difference(cut))
        if len(shape.geoms) > before > 0:
            notes.append(f"hole {number} splits the field into {len(shape.geoms)} parts")
    kept = [part for part in shape.geoms if part.area > LEAST_AREA * max(1.0, whole)]
    if len(kept) < len(shape.geoms):
        notes.append(f"{len(shape.geoms) - len(kept)} parts without extent are left out")
    if not kept:
        raise ValueError("the holes leave nothing of the field; remove a hole or enlarge the outline")
    return CoverageField(MultiPolygon(kept), tuple(notes))


def join_fields(fields: Sequence[CoverageField]) -> CoverageField:
    """One field of several, which may overlap. Raises ValueError for none."""
    if not fields:
        raise ValueError("no field is given; give at least one")
    return CoverageField(
        _polygons(shapely.union_all([field.shape for field in fields])), tuple(note for field in fields for note in field.notes)
    )


def _solid(ring: Floats, what: str, notes: list[str]) -> MultiPolygon:
    corners = _corners(ring, what)
    polygon = Polygon(corners)
    if polygon.is_valid:
        return MultiPolygon([polygon])
    fault, _, place = explain_validity(polygon).partition("[")
    mended = _polygons(shapely.make_valid(polygon))
    if mended.area <= LEAST_AREA:
        raise ValueError(f"the {what} encloses no area: its {len(corners)} corners lie on a line; give corners of an area in m")
    where = f"{fault.lower()} at {', '.join(place.rstrip(']').split())} m"
    notes.append(f"{what}: {where}; the area that it encloses is taken, in {len(mended.geoms)} part(s)")
    return mended


def _corners(ring: Floats, what: str) -> Floats:
    """The corners without repetitions. Raises ValueError."""
    given = np.asarray(ring, dtype=np.float64)
    if given.ndim != 2 or given.shape[1] != 2:
        raise ValueError(f"the {what} has shape {given.shape}; give its corners as (n, 2): east and north in m")
    if len(given) > MOST_CORNERS:
        raise ValueError(f"the {what} has {len(given)} corners, {MOST_CORNERS} at most; simplify it")
    if not np.isfinite(given).all():
        first = int(np.flatnonzero(~np.isfinite(given).all(axis=1))[0])
        raise ValueError(f"corner {first} of the {what} is not a finite number; give east and north in m")
    if np.abs(given).max(initial=0.0) > FARTHEST:
        raise ValueError(f"a corner of the {what} lies more than {FARTHEST:g} m from the origin; give m in a local frame")
    corners = given[np.abs(given - np.roll(given, 1, axis=0)).max(axis=1) > 0.0] if len(given) else given
    different = len(np.unique(given, axis=0))
    if different < 3:
        raise ValueError(f"the {what} has {different} different corners; three at least enclose an area")
    spread: Floats = corners - corners[0]
    if np.linalg.svd(spread, compute_uv=False)[1] * np.abs(spread).max() < LEAST_AREA:
        raise ValueError(f"the {what} encloses no area: its {len(corners)} corners lie on a line; give corners of an area in m")
    return corners


def _polygons(shape: shapely.Geometry) -> MultiPolygon:
    """Only the polygons of whatever an operation has made."""
    parts = [part for part in shapely.get_parts(shape, return_index=False) if part.area > 0.0]
    flat = [polygon for part in parts for polygon in shapely.get_parts(part) if isinstance(polygon, Polygon)]
    return MultiPolygon(flat)


def _open(ring: shapely.LinearRing) -> Floats:
    coordinates: Floats = shapely.get_coordinates(ring)[:-1]
    return coordinates
