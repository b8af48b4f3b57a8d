"""Pictures by the real renderer: things appear where the intrinsics say, in their colours."""

from dataclasses import replace
from pathlib import Path

import msgspec
import numpy as np
import pytest

from services.sim_camera.backdrop import SKY
from services.sim_camera.optics import intrinsics, project
from services.sim_camera.renderer import BulletRenderer, Pose
from uvf.maths.rotations import from_euler, matrix
from uvf.models.aircraft.shape import AircraftShape, aircraft_shape
from uvf.models.scenario import ROOT
from uvf.models.shapes.mesh import load_mesh
from uvf.models.shapes.mesh_parts import MeshPart
from uvf.models.shapes.solid import Solid
from uvf.models.urdf.model import engine_urdf
from uvf.models.vehicle.file import load_vehicle
from uvf.models.vehicle.sensors import Camera, Mount
from uvf.models.world.file import Box, Cylinder, Field, Origin, WorldFile
from uvf.models.world.geometry import solids

RED, BLUE = (0.9, 0.05, 0.05), (0.05, 0.05, 0.9)
CAMERA = Camera(mount=Mount((0.1, 0.0, 0.3)), hz=5.0, width=160, height=120, fov=1.2, far=300.0)
ORIGIN = Pose(np.zeros(3), from_euler(0.0, 0.0, 0.0))
BALL = Cylinder("post", (4.0, 1.0, 0.2), 0.1, 0.2, colour=RED)
EMPTY = WorldFile(about="test", origin=Origin(0.0, 0.0), floor=(0.0, 0.0, 1.0, 1.0))


BURGER = ROOT / "vehicles" / "burger" / "burger.urdf"
MILVUS = aircraft_shape(ROOT / "vehicles" / "milvus", load_vehicle(ROOT / "vehicles", "milvus"))


def world_with(**parts):
    return msgspec.structs.replace(EMPTY, **parts)


def picture(world, camera=CAMERA, body=ORIGIN, vehicles=None, poses=None, t=0.0):
    return shot(world, camera, body, vehicles, poses, t).picture.astype(int)


def shot(world, camera=CAMERA, body=ORIGIN, vehicles=None, poses=None, t=0.0):
    renderer = BulletRenderer(world, solids(world, Path()), vehicles or {})
    renderer.place(t, poses or {})
    taken = renderer.take(camera, body)
    renderer.close()
    return taken


def centre_of(mask):
    rows, columns = np.nonzero(mask)
    return columns.mean(), rows.mean()


def is_red(taken):
    return (taken[:, :, 0] > 60) & (taken[:, :, 0] > 3 * taken[:, :, 1])


@pytest.mark.parametrize("yaw", [0.0, 0.3])
@pytest.mark.parametrize("pitch", [0.0, -0.1])
def test_a_post_appears_where_the_intrinsics_say(yaw, pitch):
    attitude = from_euler(0.0, pitch, yaw)
    taken = picture(world_with(cylinders=[BALL]), body=Pose(np.zeros(3), attitude))
    in_body = matrix(attitude).T @ np.array((4.0, 1.0, 0.3)) - np.array(CAMERA.mount.xyz)
    optical = np.array((-in_body[1], -in_body[2], in_body[0]))
    assert centre_of(is_red(taken)) == pytest.approx(project(intrinsics(CAMERA), optical), abs=1.0)


def test_who_walks_by_script_is_seen_where_the_script_has_brought_him():
    walk = [(0.0, 4.0, 2.0, 0.0), (2.0, 4.0, -2.0, 0.0), (4.0, 4.0, 2.0, 0.0)]
    world = world_with(cylinders=[Cylinder("walker", (4.0, 2.0, 0.0), 0.2, 0.6, colour=RED, path=walk)])
    columns = [centre_of(is_red(picture(world, t=t)))[0] for t in (0.5, 1.0, 1.5)]
    assert columns[1] == pytest.approx(CAMERA.width / 2, abs=2.0)
    assert columns[0] < columns[1] - 20 < columns[2] - 40


