"""Broken and odd files of robots: each is refused in one line, or what was made of it is told."""

import shutil

import numpy as np
import pytest
import trimesh
from PIL import Image

from launch.vehicles.importing import import_vehicle
from launch.vehicles.inspection import inspect
from uvf.models.yaml_data import BadInput

ROUND = '<origin rpy="1.5708 0 0"/><geometry><cylinder radius="0.05" length="0.03"/></geometry>'
INERTIA = '<inertia ixx="{0}" iyy="{0}" izz="{0}" ixy="0" ixz="0" iyz="0"/>'
BOX = '<geometry><box size="0.3 0.2 0.06"/></geometry>'
SCAN = "<scan><horizontal><samples>360</samples><min_angle>-3.14</min_angle><max_angle>3.14</max_angle></horizontal></scan>"
LIDAR = f'<sensor type="ray" name="s"><ray>{SCAN}<range><min>0.1</min><max>8</max></range></ray></sensor>'


def hung(link, inside, place, joint="fixed", parent="base_link"):
    """A link and the joint that it hangs in."""
    axis = '<axis xyz="0 1 0"/>' if joint != "fixed" else ""
    frame = f'<parent link="{parent}"/><child link="{link}"/><origin xyz="{place}"/>{axis}'
    return f'<link name="{link}">{inside}</link><joint name="{link}_joint" type="{joint}">{frame}</joint>'


def wheel(side, y):
    inside = f'<inertial><mass value="0.2"/>{INERTIA.format(2e-4)}</inertial><visual>{ROUND}</visual><collision>{ROUND}</collision>'
    return hung(f"{side}_wheel", inside, f"0 {y} -0.02", "continuous")


SHAPES = f"<visual>{BOX}</visual><collision>{BOX}</collision>"
BODY = f'<link name="base_link"><inertial><mass value="3"/>{INERTIA.format(0.02)}</inertial>{SHAPES}</link>'
CASTOR = hung("castor", '<collision><geometry><sphere radius="0.02"/></geometry></collision>', "-0.12 0 -0.05")
LASER = hung("laser", "", "0.05 0 0.1") + f'<gazebo reference="laser">{LIDAR}</gazebo>'
ROBOT = f'<robot name="it">{BODY}{wheel("left", 0.12)}{wheel("right", -0.12)}{CASTOR}{LASER}</robot>'
XACRO = ROBOT.replace('name="it"', 'name="it" xmlns:xacro="http://www.ros.org/wiki/xacro"')
BOMB = "".join(f"<!ENTITY {b} '{f'&{a};' * 10}'>" for a, b in zip("abcdef", "bcdefg", strict=True))

POINTER = "version https://git-lfs.github.com/spec/v1\noid sha256:ab\nsize 1\n"
RUNS = "${__import__('os').abort()}"
GUESSED = "masses guessed from the size of the shapes; weigh them: base_link"
COMMON = "figures of sensors that cannot be, taken as of a common one"
RING = '<joint name="back" type="fixed"><parent link="laser"/><child link="base_link"/></joint>'


def but(*changes, of=ROBOT):
    """The robot with each first text replaced by the second."""
    for old, new in zip(changes[::2], changes[1::2], strict=True):
        assert old in of
        of = of.replace(old, new)
    return of


def more(inside):
    return but("</robot>", inside + "</robot>")


def mesh(name, part="collision", scale=""):
    return but(f"<{part}>{BOX}</{part}>", f'<{part}><geometry><mesh filename="{name}" {scale}/></geometry></{part}>')


