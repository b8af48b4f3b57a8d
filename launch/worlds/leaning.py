"""Remarks on boxes that lean: ramps too steep to drive on, and angles that look like degrees."""

from collections.abc import Iterator

import numpy as np

from uvf.maths.rotations import from_euler, matrix
from uvf.models.world.drivable import STEEPEST
from uvf.models.world.file import Box, WorldFile
from uvf.models.world.geometry import ramp_box

ROUNDING = 1e-3  # rad
UPRIGHT = np.radians(50.0)  # from where on a slab is a board that leans, and no ramp


def notes(world: WorldFile) -> Iterator[str]:
    """Yields what looks odd about the angles of a world's boxes but may be meant so, a line each."""
    for box in (*world.boxes, *map(ramp_box, world.ramps)):
        yield from _in_degrees(box)
        slope = _slope(box)
        if STEEPEST + ROUNDING < slope < UPRIGHT:
            yield f"{box.name}: {np.degrees(slope):.3g} deg, steeper than the {np.degrees(STEEPEST):g} deg that a rover drives"


def _in_degrees(box: Box) -> Iterator[str]:
    for name, angle in zip(("roll", "pitch"), box.rpy[:2], strict=True):
        if angle and angle == round(angle):
            meant = f"{angle:g} deg = {np.radians(angle):.4g}"
            yield f"{box.name}: {name} {angle:g} is in radians ({np.degrees(angle):.0f} deg); if degrees are meant: {meant}"


def _slope(box: Box) -> float:
    """Angle [rad] of the upper face of a slab against the floor; 0 of a box that does not lie on a largest face."""
    vertical = np.abs(matrix(from_euler(*box.rpy))[2])
    up = int(np.argmax(vertical))
    return float(np.arccos(min(vertical[up], 1.0))) if box.size[up] == min(box.size) else 0.0
