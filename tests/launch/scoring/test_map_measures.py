"""Maps that are right, shifted and missing, against the figures that measures give them."""

import numpy as np
import pytest

from launch.scoring.scores import Scorer
from schemas import topics
from schemas.messages import Grid
from uvf.models.scenario import ROOT, load_scenario
from uvf.models.world.geometry import floor_plan
from uvf.runtime.bus.interface import Sample
from uvf.runtime.messages.convert import occupancy_grid, planar_pose
from uvf.runtime.messages.maps.height_grids import heights_message

INDOORS = load_scenario(ROOT / "missions" / "demo.yaml")
OUTDOORS = load_scenario(ROOT / "missions" / "air_ground.yaml")
SIDE = 0.25


def measured(site, owner, measure, topic=None, message=None):
    scorer = Scorer(site)
    if topic is not None:
        scorer.heard(Sample(topic.at(owner), message.DESCRIPTOR.full_name, message.SerializeToString(), 10**9, 1, 0))
    return scorer.measure(owner, measure)


def shifted_map(shift):
    """The world's own floor plan as the map of the demo's rover, ``shift`` [m] too far to the east."""
    start = INDOORS.members["burger"].entry.start
    plan = floor_plan(INDOORS.world, 0.05)
    grid = occupancy_grid(np.where(plan.cells, 100, 0).astype(np.int8), 0.05, 0.0, 0.0, "burger/map", 1.0)
    c, s = np.cos(start.yaw), np.sin(start.yaw)
    x, y = plan.x + shift - start.x, plan.y - start.y
    grid.pose.CopyFrom(planar_pose(c * x + s * y, c * y - s * x, -start.yaw))
    return grid


def test_walls_are_counted_where_they_stand_in_the_world():
    right = measured(INDOORS, "burger", "map_f1", topics.MAP, shifted_map(0.0))
    assert right.value > 0.99 and right.note.startswith(("0.9", "1.0"))
    assert measured(INDOORS, "burger", "map_f1", topics.MAP, shifted_map(0.5)).value < 0.75
    assert measured(INDOORS, "burger", "map_f1").value == 0.0


def strip(lift):
    """Heights along a strip over the roof of the depot's first container, 2.6 m high, at y = -12 m; the mound beside it is left out."""
    columns = round(10.0 / SIDE)
    top = np.full((4, columns), 2.6 + lift, dtype=np.float32)
    top[0, ::2] = np.nan
    return heights_message(top, top, SIDE, (-33.0, -12.5), 1.0)


@pytest.mark.parametrize("lift", [0.0, 0.3, -0.2])
def test_heights_are_held_against_the_surface_of_the_world(lift):
    told = measured(OUTDOORS, "eye", "height_error", topics.HEIGHTS, strip(lift))
    assert told.value == pytest.approx(abs(lift), abs=1e-3) and told.note == f"median {abs(lift):.2f} m of 140 columns"


def test_heights_beyond_the_floor_do_not_count():
    far = heights_message(np.zeros((4, 4), dtype=np.float32), np.zeros((4, 4), dtype=np.float32), SIDE, (200.0, 0.0), 1.0)
    assert measured(OUTDOORS, "eye", "height_error", topics.HEIGHTS, far).note == "no column of it lies on the world's floor"
    assert measured(OUTDOORS, "eye", "height_error").value == np.inf


def test_a_map_that_is_none_has_a_figure_and_a_reason():
    nonsense = Grid(column_count=3, data=b"x")
    assert measured(OUTDOORS, "eye", "height_error", topics.HEIGHTS, nonsense).note.startswith("a grid of 3 columns")
    assert measured(INDOORS, "burger", "map_f1", topics.MAP, nonsense).note.startswith("a grid of 3 columns")
