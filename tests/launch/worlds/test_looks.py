"""What others' worlds and robots look like: pictures laid over meshes, on the page and to cameras, apart from what is felt."""

import shutil
from pathlib import Path

import msgspec
import numpy as np
import pytest
import trimesh
from PIL import Image

from launch.vehicles.importing import import_vehicle
from launch.worlds.picture import view
from services.gcs.page.viser_scene import glb_mesh
from services.gcs.view.drawing import TexturedNode
from services.gcs.view.scene import bodies
from services.gcs.view.scene.scenery import scenery
from services.sim_camera.renderer import BulletRenderer, Pose
from tests.launch.vehicles.test_importing_drives import BOTH, HULL, hung
from tests.launch.worlds.test_sdf_import import BOX, model, taken
from uvf.maths.rotations import from_euler
from uvf.models.importing.mesh_files import DENSE
from uvf.models.shapes.solid import Solid
from uvf.models.shapes.textured import LARGEST, load_textured, textured
from uvf.models.urdf.model import engine_urdf, load_urdf
from uvf.models.vehicle.sensors import Camera, Mount
from uvf.models.world.cutaway import cut_open_textured
from uvf.models.world.file import load_world
from uvf.models.world.geometry import seen, things
from uvf.models.yaml_data import BadInput

pytestmark = pytest.mark.usefixtures("no_models_of_this_machine")
CORNERS = {"upper left": (255, 0, 0), "upper right": (0, 255, 0), "lower left": (0, 0, 255), "lower right": (255, 255, 255)}
BOARD = BOX.format("0.1 2 2")
CAMERA = Camera(Mount((0.0, 0.0, 0.0)), hz=1.0, width=80, height=80, fov=1.2, far=50.0)


@pytest.fixture
def no_models_of_this_machine(monkeypatch, tmp_path):
    for variable in ("GAZEBO_MODEL_PATH", "GZ_SIM_RESOURCE_PATH", "IGN_GAZEBO_RESOURCE_PATH", "SDF_PATH"):
        monkeypatch.delenv(variable, raising=False)
    monkeypatch.setenv("HOME", str(tmp_path / "home"))


def picture(size=64):
    """Four quarters of different colours."""
    half, pixels = size // 2, np.zeros((size, size, 3), dtype=np.uint8)
    for name, rgb in CORNERS.items():
        rows = slice(0, half) if "upper" in name else slice(half, size)
        pixels[rows, slice(0, half) if "left" in name else slice(half, size)] = rgb
    return Image.fromarray(pixels)


def poster(path, at="../materials/textures/poster.png", size=64, tiles=1.0, offset=0.0):
    """An upright square of 2 m, seen from -x, as OBJ with the picture in the folder where Gazebo's models keep theirs."""
    path.parent.mkdir(parents=True, exist_ok=True)
    target = (path.parent / at).resolve()
    target.parent.mkdir(parents=True, exist_ok=True)
    picture(size).save(target)
    path.with_suffix(".mtl").write_text(f"newmtl m\nKd 1 1 1\nmap_Kd {at}\n")
    spots = [(0, 1, 0), (0, -1, 0), (0, -1, 2), (0, 1, 2)]
    uv = [(0, 0), (1, 0), (1, 1), (0, 1)]
    lines = [f"mtllib {path.stem}.mtl", *(f"v {x} {y} {z}" for x, y, z in spots)]
    lines += [f"vt {u * tiles + offset} {v * tiles + offset}" for u, v in uv]
    path.write_text("\n".join([*lines, "usemtl m", "f 1/1 2/2 3/3", "f 1/1 3/3 4/4"]) + "\n")
    return path


def hanging(file="poster.obj", collision=BOARD, material=""):
    return f"<visual name='v'><geometry><mesh><uri>meshes/{file}</uri></mesh></geometry>{material}</visual>{collision}"


def gallery(tmp_path, inside, place="<pose>4 0 0 0 0 0</pose>", extra="", **changed):
    poster(tmp_path / "gazebo" / "meshes" / "poster.obj", **changed)
    return taken(tmp_path, model("poster", inside, place) + extra)


def quarters(solids, world, turned=0.0):
    """The pixel in the middle of each quarter of what hangs 4 m ahead, 2 m high."""
    renderer = BulletRenderer(world, solids, {})
    taken_there = renderer.take(CAMERA, Pose(np.array((0.0, 0.0, 1.0)), from_euler(0.0, 0.0, turned))).picture.astype(int)
    renderer.close()
    spots = {"upper left": (28, 28), "upper right": (28, 52), "lower left": (52, 28), "lower right": (52, 52)}
    return {name: taken_there[spot] for name, spot in spots.items()}


def is_like(pixel, rgb):
    """The same colour, however it is lit."""
    lit = np.array(rgb) / 255
    return np.abs(pixel / max(pixel.max(), 1) - lit).max() < 0.25 and pixel.max() > 90


@pytest.mark.parametrize("changed", [{}, {"offset": 2.0}, {"offset": -3.0}, {"at": "poster.png"}, {"size": 2000}])
def test_a_picture_is_seen_by_cameras_where_the_mesh_has_it(tmp_path, changed):
    world, _ = gallery(tmp_path, hanging(), **changed)
    assert all(is_like(pixel, CORNERS[name]) for name, pixel in quarters(seen(world), world).items())