REFUSED = {
    "empty": ("", "x.urdf:1: not valid XML: Document is empty"),
    "prose": ("hello robot", "x.urdf:1: not valid XML: Start tag expected"),
    "cut off": (ROBOT[:700], "not valid XML"),
    "bytes": (bytes(range(256)), "not valid XML"),
    "a page that says 404": ("<!DOCTYPE html><html><body>404</body></html>", "the outermost tag is <html>; a URDF begins with <robot>"),
    "pointer of Git LFS": (
        "version https://git-lfs.github.com/spec/v1\noid sha256:ab\nsize 1\n",
        "get the file itself with 'git lfs pull'",
    ),
    "bomb of entities": (f"<!DOCTYPE r [<!ENTITY a 'aaaaaaaaaa'>{BOMB}]><robot name='it'>&g;</robot>", "entity amplification"),
    "entity of a file": ('<!DOCTYPE r [<!ENTITY x SYSTEM "file:///etc/passwd">]><robot name="it">&x;</robot>', "x.urdf"),
    "links without joints": (f'<robot name="it">{BODY}</robot>', "no two wheels of one size on one axis; joints that turn: none"),
    "one wheel": (but(wheel("right", -0.12), ""), "joints that turn: left_wheel_joint"),
    "wheels that lie": (but('xyz="0 1 0"', 'xyz="0 0 1"'), "no two wheels of one size on one axis"),
    "wheels of two sizes": (but(wheel("left", 0.12), wheel("left", 0.12).replace("0.05", "0.04")), "no two wheels of one size on one axis"),
    "a ring of joints": (
        more(RING),
        "joints form a ring",
    ),
    "sdf without a model": ('<sdf version="1.7"></sdf>', "no <model> with joints in it"),
    "xacro: unknown name": (but('radius="0.02"', 'radius="${wheel_r}"', of=XACRO), "name 'wheel_r' is not defined"),
    "xacro: division by zero": (but('radius="0.02"', 'radius="${1/0}"', of=XACRO), "division by zero"),
    "xacro: argument missing": (
        but('radius="0.02"', 'radius="$(arg size)"', of=XACRO),
        "argument size; give it with --arg size:=VALUE",
    ),
    "xacro: runs a program": (
        but('radius="0.02"', f'radius="{RUNS}"', of=XACRO),
        "Use of invalid name(s): __import__",
    ),
    "xacro: includes itself": (
        but('<link name="laser">', '<xacro:include filename="x.urdf"/><link name="laser">', of=XACRO),
        "cut the ring",
    ),
}
TOLD = {
    "wheels that are fixed": (
        but("continuous", "fixed"),
        "wheels that are fixed in the file are taken to turn; check what drives it: left_wheel_joint, right_wheel_joint",
    ),
    "joint to no link": (but('<parent link="base_link"/><child link="castor"/>', '<parent link="hull"/><child link="castor"/>'),
                         "joints to links that are not there, left out with what hangs on them: castor_joint (hull)"),
    "a link on nothing": (more(f'<link name="stray"><visual>{BOX}</visual></link>'), "no joint of base_link, left out: stray"),
    "a link in two joints": (more('<joint name="again" type="fixed"><parent link="castor"/><child link="laser"/></joint>'),
                             "links that hang in several joints: the last one counts: laser (laser_joint, again)"),
    "two links of one name": (more('<link name="laser"/>'), "link 'laser' is given twice"),
    "two joints of one name": (but('name="castor_joint"', 'name="laser_joint"'), "joint 'laser_joint' is given twice"),
    "axis of zeros": (but('<axis xyz="0 1 0"/>', '<axis xyz="0 0 0"/>'), "joint 'left_wheel_joint': an axis of no direction"),
    "origin of two numbers": (but('xyz="0.05 0 0.1"', 'xyz="0.05 0"'), 'origin xyz="0.05 0">: three numbers must stand there'),
    "origin of words": (but('xyz="0.05 0 0.1"', 'xyz="a b c"'), "three numbers must stand there"),
    "origin of nan": (but('xyz="0.05 0 0.1"', 'xyz="nan 0 0"'), "three numbers must stand there"),
    "decimal commas": (but('xyz="0.05 0 0.1"', 'xyz="0,05 0 0,1"'), "three numbers must stand there"),
    "mass below zero": (but('<mass value="3"/>', '<mass value="-3"/>'), GUESSED),
    "mass without value": (but('<mass value="3"/>', "<mass/>"), GUESSED),
    "mass of a mountain": (but('<mass value="3"/>', '<mass value="1e9"/>'), "weighs 1e+09 kg in a box of 3.6 l, more than gold"),
    "inertia of nan": (but('ixx="0.02"', 'ixx="nan"'), "inertia that no such body has, replaced by that of its box: base_link"),
    "radius of zero": (but('radius="0.05"', 'radius="0"'), '<cylinder radius="0">: 1 number(s) above zero'),
    "box without size": (but('<box size="0.3 0.2 0.06"/>', "<box/>"), "3 number(s) above zero"),
    "shape unknown": (but('<sphere radius="0.02"/>', '<torus radius="0.02"/>'), "there is <torus>; there are: box, capsule"),
    "joint kind unknown": (but('name="castor_joint" type="fixed"', 'name="castor_joint" type="spherical"'), "type 'spherical'; there are"),
    "castor below the floor": (but('xyz="-0.12 0 -0.05"', 'xyz="-0.12 0 -0.15"'), "link 'castor' reaches 100 mm below the floor"),
    "mesh that is not there": (mesh("package://it/meshes/body.dae", "visual"), "meshes that are missing: package://it/meshes/body.dae"),
    "mesh that is prose": (mesh("prose.stl"), "prose.stl: no triangles in it"),
    "mesh of another kind": (mesh("body.fbx"), "body.fbx: meshes of this kind are not read; export it as STL, OBJ or DAE"),
    "mesh that is a pointer": (mesh("pointer.stl"), "pointer.stl: only a pointer of Git LFS is there"),
    "mesh of no size": (mesh("cube.stl", scale='scale="1 0 1"'), "cube.stl: a scale of 1 0 1 leaves nothing of it"),
    "mesh on the web": (mesh("https://example.org/body.stl", "visual"), "meshes that are missing: https:/example.org/body.stl"),
    "link without name": (but('<link name="laser">', "<link>"), "a link has no name"),
    "lidar of no beams": (but("<samples>360<", "<samples>0<"), f"{COMMON}: samples 0 of laser"),
    "lidar of nan": (but("<max>8<", "<max>nan<"), f"{COMMON}: max nan of laser"),
    "lidar inside out": (but("<min>0.1<", "<min>10<"), "range_min: 10 m is not below range_max, 8 m"),
    "lidar of very many beams": (but("<samples>360<", "<samples>1000000000<"), "beams lowered to 4096: laser"),
    "xacro: package unknown": (but("<link name=\"laser\">", '<xacro:include filename="$(find no)/a.xacro"/><link name="laser">', of=XACRO),
                               "not found, left out: no/a.xacro"),
}  # fmt: skip


