"""A vehicle's fence stands in the scene: what to stay in, what to keep out of, floor and ceiling."""

import itertools

import numpy as np
import pytest

from schemas import topics
from schemas.limits import LENGTHS
from schemas.messages import Fence, FenceZone, Vector3
from services.gcs.actions.page import Layer
from services.gcs.view.drawing import MeshNode, Polyline
from services.gcs.view.scene import way_layers
from services.gcs.view.scene.fences import CORNERS, KEEP_OUT, fence_nodes
from tests.services.gcs.fakes import ME, Station
from tests.services.gcs.scripted import UAV, UGV

SQUARE = FenceZone(vertices=[Vector3(x=x, y=y) for x, y in ((-300, -250), (300, -250), (300, 250), (-300, 250))])
TOWER = FenceZone(centre=Vector3(x=100.0, y=20.0), radius=40.0, excludes=True)
FENCE = Fence(zones=[SQUARE, TOWER], floor=20.0, ceiling=120.0)
BLUE = (0, 0, 255)


@pytest.fixture
def station():
    station = Station()
    station.script.put(UAV, topics.FENCE, FENCE, 0.0)
    station.run(1.0)
    return station


def heights(node):
    points = node.points if isinstance(node, Polyline) else node.vertices
    return points[:, 2].min(), points[:, 2].max()


def test_zones_reach_from_the_floor_to_the_ceiling_along_their_edges():
    nodes = fence_nodes(FENCE, BLUE, flies=True)
    assert all(heights(node) == (20.0, 120.0) for node in nodes.values())
    corners = {(x, y, z) for x in (-300.0, 300.0) for y in (-250.0, 250.0) for z in (20.0, 120.0)}
    assert {tuple(p) for p in nodes["/0/edge"].points} == corners
    assert np.hypot(*(nodes["/1/wall"].vertices[:, :2] - (100.0, 20.0)).T) == pytest.approx(40.0)
    assert len(nodes["/1/wall"].vertices) == 2 * CORNERS


def test_the_edge_is_drawn_round_below_and_above_with_a_post_at_each_corner():
    points = fence_nodes(FENCE, BLUE, flies=True)["/0/edge"].points
    drawn = {frozenset((tuple(a), tuple(b))) for a, b in itertools.pairwise(points) if tuple(a) != tuple(b)}
    corners = [(v.x, v.y) for v in SQUARE.vertices]
    for here, after in zip(corners, [*corners[1:], corners[0]], strict=True):
        assert {frozenset(((*here, z), (*after, z))) for z in (20.0, 120.0)} <= drawn
        assert frozenset(((*here, 20.0), (*here, 120.0))) in drawn
    assert len(drawn) == 12, "nothing crosses a zone that is to be stayed in"


def test_what_is_to_be_kept_out_of_is_told_apart_by_colour_diagonals_and_thicker_walls():
    nodes = fence_nodes(FENCE, BLUE, flies=True)
    assert (nodes["/0/edge"].colour, nodes["/1/edge"].colour) == (BLUE, KEEP_OUT)
    assert nodes["/1/wall"].opacity > nodes["/0/wall"].opacity
    steps = np.diff(nodes["/1/edge"].points, axis=0)
    assert ((np.abs(steps[:, 2]) > 1.0) & (np.hypot(steps[:, 0], steps[:, 1]) > 1.0)).sum() == 8


def test_without_a_ceiling_the_walls_are_open_above():
    node = fence_nodes(Fence(zones=[SQUARE]), BLUE, flies=True)["/0/edge"]
    low, high = heights(node)
    assert low == 0.0 and high > 60.0
    along = node.points[:-1, 2] + node.points[1:, 2] == 2 * high
    assert not along.any()


def test_a_ground_vehicles_fence_is_a_low_edge():
    nodes = fence_nodes(FENCE, BLUE, flies=False)
    assert all(heights(node)[1] < 0.5 for node in nodes.values())


def test_the_page_shows_it_hides_it_and_takes_it_away(station):
    def shown():
        return {name: node for name, node in station.page.now.nodes.items() if name.startswith("/fence/")}

    before = shown()
    assert set(before) == {f"/fence/{UAV}/{i}/{what}" for i in (0, 1) for what in ("edge", "wall")}
    assert not any(name.startswith(f"/fence/{UGV}") for name in before)
    station.run(0.5)
    assert all(shown()[name] is node for name, node in before.items()), "nothing is sent again"
    station.press(Layer(ME, "Fences", False))
    assert not shown()
    station.press(Layer(ME, "Fences", True))
    station.script.put(UAV, topics.FENCE, Fence(), station.t)
    station.run(0.2)
    assert not shown()


def test_all_zones_of_a_fence_are_drawn_at_once(station, monkeypatch):
    drawn = []
    monkeypatch.setattr(way_layers, "fence_nodes", lambda fence, *how: drawn.append(fence) or fence_nodes(fence, *how))
    zones = [TOWER] * LENGTHS["uvf.v1.Fence.zones"]
    station.script.put(UAV, topics.FENCE, Fence(zones=zones), station.t)
    station.run(0.5)
    assert sum(name.startswith(f"/fence/{UAV}") for name in station.page.now.nodes) == 2 * len(zones)
    assert len(drawn) == 1


def test_a_new_fence_takes_the_place_of_the_old_one(station):
    station.script.put(UAV, topics.FENCE, Fence(zones=[TOWER]), station.t)
    station.run(0.2)
    node = station.page.now.nodes[f"/fence/{UAV}/0/wall"]
    assert isinstance(node, MeshNode) and node.colour == KEEP_OUT