def test_what_is_shown_by_a_look_is_felt_and_not_drawn(tmp_path):
    world, told = gallery(tmp_path, hanging())
    assert [(thing.name, thing.hidden) for thing in world.boxes] == [("poster", True)]
    assert [solid.name for solid in things(world)] == ["poster"] and [solid.name for solid in seen(world)] == ["look"]
    assert "1 looks" in told


def test_what_is_only_seen_is_taken_over_and_touches_nothing(tmp_path):
    world, told = gallery(tmp_path, hanging(collision=""), extra=model("post", BOX.format("1 1 1"), "<pose>9 0 0.5 0 0 0</pose>"))
    assert len(world.looks) == 1 and [box.name for box in world.boxes] == ["post"] and not world.boxes[0].hidden
    assert "only seen" not in told


def test_a_picture_that_the_world_gives_is_laid_over_the_mesh(tmp_path):
    """As of Fuel's models, whose meshes name none."""
    material = "<material><pbr><metal><albedo_map>materials/textures/poster.png</albedo_map></metal></pbr></material>"
    path = poster(tmp_path / "gazebo" / "meshes" / "poster.obj")
    path.with_suffix(".mtl").write_text("newmtl m\nKd 0.5 0.5 0.5\n")
    world, _ = taken(tmp_path, model("poster", hanging(material=material), "<pose>4 0 0 0 0 0</pose>"))
    assert all(is_like(pixel, CORNERS[name]) for name, pixel in quarters(seen(world), world).items())


def test_a_colour_that_the_world_gives_counts(tmp_path):
    path = poster(tmp_path / "gazebo" / "meshes" / "poster.obj")
    path.with_suffix(".mtl").write_text("newmtl m\nKd 0.5 0.5 0.5\n")
    material = "<material><diffuse>0.1 0.8 0.1 1</diffuse></material>"
    world, _ = taken(tmp_path, model("poster", hanging(material=material), "<pose>4 0 0 0 0 0</pose>"))
    assert [look.colour for look in world.looks] == [(0.1, 0.8, 0.1)]


@pytest.mark.parametrize("spoil", ["missing", "broken"])
def test_a_picture_that_cannot_be_read_leaves_a_plain_look(tmp_path, spoil):
    path = poster(tmp_path / "gazebo" / "meshes" / "poster.obj")
    target = tmp_path / "gazebo" / "materials" / "textures" / "poster.png"
    target.unlink() if spoil == "missing" else target.write_bytes(b"not a picture")
    assert path.is_file()
    world, _ = taken(tmp_path, model("poster", hanging(), "<pose>4 0 0 0 0 0</pose>"))
    assert [Path(look.file).suffix for look in world.looks] == [".stl"]


def test_pictures_become_small_files(tmp_path):
    world, _ = gallery(tmp_path, hanging(), size=2000)
    assert Image.open(Path(world.looks[0].file).with_suffix(".jpg")).size == (LARGEST, LARGEST)


def test_looks_follow_a_ground_that_is_brought_to_zero_and_far_ones_go_with_their_things(tmp_path):
    slab = model("slab", BOX.format("30 30 0.2"), "<pose>0 0 0.4 0 0 0</pose>")
    others = "".join(model(f"p{i}", BOX.format("1 1 1"), f"<pose>{i} 5 1 0 0 0</pose>") for i in range(3))
    away = model("away", hanging(), "<pose>0 0 200000 0 0 0</pose>")
    world, _ = gallery(tmp_path, hanging(), "<pose>4 0 0.5 0 0 0</pose>", slab + others + away)
    assert [look.position[2] for look in world.looks] == [pytest.approx(0.0)]


def test_what_has_more_triangles_than_it_is_worth_is_shown_by_what_is_felt(tmp_path):
    meshes = tmp_path / "gazebo" / "meshes"
    meshes.mkdir(parents=True)
    ball = trimesh.creation.icosphere(subdivisions=5, radius=0.1)
    assert len(ball.faces) > DENSE * 0.2
    ball.export(meshes / "ball.stl")
    world, told = taken(tmp_path, model("ball", hanging("ball.stl", BOX.format("0.2 0.2 0.2"))))
    assert not world.looks and not world.boxes[0].hidden
    assert "looks of many triangles left out, their collision shapes stand for them: ball.stl" in told
    assert not list((tmp_path / "worlds" / "w").glob("meshes/ball*"))


def test_a_look_without_its_file_is_refused_with_the_nearest(tmp_path):
    gallery(tmp_path, hanging())
    path = tmp_path / "worlds" / "w" / "world.yaml"
    path.write_text(path.read_text().replace("poster.obj", "postr.obj"))
    with pytest.raises(BadInput, match=r"looks\[0\]: file: no file 'meshes/postr.obj'.*did you mean 'meshes/poster.obj'"):
        load_world(tmp_path / "worlds", "w")


