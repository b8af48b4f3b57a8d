"""The share of its floor that a vehicle has mapped."""

from pathlib import Path

import numpy as np
import pytest

from uvf.models.scenario import ROOT, load_scenario
from uvf.models.world.geometry import floor_plan, reachable_floor
from uvf.runtime.messages.convert import occupancy_grid
from uvf.runtime.messages.maps.mapped_floor import MappedFloor


@pytest.fixture(scope="module")
def site():
    return load_scenario(Path(ROOT / "missions/demo.yaml"))


def test_a_map_that_is_free_west_of_a_line_counts_the_reachable_floor_there(site):
    member = site.members["burger"]
    start = member.entry.start
    x, y = np.meshgrid(-20.0 + 0.05 * (np.arange(800) + 0.5), -20.0 + 0.05 * (np.arange(800) + 0.5))
    world_x = start.x + x * np.cos(start.yaw) - y * np.sin(start.yaw)
    grid = occupancy_grid(np.where(world_x < 4.0, 0, -1).astype(np.int8), 0.05, -20.0, -20.0, "burger/map", 0.0)
    plan = floor_plan(site.world, 0.05)
    west = plan.centres()[0][reachable_floor(plan, start.x, start.y, member.file.ground.radius)] < 4.0  # it is nearly round
    assert MappedFloor(site.world, member).share(grid) == pytest.approx(west.mean(), abs=0.01)
    assert 0.1 < west.mean() < 0.9
