"""What a vehicle believes is drawn where it is: costs, frames, certainty, particles, what moves, and an octree."""

import io

import numpy as np
import pytest
from PIL import Image

from schemas.messages import (
    Detection,
    Detections,
    EstimateQuality,
    FrameTransform,
    FrameTransforms,
    MapFix,
    MovingObstacle,
    MovingObstacles,
    OctreeMap,
    PosesInFrame,
    Quaternion,
    Vector3,
)
from services.gcs.actions.page import Layer
from services.gcs.state.session import ROOTS, SHOWN_AT_FIRST
from services.gcs.view.drawing import Axes, Boxes, FloorPicture, Polyline
from services.gcs.view.scene.estimates import covariance_of, ellipse
from services.gcs.view.scene.frames import fixed_frames
from services.gcs.view.scene.map_layers import MAP_PERIOD
from services.gcs.view.scene.obstacles import AHEAD, predicted
from services.gcs.view.scene.octree_boxes import MOST, octree_boxes
from services.slam.octree.octree_messages import octree_message
from tests.services.gcs.fakes import ME, Station
from tests.services.gcs.scripted import UAV, UGV
from uvf.maths.rotations import from_euler
from uvf.runtime.messages.convert import cost_grid, planar_pose, quaternion
from uvf.slam.octree.octree import Octree

TURNED = FrameTransform(
    parent_frame_id="world", child_frame_id="v/map", translation=Vector3(x=2, y=1), rotation=quaternion(from_euler(0.0, 0.0, np.pi / 2))
)


@pytest.fixture
def station():
    station = Station()
    station.run(2.0)
    for layer in ROOTS:
        station.press(Layer(ME, layer, True))
    return station


def hear(station, vehicle=UGV, **messages):
    """Without the bus, whose table of topics has rates at which these would have to come."""
    for what, message in messages.items():
        station.model.hear(station.t, what, {vehicle: message})
    station.run(MAP_PERIOD + 0.1)
    return station.page.now.nodes


def test_the_layers_that_few_want_are_off_at_first():
    assert {"Obstacles", "Uncertainty"} <= SHOWN_AT_FIRST
    assert not {"Costmaps", "Octree", "Frames", "True pose", "Team maps"} & SHOWN_AT_FIRST


def test_costs_lie_where_they_are_and_free_ground_is_seen_through(station):
    values = np.zeros((64, 64), dtype=np.uint8)
    values[:, :32], values[10, 40], values[20, 50] = 255, 254, 120
    picture = hear(station, local_costs=cost_grid(values, 0.05, 1.0, 2.0, "world", 1.0))[f"/costs/{UGV}"]
    assert isinstance(picture, FloorPicture)
    assert (picture.width, picture.height) == pytest.approx((1.6, 3.2)) and picture.centre[:2] == pytest.approx((3.4, 3.6))
    image = np.array(Image.open(io.BytesIO(picture.png)).convert("RGBA"))
    assert image[0, 0, 3] == 0 and image[10, 8, 3] > image[20, 18, 3] > 0
    assert image[10, 8, 0] > 200 and image[10, 8, 1] > 200 > image[20, 18, 1]


def test_an_ellipse_holds_95_per_cent(station):
    rng = np.random.default_rng(3)
    covariance = np.array(((0.04, 0.03), (0.03, 0.09)))
    edge = ellipse(covariance, 0.0).points[:, :2]
    drawn = rng.multivariate_normal((0, 0), covariance, 20_000)
    inverse = np.linalg.inv(covariance)
    limit = float(np.einsum("i,ij,j", edge[0], inverse, edge[0]))
    assert np.einsum("ni,ij,nj->n", edge, inverse, edge) == pytest.approx(limit)
    assert (np.einsum("ni,ij,nj->n", drawn, inverse, drawn) < limit).mean() == pytest.approx(0.95, abs=0.01)


def test_certainty_is_turned_with_the_map():
    fix = MapFix(covariance=[0.04, 0, 0, 0, 0.01, 0, 0, 0, 0.1])
    assert covariance_of(fix, None, TURNED) == pytest.approx(np.diag((0.01, 0.04)))
    flying = EstimateQuality(position_known=True, position_sigma=2.0)
    assert covariance_of(None, flying, None) == pytest.approx(np.diag((4.0, 4.0)))
    assert covariance_of(None, EstimateQuality(position_sigma=2.0), None) is None


@pytest.mark.parametrize(
    "covariance", ([float("nan")] * 9, [1.0] * 4, [-1.0, 0, 0, 0, -1.0, 0, 0, 0, 0], [1e12, 0, 0, 0, 1e12, 0, 0, 0, 0])
)
def test_a_covariance_that_is_none_is_not_drawn(station, covariance):
    assert f"/sigma/{UGV}/edge" not in hear(station, fix=MapFix(covariance=covariance))


