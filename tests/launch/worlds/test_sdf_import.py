"""Gazebo worlds as people write them: poses, frames, includes, saved states, shapes; and what is told of the rest."""

import logging

import numpy as np
import pytest
import trimesh

from uvf.maths.rotations import from_euler, matrix
from uvf.models.importing.worlds import Options, import_world
from uvf.models.world.file import load_world
from uvf.models.world.geometry import floor_plan, reachable_floor, solids
from uvf.models.yaml_data import BadInput

BOX = "<collision name='c'><geometry><box><size>{}</size></box></geometry></collision>"
UNIT = BOX.format("1 1 1")


@pytest.fixture(autouse=True)
def no_models_of_this_machine(monkeypatch, tmp_path):
    for variable in ("GAZEBO_MODEL_PATH", "GZ_SIM_RESOURCE_PATH", "IGN_GAZEBO_RESOURCE_PATH", "SDF_PATH"):
        monkeypatch.delenv(variable, raising=False)
    monkeypatch.setenv("HOME", str(tmp_path / "home"))


def taken(tmp_path, world, version="1.7", models=(), upright=False):
    """The imported world, and all that was told."""
    folder = tmp_path / "gazebo"
    folder.mkdir(exist_ok=True)
    (folder / "test.world").write_text(f"<?xml version='1.0'?>\n<sdf version='{version}'><world name='w'>{world}</world></sdf>")
    _, lines = import_world(folder / "test.world", tmp_path / "worlds" / "w", Options(models=models, upright=upright))
    return load_world(tmp_path / "worlds", "w"), "\n".join(lines)


def model(name, inside, pose="", attributes=""):
    return f"<model name='{name}' {attributes}><static>true</static>{pose}<link name='link'>{inside}</link></model>"


def corner(box):
    """Where the corner (+x, +y, +z) of a box lies: tells position and orientation at once."""
    return np.array(box.centre) + matrix(from_euler(*box.rpy)) @ (np.array(box.size) / 2)


def test_poses_of_model_link_and_collision_add_up(tmp_path):
    inside = f"<pose>1 0 0 0 0 0</pose>{UNIT.replace('<geometry>', '<pose>0 0 0.5 0 0 0</pose><geometry>', 1)}"
    world, _ = taken(tmp_path, model("a", inside, "<pose>0 2 0 0 0 1.5707963</pose>"))
    assert world.boxes[0].centre == pytest.approx((0.0, 3.0, 0.5), abs=1e-4)
    assert world.boxes[0].rpy == pytest.approx((0.0, 0.0, np.pi / 2), abs=1e-5)


@pytest.mark.parametrize(
    "pose",
    [
        "<pose degrees='true'>1 2 3 10 20 30</pose>",
        f"<pose>1 2 3 {np.radians(10)} {np.radians(20)} {np.radians(30)}</pose>",
        "<pose rotation_format='quat_xyzw'>1 2 3 0.0381346 0.1893079 0.2392984 0.9515485</pose>",
    ],
)
def test_the_three_ways_to_write_a_pose_are_one(tmp_path, pose):
    world, _ = taken(tmp_path, model("a", BOX.format("2 1 1"), pose))
    expected = np.array((1, 2, 3)) + matrix(from_euler(*np.radians((10, 20, 30)))) @ (1, 0.5, 0.5)
    assert corner(world.boxes[0]) == pytest.approx(expected, abs=1e-3)


def test_poses_relative_to_frames_links_and_other_models(tmp_path):
    frames = """<frame name='f'><pose>1 0 0 0 0 1.5707963</pose></frame>
      <frame name='g' attached_to='f'><pose>1 0 0 0 0 0</pose></frame>"""
    inner = f"<model name='m'><static>1</static>{frames}<link name='l'><pose relative_to='g'>0 0 1 0 0 0</pose>{UNIT}</link></model>"
    other = model("n", UNIT, "<pose relative_to='m::g'>0 0 5 0 0 0</pose>")
    world, _ = taken(tmp_path, inner + other, "1.9")
    assert world.boxes[0].centre == pytest.approx((1.0, 1.0, 1.0), abs=1e-4)
    assert world.boxes[1].centre == pytest.approx((1.0, 1.0, 5.0), abs=1e-4)