def test_a_picture_of_the_world_shows_it_cut_open(tmp_path):
    world, _ = gallery(tmp_path, hanging(), "<pose>4 0 0 0 0 3.1416</pose>")
    colours = {tuple((pixel > 110).tolist()) for pixel in view(msgspec.structs.replace(world, floor=(0.0, -3.0, 6.0, 3.0))).reshape(-1, 3)}
    assert (True, False, False) in colours and (False, False, True) in colours


def test_on_the_page_it_is_a_mesh_under_its_picture(tmp_path):
    world, _ = gallery(tmp_path, hanging(), extra=model("second", hanging(), "<pose>4 5 0 0 0 0</pose>"))
    (node,) = [node for name, node in scenery(world).items() if name.startswith("/world/pictures")]
    assert isinstance(node, TexturedNode) and node.mesh.vertices.max(axis=0) == pytest.approx((4.0, 6.0, 2.0))
    mesh = trimesh.load(trimesh.util.wrap_as_stream(glb_mesh(node.mesh).export(file_type="glb")), file_type="glb", force="mesh")
    sampled = mesh.visual.to_color().vertex_colors[:, :3].astype(int)
    assert {tuple(np.round(c / 255).astype(int)) for c in sampled} == {(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 1)}


def test_what_is_cut_keeps_each_point_of_its_picture(tmp_path):
    whole = load_textured(poster(tmp_path / "meshes" / "poster.obj", at="poster.png"))
    cut = cut_open_textured(whole, 1.4)
    assert cut.vertices[:, 2].max() == pytest.approx(1.4)
    assert cut.uv[:, 1] == pytest.approx(cut.vertices[:, 2] / 2) and cut.uv[:, 0] == pytest.approx((1 - cut.vertices[:, 1]) / 2)


@pytest.mark.parametrize("text", ["v 0 0 0\n", "", "mtllib ../../../x.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n"])
def test_an_obj_without_a_picture_has_none(tmp_path, text):
    (tmp_path / "bare.obj").write_text(text)
    assert load_textured(tmp_path / "bare.obj") is None


def test_a_solid_stands_where_it_is_put_with_its_picture(tmp_path):
    path = poster(tmp_path / "poster.obj", at="poster.png")
    mesh = textured(Solid("p", "mesh", (1.0, 2.0, 0.5), np.array((1.0, 2.0, 3.0)), from_euler(0.0, 0.0, np.pi / 2), mesh=path))
    assert mesh.vertices.min(axis=0) == pytest.approx((-1.0, 2.0, 3.0)) and mesh.vertices.max(axis=0) == pytest.approx((3.0, 2.0, 4.0))


def robot(tmp_path):
    poster(tmp_path / "meshes" / "poster.obj")
    sign = '<visual><geometry><mesh filename="meshes/poster.obj" scale="0.1 0.1 0.1"/></geometry></visual>'
    (tmp_path / "x.urdf").write_text(
        f'<robot name="it">{HULL}{BOTH}{hung("sign", "base_link", "fixed", "0.1 0 0.05", "1 0 0", sign)}</robot>'
    )
    import_vehicle(tmp_path / "x.urdf", tmp_path / "vehicles" / "it")
    return tmp_path / "vehicles" / "it" / "it.urdf"


def test_a_robot_keeps_its_pictures_for_cameras_and_page(tmp_path):
    urdf = robot(tmp_path)
    shutil.rmtree(tmp_path / "meshes")
    (sign,) = bodies.rover_parts(load_urdf(urdf), ())[bodies.FAST].pictured
    assert np.ptp(sign.vertices, axis=0) == pytest.approx((0.0, 0.2, 0.2), abs=1e-6)
    camera, away = msgspec.structs.replace(CAMERA, fov=0.3), np.array((1.0, 0.0, -sign.vertices[:, 2].mean()))
    world = taken(tmp_path, model("post", BOX.format("1 1 1"), "<pose>9 9 0.5 0 0 0</pose>"))[0]
    renderer = BulletRenderer(world, [], {"it": engine_urdf(urdf)})
    renderer.place(0.0, {"it": Pose(away, from_euler(0.0, 0.0, 0.0))})
    found = renderer.take(camera, Pose(np.zeros(3), from_euler(0.0, 0.0, 0.0))).picture.reshape(-1, 3).astype(int)
    renderer.close()
    assert all(any(is_like(pixel, rgb) for pixel in found) for rgb in CORNERS.values())


def test_its_ghost_has_one_colour(tmp_path):
    parts = bodies.rover_parts(load_urdf(robot(tmp_path)), (), pictures=False)[bodies.FAST]
    assert not parts.pictured and len(parts.plain) > 3


def test_a_picture_of_any_size_is_brought_to_a_small_one_before_it_goes_to_a_browser(tmp_path):
    mesh = load_textured(poster(tmp_path / "poster.obj", at="poster.png", size=3000))
    assert max(mesh.picture.size) == LARGEST


def test_a_picture_that_would_fill_the_memory_is_none(tmp_path, monkeypatch):
    path = poster(tmp_path / "poster.obj", at="poster.png", size=100)
    monkeypatch.setattr(Image, "MAX_IMAGE_PIXELS", 1000)
    assert load_textured(path) is None
