"""The floor plan against the physics engine: what is occupied in one is so in the other."""

import numpy as np
import pytest
from scipy import ndimage

from services.sim_ground.engine import PhysicsEngine
from uvf.maths.rotations import IDENTITY
from uvf.maths.solids import joined
from uvf.models.scenario import ROOT
from uvf.models.shapes.scene import primitives
from uvf.models.shapes.solid import Solid
from uvf.models.world.drivable import drivable
from uvf.models.world.file import load_world
from uvf.models.world.geometry import floor_plan, solids
from uvf.models.world.terrain import relief

CELL, TOP, CLOSE = 0.05, 0.2, 2e-3  # m
LOW = 2e-3  # m, of a probe above the ground
PLACES = 400


class Probe:
    """Boxes put into a world's engine, on level ground."""

    def __init__(self, parts, side):
        self.engine = PhysicsEngine(100.0)
        self.things = [(self.engine.add(part, part.position, part.orientation), primitives(part)) for part in parts]
        box = Solid("probe", "box", (side, side, TOP - 2 * LOW), np.zeros(3))
        self.index = self.engine.add(box, np.array((0.0, 0.0, 100.0)), IDENTITY, 1.0)

    def meets(self, x, y):
        self.engine.place(self.index, np.array((x, y, TOP / 2)), IDENTITY)
        return any(self._is_near(each, x, y) and self.engine.near(self.index, index, 0.0) for index, each in self.things)

    @staticmethod
    def _is_near(part, x, y):
        low, high = part.low.min(axis=0) - 0.1, part.high.max(axis=0) + 0.1
        return low[0] < x < high[0] and low[1] < y < high[1]


@pytest.mark.parametrize("name", ["house", "watkins", "plaza", "world"])
def test_cells_are_occupied_where_the_engine_meets_something(name):
    """A probe a little smaller than a free cell meets nothing, and one a little larger than an occupied cell does."""
    world = load_world(ROOT / "worlds", name)
    plan, parts = floor_plan(world, CELL, TOP), [part for part in solids(world) if part.path is None]
    ground = drivable(joined([primitives(part) for part in parts]), *plan.axes(), relief(world))
    rng, (xs, ys) = np.random.default_rng(4), plan.axes()
    edges = np.argwhere(ndimage.binary_dilation(plan.cells, iterations=2))
    picked = [*rng.choice(edges, PLACES), *rng.integers((0, 0), plan.cells.shape, (PLACES, 2))]
    smaller, larger = Probe(parts, CELL - CLOSE), Probe(parts, CELL + CLOSE)
    wrong, seen = [], 0
    for r, c in picked:
        if ground.height[r, c] <= 0.0:
            probe, seen = (larger if plan.cells[r, c] else smaller), seen + 1
            if probe.meets(xs[c], ys[r]) != plan.cells[r, c]:
                wrong.append((float(xs[c]), float(ys[r]), bool(plan.cells[r, c])))
    smaller.engine.close()
    larger.engine.close()
    assert seen > PLACES
    assert len(wrong) <= 1e-3 * seen, wrong