def test_a_placement_frame_is_what_the_pose_places(tmp_path):
    placed = model("m", f"<pose>0 0 2 0 0 0</pose>{UNIT}", "<pose>5 0 0 0 0 0</pose>", "placement_frame='link'")
    world, _ = taken(tmp_path, placed)
    assert world.boxes[0].centre == pytest.approx((5.0, 0.0, 0.0), abs=1e-6)


def test_frames_in_a_ring_are_refused_with_the_line(tmp_path):
    ring = "<frame name='a'><pose relative_to='b'/></frame>\n<frame name='b'><pose relative_to='a'/></frame>"
    with pytest.raises(BadInput, match=r"test.world:\d+: frames refer to each other in a ring"):
        taken(tmp_path, f"<model name='m'>{ring}<link name='l'><pose relative_to='a'>0 0 0 0 0 0</pose>{UNIT}</link></model>")


def test_nested_models_and_old_joint_models_stand_where_they_are_put(tmp_path):
    nested = f"<model name='o'><static>1</static><pose>1 0 0 0 0 0</pose>{model('i', UNIT, '<pose>0 1 0 0 0 0</pose>')}</model>"
    world, notes = taken(tmp_path, nested, "1.5")
    assert world.boxes[0].centre == pytest.approx((1.0, 1.0, 0.0))
    assert "could be pushed" not in notes


def test_a_saved_state_overrides_the_poses_and_scales_the_shapes(tmp_path):
    state = """<state world_name='w'><model name='a'><pose>9 9 0 0 0 0</pose><scale>2 1 3</scale>
      <link name='link'><pose>4 5 6 0 0 0</pose></link></model><deletions><name>b</name></deletions></state>"""
    world, _ = taken(tmp_path, model("a", UNIT, "<pose>1 1 1 0 0 0</pose>") + model("b", UNIT) + state, "1.6")
    (box,) = world.boxes
    assert box.centre == pytest.approx((4.0, 5.0, 6.0))
    assert box.size == pytest.approx((2.0, 1.0, 3.0))


def library(tmp_path):
    """Two models as they lie about: one with a model.config that names the newest file, one with a mesh in inches, y up."""
    chair = tmp_path / "lib" / "chair"
    chair.mkdir(parents=True)
    (chair / "model.config").write_text(
        "<model><name>Chair & table</name><sdf version='1.4'>old.sdf</sdf><sdf version='1.5'>new.sdf</sdf></model>"
    )
    (chair / "new.sdf").write_text(f"<sdf version='1.5'>{model('chair', UNIT, '<pose>0 0 0.5 0 0 0</pose>')}</sdf>")
    meshes = tmp_path / "lib" / "rod" / "meshes"
    meshes.mkdir(parents=True)
    rod = trimesh.creation.box((10.0, 40.0, 10.0)).export(file_type="dae").decode()
    head, _, rest = rod.partition("<asset>")
    (meshes / "rod.dae").write_text(
        f"{head}<asset><unit name='inch' meter='0.0254'/><up_axis>Y_UP</up_axis></asset>{rest.partition('</asset>')[2]}"
    )
    shape = "<mesh><uri>model://rod/meshes/rod.dae</uri><scale>1 1 2</scale></mesh>"
    (tmp_path / "lib" / "rod" / "model.sdf").write_text(
        "<sdf version='1.5'>" + model("rod", f"<collision name='c'><geometry>{shape}</geometry></collision>") + "</sdf>"
    )
    return tmp_path / "lib"


def test_included_models_are_found_named_and_placed(tmp_path):
    include = "<include><uri>model://chair</uri>{}</include>"
    moved = include.format("<name>best</name><pose>3 0 0.5 0 0 0</pose>")
    world, notes = taken(tmp_path, include.format("") + include.format("") + moved, models=[library(tmp_path)])
    assert [box.name for box in world.boxes] == ["chair", "chair_0", "best"]
    assert [box.centre[0] for box in world.boxes] == [0.0, 0.0, 3.0]
    assert world.boxes[0].centre[2] == 0.5
    assert "not found" not in notes


def test_models_are_found_by_gazebo_s_own_variables(tmp_path, monkeypatch):
    monkeypatch.setenv("GZ_SIM_RESOURCE_PATH", f"/nowhere:{library(tmp_path)}")
    world, _ = taken(tmp_path, "<include><uri>https://fuel.gazebosim.org/1.0/OpenRobotics/models/Chair/2</uri></include>")
    assert len(world.boxes) == 1


