"""What passes along the borders and swaths inside them leave out: corners and spikes narrower than the tool, and swaths along these."""

import math
from collections.abc import Iterator

import numpy as np
import shapely
from numpy.typing import NDArray

from uvf.planning.coverage.field import CoverageField
from uvf.planning.coverage.strips import StripRules, rotated, swaths

Floats = NDArray[np.float64]

INSIDE = 1e-6  # m, by which a swath may cut a border
SHORTEST = 1e-3  # m, of a swath
ROUNDS, WORTH = 4, 0.05  # WORTH: part of what is left that a round must reach
LEAST = 1e-9  # m^2, of a piece
SHIFTS = 5  # places of a swath across a piece narrower than the tool


def cut_off(lines: Floats, field: CoverageField) -> Floats:
    """What of swaths (n, 4) [m] lies inside ``field``, piece by piece."""
    pieces = shapely.get_parts(shapely.intersection(shapely.linestrings(lines.reshape(-1, 2, 2)), field.shape.buffer(INSIDE)))
    found: Floats = shapely.get_coordinates([piece for piece in pieces if piece.length > SHORTEST]).reshape(-1, 4)
    return found


def leftover_swaths(field: CoverageField, swept: shapely.Geometry, width: float, allowed: float) -> Floats:
    """Swaths (n, 4) [m] along what of ``field`` is not ``swept``, the largest pieces first, until at most ``allowed`` [m^2] is left out.

    What their square ends leave out before a slanted border is gone along in turn, as far as that helps.
    """
    found = [np.empty((0, 4))]
    for _ in range(ROUNDS):
        left = field.shape.difference(swept)
        if left.area <= allowed:
            break
        lines = np.concatenate([np.empty((0, 4)), *_along_pieces(left, field, width, left.area - allowed)])
        swept = swept.union(swept_by(lines, width))
        if left.area - field.shape.difference(swept).area < WORTH * left.area:
            break
        found.append(lines)
    return np.concatenate(found)


def _along_pieces(left: shapely.Geometry, field: CoverageField, width: float, wanted: float) -> Iterator[Floats]:
    """Swaths along the largest pieces of what is left, until they make up the area ``wanted`` [m^2]."""
    for piece in sorted((piece for piece in shapely.get_parts(left) if piece.area > LEAST), key=lambda piece: -piece.area):
        if wanted <= 0.0:
            break
        yield _along(piece, field, width)
        wanted -= float(piece.area)


def _along(piece: shapely.Polygon, field: CoverageField, width: float) -> Floats:
    """Swaths along the longer side of the smallest rectangle about a piece."""
    corners = shapely.get_coordinates(shapely.minimum_rotated_rectangle(piece))
    sides = np.diff(corners, axis=0)
    away = sides[int(np.argmax(np.hypot(*sides.T)))]
    direction = math.atan2(away[1], away[0])
    outline = shapely.get_coordinates(shapely.orient_polygons(piece).exterior)[:-1]
    edges = np.hstack((outline, np.roll(outline, -1, axis=0)))
    across = rotated(edges, -direction)[:, 1::2]
    lines = swaths(edges, direction, StripRules(width, width))
    slack = max((width - float(np.ptp(across))) / 2, 0.0)
    reach = min(slack, float(np.ptp(across)) / 2)
    shifts = np.linspace(-reach, reach, SHIFTS)[:, None] * np.tile((-math.sin(direction), math.cos(direction)), 2)
    tried = [cut_off(lines + shift, field) for shift in shifts]
    return max(tried, key=lambda each: float(piece.intersection(swept_by(each, width)).area))


def swept_by(lines: Floats, width: float) -> shapely.Geometry:
    """What a tool ``width`` [m] wide sweeps along swaths (n, 4) [m], with square ends."""
    return shapely.union_all(shapely.buffer(shapely.linestrings(lines.reshape(-1, 2, 2)), width / 2, cap_style="flat"))
