"""The still world, bodies and views: geometry that can be computed a second way."""

import dataclasses

import numpy as np
import pytest
import trimesh

from services.gcs.view.scene import bodies
from services.gcs.view.scene.cameras import ASPECT, FOV, cameras
from services.gcs.view.scene.scenery import WALL_SHOWN, extent, moving, places_of, rgb_of, scenery
from tests.services.gcs.scripted import LEGS, demo_site
from uvf.models.scenario import ROOT
from uvf.models.shapes.mesh_parts import box, lathe, plate, rod
from uvf.models.vehicle.file import load_vehicle
from uvf.models.world.file import Box, Cylinder, Origin, Wall, WorldFile

WORLD = WorldFile(about="", origin=Origin(0.0, 0.0), floor=(0.0, 0.0, 4.0, 3.0))


def solid(part):
    return trimesh.Trimesh(part.vertices, part.faces, process=True)


def corners(nodes, prefix):
    return np.vstack([n.vertices for name, n in nodes.items() if name.startswith(prefix)])


@pytest.mark.parametrize(
    ("part", "volume"),
    [
        (box((1, 2, 3), (2, 3, 4)), 24.0),
        (lathe(2, [(0, 1), (2, 1)], (5, 0, 0)), 2 * 12 * np.sin(np.pi / 12)),
        (lathe(0, [(0, 1), (1, 1), (2, 0.5)], (0, 0, 0)), 12 * np.sin(np.pi / 12) * (1 + 7 / 12)),
        (plate([(0, 0, 0), (2, 0, 0), (2, 1, 0), (0, 1, 0)], 0.5), 1.0),
        (plate([(0, 0, 0), (0, 0, 2), (1, 0, 2), (1, 0, 0)], 0.5), 1.0),
        (rod((1, 2, 3), (1, 2, 5), 0.5), 2 * 3 * 0.25 * np.sin(np.pi / 3)),
    ],
)
def test_solids_are_closed_and_have_the_volume_of_the_book(part, volume):
    mesh = solid(part)
    assert mesh.is_watertight
    assert abs(mesh.volume) == pytest.approx(volume, rel=1e-6)


@pytest.mark.parametrize(
    "urdf", ["burger/burger.urdf", "my2bot/my2bot.urdf.xacro", "my3bot/my3bot.urdf.xacro", "mybot05/mybot05.urdf.xacro"]
)
def test_a_rover_stands_on_its_wheels_and_fits_its_circle(urdf):
    path = ROOT / "vehicles" / urdf
    points = np.vstack([p.vertices for p in bodies.rover(path)])
    assert points[:, 2].min() == pytest.approx(0.0, abs=1e-9)
    assert np.hypot(points[:, 0], points[:, 1]).max() < load_vehicle(ROOT / "vehicles", path.parent.name).ground.radius


def test_each_rover_looks_like_itself():
    looks = {urdf.parent.name: bodies.rover(urdf) for urdf in sorted((ROOT / "vehicles").glob("my*bot*/*.urdf.xacro"))}
    sizes = {tuple(np.ptp(np.vstack([p.vertices for p in parts]), axis=0).round(2)) for parts in looks.values()}
    assert len(looks) >= 3 and len(sizes) == len(looks)


def test_walls_close_their_corners_and_are_cut_low():
    world = dataclasses_replace(WORLD, walls=[Wall(points=[(0, 0), (4, 0), (4, 3)], thickness=0.2)])
    points = corners(scenery(world), "/world/walls")
    assert points.min(axis=0) == pytest.approx((-0.1, -0.1, 0.0))
    assert points.max(axis=0) == pytest.approx((4.1, 3.1, WALL_SHOWN))


def test_boxes_are_turned_about_their_centre():
    world = dataclasses_replace(WORLD, boxes=[Box("b", (2.0, 1.0, 0.5), (2.0, 0.5, 1.0), rpy=(0.0, 0.0, np.pi / 2))])
    points = corners(scenery(world), "/world/things")
    assert points.min(axis=0) == pytest.approx((1.75, 0.0, 0.0))
    assert points.max(axis=0) == pytest.approx((2.25, 2.0, 1.0))