def test_what_is_not_needed_and_what_is_missing_is_told(tmp_path):
    includes = "".join(
        f"<include><uri>{uri}</uri></include>"
        for uri in ("model://sun", "model://ground_plane", "https://fuel.gazebosim.org/1.0/X/models/Big Desk", "model://robot_lab")
    )
    rest = "<light name='lamp' type='point'/><actor name='walker'/><plugin name='p' filename='libp.so'/><road name='r'/>"
    world, notes = taken(tmp_path, includes + rest + model("a", UNIT))
    assert len(world.boxes) == 1
    for words in ("model sun", "model ground_plane", "download it", "Big Desk", "model://robot_lab", "lamp", "walker", "p", "roads"):
        assert words in notes


@pytest.mark.parametrize(("upright", "size"), [(False, (0.254, 1.016, 0.508)), (True, (0.254, 0.254, 2.032))])
def test_a_mesh_is_written_in_metres_and_turned_only_when_asked(tmp_path, upright, size):
    """As in Gazebo, whose turtlebot3_world has meshes that say y is up and stand right unturned."""
    world, notes = taken(tmp_path, "<include><uri>model://rod</uri></include>", models=[library(tmp_path)], upright=upright)
    assert ("not turned, as in Gazebo" in notes) != upright
    (mesh,) = world.meshes
    assert mesh.file.endswith(".stl")
    assert trimesh.load_mesh(mesh.file).extents == pytest.approx(np.array(size), rel=1e-5)


def test_a_model_that_nothing_holds_and_a_robot_are_told(tmp_path):
    loose = f"<model name='can'><link name='l'>{UNIT}</link></model>"
    robot = f"<model name='bot'><link name='l'>{UNIT}</link><plugin name='d' filename='libgazebo_ros_diff_drive.so'/></model>"
    world, notes = taken(tmp_path, loose + robot)
    assert [box.name for box in world.boxes] == ["can"]
    assert "stand still here: can" in notes
    assert "vehicles are not part of a world; 'uvf vehicle' takes them: bot" in notes


SHAPES = """
<collision name='cylinder'><pose>0 0 1 0 0 0</pose>
  <geometry><cylinder><radius>0.5</radius><length>2</length></cylinder></geometry></collision>
<collision name='sphere'><geometry><sphere><radius>0.3</radius></sphere></geometry></collision>
<collision name='capsule'><geometry><capsule><radius>0.2</radius><length>1</length></capsule></geometry></collision>
<collision name='egg'><geometry><ellipsoid><radii>0.2 0.3 0.5</radii></ellipsoid></geometry></collision>
<collision name='outline'><geometry><polyline><point>0 0</point><point>2 0</point><point>2 1</point><point>1 0.5</point><point>0 1</point>
  <height>1.5</height></polyline></geometry></collision>
<collision name='field'><geometry><heightmap><uri>h.png</uri></heightmap></geometry></collision>
<collision name='hurt'><geometry><box/></geometry></collision>"""


def test_shapes_keep_their_measures_and_those_that_cannot_be_had_are_told(tmp_path):
    world, notes = taken(tmp_path, model("m", SHAPES))
    assert world.cylinders[0].base == pytest.approx((0.0, 0.0, 0.0))
    assert [(c.radius, c.height) for c in world.cylinders] == [(0.5, 2.0), (0.2, 1.0)]
    assert sorted(s.radius for s in world.spheres) == [0.2, 0.2, 0.3]
    egg, outline = (trimesh.load_mesh(mesh.file) for mesh in world.meshes)
    assert egg.extents == pytest.approx(np.array((0.4, 0.6, 1.0)), rel=0.01)
    assert outline.is_watertight
    assert outline.volume == pytest.approx(1.5 * 1.5)
    assert "heightmaps not found, the ground is level instead: h.png" in notes
    assert "has no <size>" in notes


def test_the_ground_is_brought_to_zero(tmp_path):
    plane = "<collision name='c'><geometry><plane><normal>0 0 1</normal><size>9 9</size></plane></geometry></collision>"
    ground = model("ground", plane, "<pose>0 0 -0.5 0 0 0</pose>")
    world, notes = taken(tmp_path, ground + model("a", UNIT))
    assert world.boxes[0].centre == pytest.approx((0.0, 0.0, 0.5))
    assert "moved by 0.5 m" in notes