def test_what_is_put_in_is_seen_moves_and_is_gone_again():
    renderer, crate = BulletRenderer(EMPTY, [], {}), Solid("crate", "box", (0.4, 0.4, 0.4), np.array((3.0, 0.5, 0.2)), colour=RED)
    seen = []
    for guests in ({"crate": crate}, {"crate": replace(crate, position=np.array((3.0, -0.5, 0.2)))}, {}):
        renderer.show(guests)
        renderer.place(0.0, {"not yet here": ORIGIN})
        seen.append(is_red(renderer.take(CAMERA, ORIGIN).picture.astype(int)))
    renderer.close()
    assert centre_of(seen[0])[0] < CAMERA.width / 2 < centre_of(seen[1])[0]
    assert not seen[2].any()


def test_a_vehicle_that_is_put_in_is_placed_like_the_others():
    renderer, far = BulletRenderer(EMPTY, [], {}), Pose(np.array((1.5, 0.0, 0.0)), ORIGIN.world_from_body)
    empty = renderer.take(CAMERA, ORIGIN).picture
    renderer.show({"guest": BURGER})
    renderer.place(0.0, {"guest": far})
    assert (renderer.take(CAMERA, ORIGIN).picture != empty).any()
    renderer.close()


def test_the_sky_is_above_and_the_ground_below():
    taken = picture(EMPTY, body=Pose(np.array((0.0, 0.0, 50.0)), from_euler(0.0, 0.0, 0.0)))
    assert (taken[0] == SKY).all()
    assert (taken[-1, :, 1] > taken[-1, :, 2]).all()


def test_a_field_lies_on_the_ground():
    down = msgspec.structs.replace(CAMERA, mount=Mount((0.0, 0.0, 0.0), (0.0, np.pi / 2, 0.0)))
    world = world_with(fields=[Field((-5.0, -50.0, 5.0, 50.0), BLUE)])
    taken = picture(world, down, Pose(np.array((0.0, 0.0, 60.0)), from_euler(0.0, 0.0, 0.0)))
    blue = taken[:, :, 2] > 2 * taken[:, :, 1]
    width = 10.0 / 60.0 * intrinsics(down)[0, 0]
    assert blue[:, 80].sum() == pytest.approx(width, abs=2)
    assert not blue[0].any()


def test_rolling_to_the_right_lowers_the_horizon_on_the_left():
    taken = picture(EMPTY, body=Pose(np.array((0.0, 0.0, 50.0)), from_euler(0.4, 0.0, 0.0)))
    sky = (taken == SKY).all(axis=2).sum(axis=0)
    assert sky[10] > sky[150] + 20


@pytest.mark.parametrize("look", [MILVUS, BURGER])
def test_a_vehicle_is_seen_where_it_is_placed(look):
    ahead = Pose(np.array((1.5, 0.0, 0.2)), from_euler(0.0, 0.0, 0.0))
    away = Pose(np.array((1.5, 50.0, 0.2)), from_euler(0.0, 0.0, 0.0))
    without, seen = (picture(EMPTY, vehicles={"other": look}, poses={"other": pose}) for pose in (away, ahead))
    changed = (without != seen).any(axis=2)
    assert changed.sum() > 50
    column, row = centre_of(changed)
    assert column == pytest.approx(79.5, abs=2)
    assert 35 < row < 85


def test_a_mesh_is_drawn(tmp_path):
    mesh = tmp_path / "wedge.obj"
    mesh.write_text("v 0 -1 0\nv 0 1 0\nv 0 0 1\nv 0.1 0 0\nf 1 2 3\nf 1 3 2\nf 1 4 3\nf 2 3 4\nf 1 2 4\n")
    pose = {"other": Pose(np.array((6.0, 0.0, 0.0)), from_euler(0.0, 0.0, 0.0))}
    assert (
        picture(EMPTY, vehicles={"other": AircraftShape([MeshPart(*load_mesh(mesh))], [], (0.9, 0.9, 0.9))}, poses=pose) != picture(EMPTY)
    ).any()