def test_certainty_moves_with_the_vehicle_without_being_sent_again(station):
    nodes = hear(station, fix=MapFix(covariance=[0.04, 0, 0, 0, 0.01, 0, 0, 0, 0.1]))
    first, at = nodes[f"/sigma/{UGV}/edge"], station.page.now.places[f"/sigma/{UGV}"].position
    station.run(2.0)
    assert station.page.now.nodes[f"/sigma/{UGV}/edge"] is first
    assert np.linalg.norm(station.page.now.places[f"/sigma/{UGV}"].position - at) > 0.05


def test_particles_lie_in_the_world(station):
    told = PosesInFrame(frame_id="v/map", poses=[planar_pose(1.0, 0.0, 0.0), planar_pose(0.0, 1.0, 0.0)])
    cloud = hear(station, world_from_map=TURNED, particles=told)[f"/particles/{UGV}"]
    assert cloud.points[:, :2] == pytest.approx(np.array(((2.0, 2.0), (1.0, 1.0))))


def test_what_moves_is_drawn_with_where_it_will_be_and_goes_when_nobody_tells_of_it(station):
    walker = MovingObstacle(position=Vector3(x=1, y=2), velocity=Vector3(x=0.5), radius=0.3)
    line = predicted(walker, 0.1)
    assert line.points[:, 0].min() == pytest.approx(0.7) and line.points[:, 0].max() == pytest.approx(1.3 + 0.5 * AHEAD)
    assert isinstance(hear(station, obstacles=MovingObstacles(obstacles=[walker]))[f"/moving/{UGV}/0"], Polyline)
    station.run(2.0)
    assert f"/moving/{UGV}/0" not in station.page.now.nodes


def test_markers_found_are_ringed_and_named_until_there_are_others(station):
    found = Detection(id=3, position=Vector3(x=1, y=2, z=0.5), sigma=0.8, views=4)
    nodes = hear(station, detections=Detections(detections=[found]))
    ring = nodes[f"/marker/{UGV}/3"]
    assert ring.points[:, 0].max() == pytest.approx(1.8) and ring.points[:, 2] == pytest.approx(0.5)
    assert nodes[f"/marker/{UGV}/3/name"].text == f"{UGV} 3"
    assert f"/marker/{UGV}/3" not in hear(station, detections=Detections())


def transform(parent, child, x):
    return FrameTransform(parent_frame_id=f"v/{parent}", child_frame_id=f"v/{child}", translation=Vector3(x=x), rotation=Quaternion(w=1))


def test_frames_hang_on_each_other_in_whatever_order_they_are_told(station):
    told = FrameTransforms(
        transforms=[transform("lidar_base", "lidar", 0.5), transform("base_link", "lidar_base", 0.2), transform("x", "y", 9.0)]
    )
    found = fixed_frames(told, "base_link", 0.15)
    assert {name: axes.position[0] for name, axes in found.items()} == pytest.approx({"base_link": 0.0, "lidar_base": 0.2, "lidar": 0.7})
    nodes = hear(station, tf_static=told, world_from_map=TURNED)
    assert isinstance(nodes[f"/frame/{UGV}/body/lidar"], Axes) and nodes[f"/frame/{UGV}/body/lidar/name"].text == "lidar"
    assert nodes[f"/frame/{UGV}/map"].position[:2] == pytest.approx((2.0, 1.0))
    assert f"/frame/{UGV}/odom" not in nodes


def test_frames_in_a_circle_end():
    loop = FrameTransforms(
        transforms=[transform("base_link", "a", 1.0), transform("a", "base_link", 1.0), transform("b", "c", 1), transform("c", "b", 1)]
    )
    assert set(fixed_frames(loop, "base_link", 0.15)) == {"base_link", "a"}


def wall(length):
    """A wall of cells of 0.1 m that is seen from the ground."""
    octree = Octree(0.1)
    y, z = np.meshgrid(np.arange(0.05, length, 0.1), np.arange(0.05, 2.0, 0.1))
    points = np.column_stack((np.full(y.size, 3.05), y.ravel(), z.ravel()))
    for _ in range(4):
        octree.insert(np.array((0.0, length / 2, 1.0)), points)
    return octree_message(octree, 2**24, 1.0)


def test_an_octree_is_boxes_where_it_is_occupied(station):
    boxes = octree_boxes(wall(4.0))
    assert boxes.middles[:, 0] == pytest.approx(3.05, abs=0.06) and np.ptp(boxes.middles[:, 2]) == pytest.approx(1.9, abs=0.11)
    assert (boxes.sides**2 * 1.0).sum() == pytest.approx(4.0 * 2.0, rel=0.1)
    assert isinstance(hear(station, vehicle=UAV, octree=wall(1.0))[f"/octree/{UAV}"], Boxes)


def test_a_large_octree_is_drawn_coarser():
    boxes = octree_boxes(wall(200.0))
    assert 0 < len(boxes.sides) <= MOST and boxes.sides.max() > 0.1


def test_bytes_that_are_no_octree_draw_nothing(station):
    assert octree_boxes(OctreeMap(data=b"no such thing")) is None
    assert f"/octree/{UAV}" not in hear(
        station, vehicle=UAV, octree=OctreeMap(data=b"# Octomap OcTree binary file\nid OcTree\nsize 1\nres 0\ndata\n")
    )