def test_a_slab_under_everything_is_the_ground(tmp_path):
    slab = model("slab", BOX.format("10 10 0.2"), "<pose>0 0 0.1 0 0 0</pose>")
    crates = "".join(model(f"crate_{x}", UNIT, f"<pose>{x} 0 0.7 0 0 0</pose>") for x in (-4, 0, 4))
    world, _ = taken(tmp_path, slab + crates)
    assert [box.centre[2] for box in world.boxes] == pytest.approx([0.5, 0.5, 0.5])
    assert world.floor == pytest.approx((-6.0, -6.0, 6.0, 6.0))


def mesh_file(tmp_path, name, *parts):
    """A collision of that mesh, which lies beside the world's file."""
    folder = tmp_path / "gazebo"
    folder.mkdir(exist_ok=True)
    trimesh.util.concatenate(parts).export(folder / f"{name}.stl")
    return f"<collision name='c'><geometry><mesh><uri>{name}.stl</uri></mesh></geometry></collision>"


def block(size, at):
    return trimesh.creation.box(size, trimesh.transformations.translation_matrix(at))


def crates(height):
    return "".join(model(f"crate_{x}", UNIT, f"<pose>{x} 0 {height + 0.5} 0 0 0</pose>") for x in (-4, 0, 4))


def test_a_slab_that_is_a_mesh_is_the_ground_and_the_roof_above_is_not(tmp_path):
    """Floor and ceiling of a warehouse, both wide, level and meshes."""
    slab = model("slab", mesh_file(tmp_path, "slab", block((12, 10, 0.12), (0, 0, -0.03))), "<pose>1 0 0.004 0 0 0</pose>")
    roof = model("roof", mesh_file(tmp_path, "roof", block((12, 10, 1.0), (0, 0, 9.0))), "<pose>1 0 0 0 0 0</pose>")
    world, notes = taken(tmp_path, slab + roof + crates(0.034))
    assert [mesh.name for mesh in world.meshes] == ["roof"]
    assert [box.centre[2] for box in world.boxes] == pytest.approx([0.5] * 3)
    assert world.fields[0].area == pytest.approx((-5.0, -5.0, 7.0, 5.0))
    assert "moved by -0.034 m" in notes


@pytest.mark.parametrize("furnished", [False, True])
def test_the_floor_of_a_house_that_is_one_mesh_is_the_ground(tmp_path, furnished):
    walls = [block((10, 0.2, 2.5), (0, y, 1.25)) for y in (-4, 4)] + [block((0.2, 8, 2.5), (x, 0, 1.25)) for x in (-5, 5)]
    house = mesh_file(tmp_path, "house", block((10, 8, 0.1), (0, 0, -0.05)), *walls, block((10, 8, 0.2), (0, 0, 2.6)))
    world, notes = taken(tmp_path, model("house", house, "<pose>0 0 0.3 0 0 0</pose>") + (crates(0.3) if furnished else ""))
    assert world.meshes[0].position == pytest.approx((0.0, 0.0, -0.002))
    assert [box.centre[2] for box in world.boxes] == pytest.approx([0.5] * (3 if furnished else 0))
    assert "house" in notes
    plan = floor_plan(world, 0.05)
    assert 60 < reachable_floor(plan, 0.0, -2.0, 0.2).sum() * 0.05**2 < 80


def test_a_solid_block_is_no_ground(tmp_path):
    world, _ = taken(tmp_path, model("tower", BOX.format("10 10 30"), "<pose>0 0 15 0 0 0</pose>"))
    assert world.boxes[0].centre == pytest.approx((0.0, 0.0, 15.0))


def test_a_world_of_which_nothing_can_be_taken_over_is_refused_with_the_reasons(tmp_path):
    with pytest.raises(BadInput, match=r"nothing in it can be taken over: models not found.*shelf"):
        taken(tmp_path, "<include><uri>model://shelf</uri></include>")
    assert not (tmp_path / "worlds" / "w").exists()


def test_a_world_that_cannot_be_imported_leaves_the_one_that_it_was_to_replace(tmp_path):
    taken(tmp_path, model("a", UNIT))
    broken = tmp_path / "broken.world"
    broken.write_text("<sdf><world name='w'><include><uri>model://shelf</uri></include></world></sdf>")
    with pytest.raises(BadInput):
        import_world(broken, tmp_path / "worlds" / "w", Options(replace=True))
    assert len(load_world(tmp_path / "worlds", "w").boxes) == 1
    assert [path.name for path in (tmp_path / "worlds").iterdir()] == ["w"]


