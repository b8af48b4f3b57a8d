"""URDF and xacro files: lines, packages, poses of links, and the plain file for engines."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from uvf.maths.rotations import matrix
from uvf.models.scenario import ROOT
from uvf.models.urdf.model import engine_urdf, load_urdf, read_urdf
from uvf.models.yaml_data import BadInput

MASS = '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
XACRO = f"""<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:include filename="$(find parts)/part.xacro"/>
  <xacro:property name="high" value="${{2 * 0.25}}"/>
  <link name="base_link">{MASS}
    <visual><geometry><mesh filename="package://parts/meshes/cup.stl" scale="0.001 0.001 0.001"/></geometry></visual>
  </link>
  <xacro:part name="tip" z="${{high}}"/>
</robot>"""
PART = f"""<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="part" params="name z">
    <joint name="${{name}}_joint" type="revolute">
      <parent link="base_link"/><child link="${{name}}"/><origin xyz="0.1 0 ${{z}}" rpy="0.2 0.3 -0.4"/><axis xyz="0 0 2"/>
    </joint>
    <link name="${{name}}">{MASS}</link>
  </xacro:macro>
</robot>"""


@pytest.fixture
def arm(tmp_path):
    """A package 'parts' beside the package of the robot."""
    for name, text in (("parts/part.xacro", PART), ("parts/meshes/cup.stl", "x"), ("robot/urdf/arm.urdf.xacro", XACRO)):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    return tmp_path / "robot" / "urdf" / "arm.urdf.xacro"


def test_xacro_is_expanded_and_packages_are_found_about_the_file(arm):
    model = load_urdf(arm)
    (cup,) = model.links["base_link"].visuals
    assert list(model.links) == ["base_link", "tip"]
    assert cup.mesh == arm.parents[2] / "parts" / "meshes" / "cup.stl"
    assert cup.size == (0.001, 0.001, 0.001)


def test_faults_know_their_line_through_macros(arm):
    part = arm.parents[2] / "parts" / "part.xacro"
    part.write_text(PART.replace("revolute", "revolt"))
    (fault,) = read_urdf(arm).faults
    assert str(fault).startswith(f"{part}:3: joint 'tip_joint': type 'revolt'; did you mean 'revolute'?")


def test_poses_of_links_follow_the_joints_angles(arm):
    tip = load_urdf(arm).link_poses({"tip_joint": 0.7})["tip"]
    assert tip.translation == pytest.approx((0.1, 0, 0.5))
    expected = Rotation.from_euler("ZYX", (-0.4, 0.3, 0.2)) * Rotation.from_euler("z", 0.7)
    assert matrix(tip.rotation) == pytest.approx(expected.as_matrix())


def test_the_engines_file_is_plain_and_the_same_model(arm):
    plain = engine_urdf(arm)
    assert "xacro" not in plain.read_text() and "package:" not in plain.read_text()
    whole, again = load_urdf(arm).link_poses(), load_urdf(plain).link_poses()
    assert all(np.allclose(whole[name].translation, again[name].translation) for name in whole)
    assert all(np.allclose(matrix(whole[name].rotation), matrix(again[name].rotation)) for name in whole)
    assert engine_urdf(arm) == plain


def test_contacts_and_bearings_reach_the_engine():
    burger = load_urdf(engine_urdf(ROOT / "vehicles" / "burger" / "burger.urdf"))
    assert dict(burger.links["castor_link"].contact)["lateral_friction"] == 0.02
    assert burger.links["base_link"].inertial.com == pytest.approx((-0.032, 0, 0.06))


@pytest.mark.parametrize(
    ("old", "new", "why"),
    [
        ("$(find parts)", "$(find prts)", "no folder 'prts' about the file"),
        ("2 * 0.25", "2 * hgh", "xacro cannot expand it"),
        ("xacro:part name", "xacro:prt name", "xacro cannot expand it"),
        ("/part.xacro", "/prt.xacro", "included file"),
    ],
)
def test_what_xacro_cannot_expand_is_one_line(arm, old, new, why):
    arm.write_text(XACRO.replace(old, new))
    with pytest.raises(BadInput, match=r"arm.urdf.xacro: ") as caught:
        load_urdf(arm)
    assert why in str(caught.value) and "\n" not in str(caught.value)
