"""Floor plans of rooms with solid things in them, made by hand."""

import numpy as np

from uvf.models.world.geometry import FloorPlan

FINE = 0.02  # m
ROOM = ((0.0, 0.0, 8.0, 6.0),)
PILLAR = (3.0, 2.0, 3.6, 2.6)


def plan(solids=(PILLAR,), size=(9.0, 7.0), corner=(-0.5, -0.5), rooms=ROOM):
    """Solid but for its rooms, each (x, y, x, y) [m]."""
    rows, columns = round(size[1] / FINE), round(size[0] / FINE)
    x = corner[0] + (np.arange(columns) + 0.5) * FINE
    y = corner[1] + (np.arange(rows) + 0.5) * FINE

    def inside(box):
        return np.outer((y > box[1]) & (y < box[3]), (x > box[0]) & (x < box[2]))

    free = np.logical_or.reduce([inside(room) for room in rooms])
    for solid in solids:
        free &= ~inside(solid)
    return FloorPlan(~free, FINE, *corner)