def test_a_world_that_is_a_floor_and_nothing_else_is_taken_over(tmp_path):
    plane = "<collision name='c'><geometry><plane><normal>0 0 1</normal><size>9 9</size></plane></geometry></collision>"
    world, _ = taken(tmp_path, model("ground", plane))
    assert not solids(world)


def test_an_upright_plane_is_a_wall(tmp_path):
    plane = "<collision name='c'><geometry><plane><normal>1 0 0</normal><size>4 3</size></plane></geometry></collision>"
    world, _ = taken(tmp_path, model("wall", plane, "<pose>2 0 1.5 0 0 0</pose>"))
    (wall,) = solids(world)
    thin = np.abs(matrix(wall.orientation)[:, 2])
    assert thin == pytest.approx((1.0, 0.0, 0.0), abs=1e-6)


def test_colours_come_from_the_visual_beside(tmp_path):
    visual = "<visual name='v'><geometry><box><size>1 1 1</size></box></geometry><material>{}</material></visual>"
    red = model("a", UNIT + visual.format("<diffuse>0.9 0.1 0 1</diffuse>"))
    script = model(
        "b", UNIT + visual.format("<script><uri>file://media/materials/scripts/gazebo.material</uri><name>Gazebo/Wood</name></script>")
    )
    world, _ = taken(tmp_path, red + script)
    assert world.boxes[0].colour == (0.9, 0.1, 0.0)
    assert world.boxes[1].colour[0] > world.boxes[1].colour[2]


def test_place_wind_and_magnetic_field_are_taken_over(tmp_path):
    text = """<spherical_coordinates><latitude_deg>47.5</latitude_deg><longitude_deg>8.25</longitude_deg><elevation>400</elevation>
      </spherical_coordinates><wind><linear_velocity>1 2 0</linear_velocity></wind><magnetic_field>6e-6 2.3e-5 -4.2e-5</magnetic_field>"""
    world, _ = taken(tmp_path, text)
    assert (world.origin.latitude, world.origin.longitude, world.origin.altitude) == (47.5, 8.25, 400.0)
    assert world.wind.steady == (1.0, 2.0, 0.0)
    assert world.magnetic_field == pytest.approx((6e-6, 2.3e-5, -4.2e-5))


@pytest.mark.parametrize(
    ("text", "part"),
    [
        ("<sdf><world name='w'><model", r"test.world:1: not valid XML"),
        ("<robot name='r'/>", "the root is <robot>"),
        ("<sdf version='1.6'/>", "neither a <world> nor a <model>"),
        ("<sdf><world name='w'><model name='m'><pose>1 2 x 0 0 0</pose><link name='l'/></model></world></sdf>", r"test.world:1: <pose>"),
    ],
)
def test_broken_files_are_refused_in_one_line_and_leave_nothing(tmp_path, text, part):
    (tmp_path / "test.world").write_text(text)
    with pytest.raises(BadInput, match=part) as refused:
        import_world(tmp_path / "test.world", tmp_path / "worlds" / "w", Options())
    assert "\n" not in str(refused.value)
    assert not (tmp_path / "worlds" / "w").exists()


def test_a_world_that_is_there_is_not_overwritten_unless_asked(tmp_path):
    taken(tmp_path, model("a", UNIT))
    with pytest.raises(BadInput, match="is there already"):
        taken(tmp_path, model("a", UNIT))


@pytest.mark.parametrize(("bits", "touches"), [("0x01", True), ("01", True), ("65535", True), ("0", False), ("0x00", False)])
def test_what_touches_nothing_is_left_out_however_its_bits_are_written(tmp_path, bits, touches):
    surface = f"<surface><contact><collide_bitmask>{bits}</collide_bitmask></contact></surface>"
    ghost = BOX.format("1 1 1").replace("</geometry>", f"</geometry>{surface}")
    world = taken(
        tmp_path, model("solid", BOX.format("2 2 2"), "<pose>5 0 1 0 0 0</pose>") + model("ghost", ghost, "<pose>0 0 0.5 0 0 0</pose>")
    )
    assert len(world[0].boxes) == 1 + touches


def test_the_reader_of_meshes_says_nothing_of_missing_textures():
    assert not logging.getLogger(trimesh.__name__).isEnabledFor(logging.ERROR)
