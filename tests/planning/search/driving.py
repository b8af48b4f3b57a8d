"""Ground for paths that are driven, and an independent look at them: outlines laid on the grid, turns taken from points."""

import numpy as np
from shapely import contains_xy
from shapely.affinity import rotate, translate
from shapely.geometry import Polygon

from uvf.planning.costmap.costmap import make_costmap
from uvf.planning.costmap.footprint import RobotFootprint
from uvf.planning.costmap.inflation import Inflation

SIDE = 0.1  # m
INFLATION = Inflation(0.6, 4.0)
CAR = RobotFootprint.polygon(np.array(((0.55, 0.25), (0.55, -0.25), (-0.2, -0.25), (-0.2, 0.25))))


def costmap(cells, footprint=CAR, origin=(0.0, 0.0)):
    """The costmap of cells of 0.1 m."""
    return make_costmap(np.asarray(cells, dtype=np.int8), (SIDE, origin), footprint, INFLATION)


def blocks(seed, count=22):
    """(120, 200) cells with boxes that leave the corners free."""
    rng, cells = np.random.default_rng(seed), np.zeros((120, 200), dtype=np.int8)
    for _ in range(count):
        row, column, height, width = *rng.integers((0, 0), (120, 200)), *rng.integers(4, 20, 2)
        cells[row : row + height, column : column + width] = 100
    cells[:30, :30] = cells[-30:, -30:] = 0
    return cells


def filled_in(path, parts):
    """(m, 3) poses on the arcs that join a path's poses (n, 3), ``parts`` to each."""
    turn = np.mod(np.diff(path[:, 2]) + np.pi, 2 * np.pi) - np.pi
    step = np.diff(path[:, :2], axis=0)
    out = [path[:1]]
    for k, share in enumerate(turn):
        along = np.arange(1, parts + 1) / parts
        # A chord of an arc: its direction is the heading in the middle, its length grows with the sine of half the turn.
        angle = path[k, 2] + share * along
        size = np.sin(0.5 * share * along) / np.sin(0.5 * share) if abs(share) > 1e-9 else along
        bend = 0.5 * share * (along - 1.0)
        x = path[k, 0] + size * (np.cos(bend) * step[k, 0] - np.sin(bend) * step[k, 1])
        y = path[k, 1] + size * (np.sin(bend) * step[k, 0] + np.cos(bend) * step[k, 1])
        out.append(np.column_stack((x, y, angle)))
    return np.vstack(out)


def covered(costs, path, grown=0.0):
    """How many poses (n, 3) have the centre of an occupied cell under the outline grown by so many metres, or lie outside the map."""
    outline = Polygon(costs.footprint.outline).buffer(grown, join_style="mitre") if grown else Polygon(costs.footprint.outline)
    hit = 0
    rows, columns = costs.values.shape
    for x, y, yaw in path:
        placed = translate(rotate(outline, yaw, origin=(0, 0), use_radians=True), x, y)
        x0, y0, x1, y1 = ((value - costs.origin[i % 2]) / costs.resolution for i, value in enumerate(placed.bounds))
        at = costs.cell(x, y)
        near = slice(max(int(y0) - 1, 0), int(y1) + 2), slice(max(int(x0) - 1, 0), int(x1) + 2)
        points = costs.points(np.argwhere(costs.values[near] == 254) + np.array([part.start for part in near]))
        hit += not (0 <= at[0] < rows and 0 <= at[1] < columns) or bool(contains_xy(placed, points).any())
    return hit


def check_turns(path, direction, radius):
    """Each step is an arc that begins in the heading of its first pose and is no tighter than allowed, driven as ``direction`` says."""
    step, turn = np.diff(path[:, :2], axis=0), np.mod(np.diff(path[:, 2]) + np.pi, 2 * np.pi) - np.pi
    chord, middle = np.hypot(*step.T), path[:-1, 2] + 0.5 * turn
    assert (np.abs(turn) <= 2.0 * np.arcsin(np.minimum(chord / (2.0 * radius), 1.0)) * (1 + 1e-3) + 1e-6).all()
    moving = chord > 1e-3 * radius
    ahead = (step * np.column_stack((np.cos(middle), np.sin(middle)))).sum(axis=1) / np.maximum(chord, 1e-12)
    np.testing.assert_allclose(ahead[moving], direction[1:][moving], atol=1e-3)
