"""The service step by step, on messages."""

import numpy as np
import pytest

from launch import catalogue
from schemas.messages import LaserScan, MapRequest, NavStatus, PoseInFrame
from services.slam.elevation.build import build
from services.slam.elevation.elevation_service import ElevationParams, ElevationService
from tests.runtime.stepping import recall, stepped
from tests.services.slam.octree.test_octree_service import frame
from uvf.maths.rotations import from_euler
from uvf.models.scenario import ROOT, load_scenario
from uvf.models.vehicle.sensors import Lidar, Mount
from uvf.models.yaml_data import BadInput
from uvf.runtime.log.bounds import PAYLOAD_MOST
from uvf.runtime.messages.convert import planar_pose, stamp
from uvf.runtime.messages.frames import FrameBuffer
from uvf.runtime.messages.maps.height_grids import heights_message, heights_of
from uvf.runtime.messages.validation import error_in
from uvf.slam.elevation.elevation_map import LONGEST, MOST_COLUMNS

LIDAR = Lidar(Mount(), hz=5, beams=91, angle_min=-0.785, angle_increment=0.01745, range_min=0.1, range_max=30.0)
HEIGHT = 20.0  # m
MISSION = """about: A flight.
world: depot
duration: 10
vehicles:
  eye: {model: MODEL, system_id: 1, start: {x: 0.0, y: 0.0, z: 21.0, speed: 25.0}, params: PARAMS}
"""


def flight(times):
    """Eastwards with the lidar looking down, 10 m/s."""
    frames = FrameBuffer()
    for t in times:
        frames.add(frame(t, "world", "v/lidar", (10.0 * t, 0.0, HEIGHT), from_euler(0.0, np.pi / 2, 0.0)))
    return frames


def sweep(t, metres):
    return LaserScan(
        timestamp=stamp(t),
        frame_id="v/lidar",
        start_angle=-0.3,
        end_angle=0.3,
        ranges=[metres / np.cos(a) for a in np.linspace(-0.3, 0.3, 61)],
    )


def mapped(service):
    times = [0.0, 0.2, 0.4, 0.6]
    out = None
    for t in times:
        out = stepped(service, t, scan=[sweep(t, HEIGHT - (2.0 if t == 0.4 else 0.0))], frames=flight([0.0, 0.2, 0.4, 0.6, 0.8]))
    return out


@pytest.fixture
def service():
    return ElevationService(LIDAR, ElevationParams(map_period=0.1))


def test_sweeps_become_heights(service):
    grid = mapped(service)["heights"]
    top, ground = heights_of(grid)
    known = np.isfinite(ground)
    assert set(np.round(ground[known], 3).tolist()) == {0.0, 2.0} and np.array_equal(top[known], ground[known])
    assert grid.frame_id == "world" and grid.pose.position.y == pytest.approx(-6.25, abs=0.3)


def test_who_drives_below_is_no_ground_and_what_stands_there_beside_it_is(service):
    """The rover stands on the step of 2 m; nobody else knows that one is there."""
    rover = {"anne": PoseInFrame(pose=planar_pose(4.0, 2.0, 0.0))}, {"anne": NavStatus(radius=0.3)}
    for who, heights in ((rover, {0.0, 2.0}), (({}, {}), {0.0, 2.0})):
        one = ElevationService(LIDAR, ElevationParams(map_period=0.1))
        for t in (0.0, 0.2, 0.4, 0.6):
            team, nav = who
            seen = [sweep(t, HEIGHT - (2.0 if t == 0.4 else 0.0))]
            out = stepped(one, t, scan=seen, frames=flight([0.0, 0.2, 0.4, 0.6, 0.8]), team=team, team_nav=nav)
        grid = out["heights"]
        _, ground = heights_of(grid)
        assert set(np.round(ground[np.isfinite(ground)], 3).tolist()) == heights
        row, column = (int((c - o) / grid.cell_size.x) for c, o in ((2.0, grid.pose.position.y), (4.0, grid.pose.position.x)))
        assert np.isfinite(ground[row, column]) == (not team)


def test_the_map_of_an_area_is_given_to_who_asks(service):
    mapped(service)
    asked = [
        MapRequest(layer="heights", area=(3.5, -1.0, 4.5, 1.0)),
        MapRequest(area=(100.0, 100.0, 110.0, 110.0)),
        MapRequest(area=(1.0, 2.0)),
        MapRequest(layer="hights"),
    ]
    part, nothing, short, unknown = stepped(service, 0.8, frames=flight([0.8]), get=asked)["get"]
    assert part.accepted and np.nanmax(heights_of(part.grid)[1]) == 2.0 and part.grid.column_count == 4
    assert "nothing is mapped there yet" in nothing.reason
    assert "an area of 2 numbers" in short.reason
    assert unknown.reason == "no layer 'hights'; did you mean 'heights'?"


def test_scans_whose_place_is_not_known_are_told_once(service):
    said = [stepped(service, t, scan=[sweep(t, HEIGHT)], frames=FrameBuffer())["events"] for t in np.arange(0.0, 6.0, 0.2).tolist()]
    (event,) = [event for events in said for event in events]
    assert event.text == "scans cannot be mapped"


def test_another_instance_goes_on_with_the_map(service):
    grid = mapped(service)["heights"]
    other = ElevationService(LIDAR, ElevationParams(map_period=0.1))
    recall(other, heights=grid)
    (found,) = stepped(other, 1.0, frames=FrameBuffer(), get=[MapRequest()])["get"]
    assert found.grid.data == grid.data


@pytest.mark.parametrize(
    ("model", "params", "why"),
    [
        ("milvus", "{elevation: {}}", "fit a lidar that looks down"),
        ("milvus_mapper", "{elevation: {}}", "leave one of the two out"),
        ("milvus_surveyor", "{elevation: {resolution: 0.0}}", "resolution"),
    ],
)
def test_who_cannot_draw_one_is_refused(tmp_path, model, params, why):
    path = tmp_path / "flight.yaml"
    path.write_text(MISSION.replace("MODEL", model).replace("PARAMS", params))
    with pytest.raises(BadInput, match=why):
        build(load_scenario(path, ROOT))


def test_only_missions_with_a_vehicle_that_asks_for_it_have_the_process(tmp_path):
    path = tmp_path / "flight.yaml"
    for model, has in (("milvus_surveyor", True), ("milvus", False)):
        path.write_text(MISSION.replace("MODEL", model).replace("PARAMS", "{}"))
        assert ("elevation" in [kind.name for kind in catalogue.needed(load_scenario(path, ROOT))]) is has


@pytest.mark.parametrize("size", [(LONGEST, 4), (4, LONGEST), (1950, 2000)])
def test_the_largest_map_is_a_message_that_others_take_and_the_log_holds(size):
    message = heights_message(np.zeros(size, dtype=np.float32), np.zeros(size, dtype=np.float32), 0.25, (0.0, 0.0), 1.0)
    assert error_in(message) == "" and size[0] * size[1] <= MOST_COLUMNS
    assert message.ByteSize() <= PAYLOAD_MOST
