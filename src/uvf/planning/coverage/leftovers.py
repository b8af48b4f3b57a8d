"""What passes along the borders and swaths inside them leave out: corners and spikes narrower than the tool, and swaths along these."""

import math

import numpy as np
import shapely
from numpy.typing import NDArray

from uvf.planning.coverage.field import CoverageField, make_field
from uvf.planning.coverage.strips import StripRules, rotated, swaths

Floats = NDArray[np.float64]

INSIDE = 1e-6  # m, by which a swath may cut a border
SHORTEST = 1e-3  # m, of a swath
SHIFTS = 5  # places of a swath across a piece narrower than the tool


def cut_off(lines: Floats, field: CoverageField) -> Floats:
    """What of swaths (n, 4) [m] lies inside ``field``, piece by piece."""
    pieces = shapely.get_parts(shapely.intersection(shapely.linestrings(lines.reshape(-1, 2, 2)), field.shape.buffer(INSIDE)))
    found: Floats = shapely.get_coordinates([piece for piece in pieces if piece.length > SHORTEST]).reshape(-1, 4)
    return found


def leftover_swaths(field: CoverageField, swept: shapely.Geometry, width: float, allowed: float) -> Floats:
    """Swaths (n, 4) [m] along what of ``field`` is not ``swept``, the largest pieces first, until at most ``allowed`` [m^2] is left out."""
    left = field.shape.difference(swept)
    pieces = sorted((piece for piece in shapely.get_parts(left) if piece.area > 0.0), key=lambda piece: -piece.area)
    missing, found = float(left.area), [np.empty((0, 4))]
    for piece in pieces:
        if missing <= allowed:
            break
        found.append(_along(piece, field, width))
        missing -= float(piece.area)
    return np.concatenate(found)


def _along(piece: shapely.Polygon, field: CoverageField, width: float) -> Floats:
    """Swaths along the longer side of the smallest rectangle about a piece."""
    corners = shapely.get_coordinates(shapely.minimum_rotated_rectangle(piece))
    sides = np.diff(corners, axis=0)
    away = sides[int(np.argmax(np.hypot(*sides.T)))]
    direction = math.atan2(away[1], away[0])
    edges = make_field(shapely.get_coordinates(piece.exterior)).edges
    across = rotated(edges, -direction)[:, 1::2]
    lines = swaths(edges, direction, StripRules(width, width))
    slack = max((width - float(np.ptp(across))) / 2, 0.0)
    reach = min(slack, float(np.ptp(across)) / 2)
    shifts = np.linspace(-reach, reach, SHIFTS)[:, None] * np.tile((-math.sin(direction), math.cos(direction)), 2)
    tried = [cut_off(lines + shift, field) for shift in shifts]
    return max(tried, key=lambda each: float(np.hypot(*(each[:, 2:] - each[:, :2]).T).sum()))