def test_a_person_is_drawn_upright_in_a_frame_that_goes_its_way_again_and_again():
    way = [(0.0, 1.0, 1.0, 0.0), (2.0, 3.0, 1.0, np.pi / 2), (4.0, 1.0, 1.0, 0.0)]
    person = Cylinder("person", base=(1.0, 1.0, 0.0), radius=0.25, height=1.8, path=way)
    world = dataclasses_replace(WORLD, cylinders=[person])
    points = scenery(world)["/world/moving/person/shape"].vertices
    assert points[:, 2] == pytest.approx(np.where(points[:, 2] > 0, 0.9, -0.9))
    for t in (1.0, 5.0):
        place = places_of(moving(world), t)["/world/moving/person"]
        assert place.position == pytest.approx((2.0, 1.0, 0.9))
        assert place.wxyz == pytest.approx((np.cos(np.pi / 8), 0.0, 0.0, np.sin(np.pi / 8)))


def dataclasses_replace(world, **changes):
    return WorldFile(**{f: getattr(world, f) for f in WorldFile.__struct_fields__} | changes)


def test_the_extent_holds_the_floor_and_the_circuit():
    low, high = extent(demo_site())
    assert low == pytest.approx((*np.min(LEGS, axis=0), 0.0))
    assert high == pytest.approx((*np.max(LEGS, axis=0), 60.0))


def seen(camera, points):
    """(n, 2) of points in a window that reaches from -1 to 1 both ways."""
    position, look_at = np.array(camera.position), np.array(camera.look_at)
    sight = (look_at - position) / np.linalg.norm(look_at - position)
    right = np.cross(sight, (0, 0, 1))
    right /= np.linalg.norm(right)
    up = np.cross(right, sight)
    depth = (points - position) @ sight
    assert (depth > 0).all()
    tall = np.tan(FOV / 2)
    return np.column_stack(((points - position) @ right / depth / tall / ASPECT, (points - position) @ up / depth / tall))


FLOOR = np.array([(x, y, 0.0) for x in (0, 12) for y in (0, 9)])
CIRCUIT = np.array([(*leg, 60.0) for leg in LEGS])


@pytest.mark.parametrize(("view", "points"), [("Scene", FLOOR), ("Top", FLOOR), ("All", CIRCUIT), ("All", FLOOR)])
def test_views_hold_what_they_promise(view, points):
    assert np.abs(seen(cameras(demo_site())[view], points)).max() < 1.0


@pytest.mark.parametrize("view", ["Scene", "Top", "All"])
@pytest.mark.parametrize("aspect", [0.45, 0.9, 1.6])
def test_a_window_of_any_shape_holds_the_whole_floor(view, aspect):
    x, y = np.abs(seen(cameras(demo_site(), aspect)[view], FLOOR)).max(axis=0) * (ASPECT / aspect, 1.0)
    assert max(x, y) < 1.0


def test_views_are_filled():
    assert np.abs(seen(cameras(demo_site())["Top"], FLOOR)).max() > 0.8


def test_the_opening_view_shows_the_far_leg_in_the_sky():
    camera = cameras(demo_site())["Scene"]
    far = np.array([(x, 150.0, 60.0) for x in (-40.0, 0.0, 40.0)])
    assert (seen(camera, far)[:, 1] < 0.97).all()
    assert seen(camera, far)[:, 1].min() > 0.3


def test_with_nothing_in_the_air_the_opening_view_stays_on_the_floor():
    site = demo_site()
    ground = dataclasses.replace(site, members={n: m for n, m in site.members.items() if m.file.kind == "ground"})
    assert np.abs(seen(cameras(ground)["Scene"], FLOOR).mean(axis=0)).max() < 0.3


def test_colours_are_read():
    assert rgb_of("#4ea1ff") == (78, 161, 255)