@pytest.fixture
def source(tmp_path):
    """A folder for the file, with what stands beside it."""
    folder = tmp_path / "source"
    folder.mkdir()
    (folder / "prose.stl").write_text("this is no mesh")
    (folder / "pointer.stl").write_text(POINTER)
    (folder / "body.fbx").write_bytes(b"Kaydara FBX Binary")
    trimesh.creation.box((0.3, 0.2, 0.06)).export(folder / "cube.stl")
    return folder / "x.urdf"


def write(source, text):
    source.write_bytes(text if isinstance(text, bytes) else text.encode())
    return source


def test_the_robot_that_they_are_made_of_is_sound(source, tmp_path):
    import_vehicle(write(source, ROBOT), tmp_path / "it")
    assert inspect(tmp_path / "it").faults == []


@pytest.mark.parametrize("name", REFUSED)
def test_what_cannot_be_taken_is_refused_in_one_line_and_leaves_nothing_behind(source, tmp_path, name):
    text, answer = REFUSED[name]
    with pytest.raises(BadInput) as refused:
        import_vehicle(write(source, text), tmp_path / "vehicles" / "it")
    assert answer in str(refused.value)
    assert str(refused.value).startswith(str(source)) and "\n" not in str(refused.value)
    assert "root:" not in str(refused.value)
    assert not (tmp_path / "vehicles" / "it").exists()


@pytest.mark.parametrize("name", TOLD)
def test_what_is_taken_with_a_fault_is_told_by_the_notes_or_by_the_check(source, tmp_path, name):
    text, answer = TOLD[name]
    notes = import_vehicle(write(source, text), tmp_path / "it")
    assert any(answer in line for line in (*notes, *inspect(tmp_path / "it").faults))


def test_other_kinds_of_files_are_refused_by_their_name(tmp_path):
    shutil.copy(Image.__file__, tmp_path / "robot.blend")
    with pytest.raises(BadInput, match="files of this kind are not taken over"):
        import_vehicle(tmp_path / "robot.blend", tmp_path / "it")


def test_a_vehicle_of_millimetres_is_no_vehicle(source, tmp_path):
    sizes = np.array((300, 200, 60))
    large = but('<box size="0.3 0.2 0.06"/>', f'<box size="{" ".join(map(str, sizes))}"/>', LASER, "")
    import_vehicle(write(source, large), tmp_path / "it")
    assert any(
        "the vehicle is 300 m across; give metres (if these are millimetres: 0.3 m)" in line for line in inspect(tmp_path / "it").faults
    )
