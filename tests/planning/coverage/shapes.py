"""Fields of the tests, and what of them is covered, counted on a raster."""

import numpy as np
import shapely

from uvf.planning.coverage.field import make_field

SQUARE = np.array([[0.0, 0.0], [300.0, 0.0], [300.0, 200.0], [0.0, 200.0]])
HOLE = np.array([[100.0, 60.0], [160.0, 60.0], [160.0, 130.0], [100.0, 130.0]])


def comb(rng, teeth=5):
    """A comb with teeth of random lengths and slanted tips, turned by a random angle."""
    tops = rng.uniform(60.0, 260.0, 2 * teeth)
    corners = [(0.0, 0.0), (60.0 * teeth, 0.0)]
    for k in reversed(range(teeth)):
        corners += [(60.0 * k + 45.0, tops[2 * k]), (60.0 * k + 5.0, tops[2 * k + 1]), (60.0 * k, 40.0)]
    angle = rng.uniform(0.0, 2 * np.pi)
    c, s = np.cos(angle), np.sin(angle)
    return make_field(np.array(corners) @ np.array(((c, s), (-s, c))))


def raster_share(field, swaths, width, step=1.0):
    """Share of the points of a raster in the field that lie in the rectangle of some swath."""
    x0, y0, x1, y1 = field.shape.bounds
    grid = np.stack(np.meshgrid(np.arange(x0, x1, step) + step / 2, np.arange(y0, y1, step) + step / 2), axis=-1).reshape(-1, 2)
    points = grid[shapely.contains_xy(field.shape, *grid.T)]
    covered = np.zeros(len(points), dtype=bool)
    for swath in swaths:
        away = swath[2:] - swath[:2]
        length = np.hypot(*away)
        ahead = (points - swath[:2]) @ away / length
        aside = (points - swath[:2]) @ (-away[1], away[0]) / length
        covered |= (ahead >= -1e-6) & (ahead <= length + 1e-6) & (np.abs(aside) <= width / 2 + 1e-6)
    return covered.mean()
