"""``uvf bench slam_live``: what it makes of the log of a run whose errors are known."""

import numpy as np
import pytest

from benchmarks.slam.live import mapping
from launch.apart import apart
from schemas import topics
from schemas.messages import FrameTransform, NavState, PoseInFrame, Vector3
from uvf.maths.se2 import Pose2, compose
from uvf.models.scenario import load_scenario
from uvf.models.world.geometry import section
from uvf.models.world.map_file import GridMap
from uvf.models.yaml_data import BadInput
from uvf.runtime.bus.interface import Sample
from uvf.runtime.messages.convert import occupancy_grid, planar_pose, stamp
from uvf.slam.maps.placing import centres, values_at
from uvf.slam.maps.quality import as_grid

SPEED, RATE = 0.5, 0.6  # m/s, rad/s: past half a turn on the way
WORLD_FROM_MAP = Pose2(2.2, 1.3, np.pi / 2)
CELL = 0.05  # m


def sample(topic, t, message):
    return Sample(topic.at(mapping.VEHICLE), message.DESCRIPTOR.full_name, message.SerializeToString(), round(t * 1e9), 1, 1)


def true(t):
    return SPEED * t, 1.0, RATE * t


def truth(t):
    x, y, yaw = true(t)
    pose = planar_pose(x, y, yaw)
    return sample(topics.TRUTH, t, NavState(timestamp=stamp(t), position=pose.position, orientation=pose.orientation))


def told(t, off=(0.0, 0.0, 0.0), late=0.0):
    x, y, yaw = np.array(true(t - late)) + off
    return sample(topics.POSE, t, PoseInFrame(timestamp=stamp(t), pose=planar_pose(x, y, yaw)))


def errors(poses, seconds=10.0):
    return mapping.Run([*(truth(t) for t in np.arange(0.0, seconds, 0.04)), *poses]).errors()


STAMPS = np.arange(0.02, 9.9, 0.05)
"""Not those of the truth."""


def test_poses_are_held_against_the_truth_of_their_own_time():
    row = errors(told(t) for t in STAMPS)
    assert row["RMSE m"] < 1e-6 and row["RMSE deg"] < 1e-4
    assert row["driven m"] == pytest.approx(SPEED * 9.96)
    late = errors(told(t, late=0.2) for t in STAMPS)
    assert late["RMSE m"] == pytest.approx(0.2 * SPEED) and late["RMSE deg"] == pytest.approx(np.degrees(0.2 * RATE))


def test_nothing_is_aligned_what_all_poses_are_off_by_is_the_error():
    row = errors(told(t, (0.03, -0.04, 0.02)) for t in STAMPS)
    assert row["RMSE m"] == pytest.approx(0.05) and row["max m"] == pytest.approx(0.05)
    assert row["RMSE deg"] == pytest.approx(np.degrees(0.02))
    one = errors(told(t, (0.5 * (k == 7), 0.0, 0.0)) for k, t in enumerate(STAMPS))
    assert one["max m"] == pytest.approx(0.5) and one["RMSE m"] == pytest.approx(0.5 / np.sqrt(len(STAMPS)))


def test_poses_of_times_of_which_the_truth_tells_nothing_do_not_count():
    assert errors([told(t) for t in STAMPS] + [told(15.0)])["max m"] < 1e-6


def test_a_log_without_poses_or_map_is_one_line():
    for ask in (mapping.Run.errors, mapping.Run.grid):
        with pytest.raises(BadInput, match="the log of the run holds no"):
            ask(mapping.Run([]))


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    return load_scenario(mapping.mission("house", tmp_path_factory.mktemp("mission")))


@pytest.fixture(scope="module")
def plan(site):
    return as_grid(section(site.world, mapping.PLAN_CELL, mapping.lidar_height(site)))


def figures(site, cells, origin, world_from_map=WORLD_FROM_MAP):
    """Of a map (rows, columns) whose corner is at origin in the map frame, told to lie at ``world_from_map``."""
    placed = FrameTransform(timestamp=stamp(1.0), parent_frame_id="world", child_frame_id="rover/map")
    placed.translation.CopyFrom(Vector3(x=world_from_map.x, y=world_from_map.y))
    placed.rotation.CopyFrom(planar_pose(*world_from_map).orientation)
    older = occupancy_grid(np.zeros((3, 3), dtype=np.int8), CELL, 0.0, 0.0, "rover/map", 1.0)
    grid = occupancy_grid(cells, CELL, origin.x, origin.y, "rover/map", 2.0)
    log = [sample(topics.TF_WORLD, 1.0, placed), sample(topics.MAP, 1.0, older), sample(topics.MAP, 2.0, grid)]
    return mapping.Run(log).of_map(site)


@pytest.fixture(scope="module")
def drawn(plan):
    """(cells, origin) of the true map, along axes that are turned against those of the world."""
    empty = GridMap(np.zeros((300, 300), dtype=np.int8), CELL, Pose2(-3.0, -13.0, 0.0))
    in_world = GridMap(empty.cells, CELL, compose(WORLD_FROM_MAP, empty.origin))
    return values_at(plan, centres(in_world)).reshape(empty.cells.shape), empty.origin


def test_the_true_map_has_all_walls_and_all_floor(site, drawn):
    row = figures(site, *drawn)
    assert row["F1 5 cm"] > 0.98 and row["F1 10 cm"] > 0.99
    assert row["walls off 95 % m"] < 0.05 and row["floor %"] > 99.0


def test_a_map_that_lies_beside_where_it_is_told_to_has_its_walls_off(site, drawn):
    aside = Pose2(WORLD_FROM_MAP.x + 0.08, WORLD_FROM_MAP.y + 0.08, WORLD_FROM_MAP.yaw)
    row, right = figures(site, *drawn, aside), figures(site, *drawn)
    assert row["F1 5 cm"] < 0.5 < 0.8 < row["F1 10 cm"] and row["walls off 95 % m"] > right["walls off 95 % m"] + 0.03


def test_walls_that_are_not_there_and_walls_that_are_not_seen_cost(site, drawn):
    cells, origin = drawn
    right = figures(site, cells, origin)
    seen = cells.copy()
    seen[:150] = -1
    half = figures(site, seen, origin)
    assert 20.0 < half["floor %"] < 80.0
    false = cells.copy()
    false[::20][false[::20] == 0] = 100
    wrong = figures(site, false, origin)
    assert wrong["F1 10 cm"] < right["F1 10 cm"] - 0.1


def test_a_mission_that_cannot_run_is_one_line(tmp_path):
    with pytest.raises(BadInput, match=r"'uvf up' does not begin to run: .*no_such") as refused, apart(tmp_path / "no_such.yaml", tmp_path):
        pass
    assert "\n" not in str(refused.value)