@pytest.mark.timeout(60, method="thread")
def test_a_plate_whose_corners_lie_in_the_cameras_own_plane_is_drawn_all_the_same():
    """My2bot's camera is flush with its front plate: at this pose the engine divided 0 by 0 and looped for minutes."""
    folder = ROOT / "vehicles" / "my2bot"
    body = Pose(np.array((12.2010558, 1.17586785, -1.04911927e-05)), np.array((0.701058994, 5.75134178e-07, 1.95837733e-06, -0.713103279)))
    renderer = BulletRenderer(EMPTY, solids(EMPTY, Path()), {"rover": engine_urdf(folder / "my2bot.urdf.xacro")})
    camera = load_vehicle(ROOT / "vehicles", "my2bot").sensors.camera
    for k in range(20):
        there = body._replace(position=body.position + np.array((0.0, k * 1e-7, 0.0)))
        renderer.place(0.0, {"rover": there})
        assert renderer.take(camera, there).picture.shape == (120, 160, 3)
    renderer.close()


def test_the_same_scene_gives_the_same_bytes():
    world = world_with(cylinders=[BALL])
    assert (picture(world) == picture(world)).all()


DEEP = msgspec.structs.replace(CAMERA, depth=True, mount=Mount((0.1, 0.0, 0.3)), far=30.0)


def optical_rays(camera):
    """(height, width, 3) of each pixel's middle, camera frame (FLU), one metre along the view."""
    k = intrinsics(camera)
    columns, rows = np.meshgrid(np.arange(camera.width), np.arange(camera.height))
    return np.stack((np.ones_like(columns, dtype=float), -(columns - k[0, 2]) / k[0, 0], -(rows - k[1, 2]) / k[1, 1]), axis=2)


@pytest.mark.parametrize("attitude", [(0.0, 0.0, 0.0), (0.1, -0.2, 0.3), (0.0, 0.3, -0.2)])
def test_depth_is_that_of_each_pixels_ray_on_wall_and_ground(attitude):
    wall = Box(name="wall", centre=(5.0, 0.0, 5.0), size=(2.0, 100.0, 10.0), colour=BLUE)
    body = Pose(np.array((0.0, 0.0, 0.5)), from_euler(*attitude))
    seen = shot(world_with(boxes=[wall]), DEEP, body).depth
    turn = matrix(body.world_from_body)
    eye = body.position + turn @ np.array(DEEP.mount.xyz)
    rays = optical_rays(DEEP) @ turn.T
    with np.errstate(divide="ignore"):
        to_wall, to_ground = (4.0 - eye[0]) / rays[:, :, 0], -eye[2] / np.minimum(rays[:, :, 2], -1e-12)
    true = np.minimum(to_wall, to_ground)
    inside = np.abs(to_wall - to_ground) > 0.1  # not where both meet: there a pixel shows either
    height = eye[2] + true * rays[:, :, 2]
    inside &= height < 9.9
    assert inside.mean() > 0.7
    assert np.abs(seen - true)[inside].max() < 5e-3


def test_the_sky_has_no_depth():
    level = Pose(np.array((0.0, 0.0, 50.0)), from_euler(0.0, 0.0, 0.0))
    assert np.isinf(shot(EMPTY, DEEP, level).depth[:60]).all()


def test_an_edge_lies_where_the_intrinsics_say_to_a_third_of_a_pixel():
    """A slope of depth across a slanted wall would show half a pixel as millimetres."""
    slanted = Box(name="wall", centre=(5.0, 0.0, 5.0), size=(2.0, 100.0, 10.0), rpy=(0.0, 0.0, 0.5), colour=BLUE)
    seen = shot(world_with(boxes=[slanted]), DEEP, Pose(np.zeros(3), from_euler(0.0, 0.0, 0.0))).depth
    normal = np.array((np.cos(0.5), np.sin(0.5), 0.0))
    eye = np.array(DEEP.mount.xyz)
    true = (normal @ np.array((5.0, 0.0, 5.0)) - 1.0 - normal @ eye) / (optical_rays(DEEP) @ normal)
    slope = np.abs(np.diff(true[60])).max()
    assert np.abs(seen - true)[20:60].max() < slope / 3
