"""Whatever way a xacro names its files, they are found without a ROS installation, and what they hold knows its line."""

import os

import pytest

from uvf.models.urdf.marked import LINE
from uvf.models.urdf.source import XacroValues, read_xml
from uvf.models.yaml_data import BadInput

SPACE = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'


def robot(*lines):
    return "\n".join((f'<robot name="bot" {SPACE}>', *lines, "</robot>"))


@pytest.fixture
def package(tmp_path):
    """A package 'parts' with wheels and a size, beside the package of the robot."""
    files = {
        "parts/package.xml": "<package><name>parts</name></package>",
        "parts/urdf/left.xacro": robot('<link name="left"/>'),
        "parts/urdf/right.xacro": robot('<link name="right"/>'),
        "parts/urdf/all.xacro": robot('<xacro:include filename="left.xacro"/>', '<xacro:include filename="right.xacro"/>'),
        "parts/size.yaml": "wheel: {radius: 0.25}",
        "robot/urdf/none.xacro": "",
    }
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    return tmp_path


@pytest.fixture
def links(package):
    """Reads a robot of these lines: its links, name -> "file:line" without the folder of the test."""

    def read(*lines, arguments=None, note=None):
        path = package / "robot/urdf/bot.urdf.xacro"
        path.write_text(robot(*lines))
        found = read_xml(path, XacroValues(arguments or {}), note)
        return {tag.get("name"): os.path.relpath(tag.get(LINE), package) for tag in found.findall("link")}

    return read


LEFT, RIGHT = {"left": "parts/urdf/left.xacro:2"}, {"right": "parts/urdf/right.xacro:2"}


@pytest.mark.parametrize(
    "lines",
    [
        ['<xacro:include filename="$(find parts)/urdf/left.xacro"/>'],
        ['<xacro:include filename="../../parts/urdf/left.xacro"/>'],
        ['<xacro:property name="side" value="left"/>', '<xacro:include filename="$(find parts)/urdf/${side}.xacro"/>'],
        ['<xacro:property name="of" value="parts"/>', '<xacro:include filename="$(find ${of})/urdf/left.xacro"/>'],
        ['<xacro:property name="at" value="$(find parts)/urdf"/>', '<xacro:include filename="${at}/left.xacro"/>'],
        ['<xacro:property name="at" value="$(find robot)/.."/>', '<xacro:include filename="${at}/parts/urdf/left.xacro"/>'],
        ['<xacro:include filename="$(find parts)/urdf/$(arg side).xacro"/>'],
        ['<xacro:include filename="$(find parts)/urdf/le*.xacro"/>'],
        ['<xacro:include filename="$(find parts)/urdf/$(arg side)*.xacro"/>'],
        ['<xacro:property name="of" value="parts"/>', '<xacro:include filename="$(find ${of})/urdf/le*.xacro"/>'],
        ['<xacro:include filename="$(find parts)/urdf/left.xacro" optional="true"/>'],
        ['<xacro:include filename="$(find parts)/urdf/$(arg side).xacro" optional="true"/>'],
        ['<xacro:include filename="$(find parts)/urdf/left.xacro"/>', '<xacro:include filename="not there.xacro" optional="true"/>'],
        ['<xacro:include filename="$(find parts)/urdf/left.xacro"/>', '<xacro:include filename="$(arg side).xacro" optional="1"/>'],
        ['<xacro:macro name="m"><xacro:include filename="../../parts/urdf/left.xacro"/></xacro:macro>', "<xacro:m/>"],
    ],
)
def test_an_included_file_is_found_and_its_link_knows_its_line(links, lines):
    assert links('<xacro:arg name="side" default="right"/>', *lines, arguments={"side": "left"}) == LEFT


def test_an_included_file_includes_others_beside_it(links):
    assert links('<xacro:include filename="$(find parts)/urdf/all.xacro"/>', '<link name="base"/>') == {
        **LEFT,
        **RIGHT,
        "base": "robot/urdf/bot.urdf.xacro:3",
    }


def test_a_file_by_its_whole_path(links, package):
    assert links(f'<xacro:include filename="{package}/parts/urdf/left.xacro"/>') == LEFT


def test_many_files_by_one_computed_name(links):
    lines = ['<xacro:property name="at" value="$(find parts)/urdf"/>', '<xacro:include filename="${at}/*t.xacro"/>']
    assert links(*lines) == {**LEFT, **RIGHT}


@pytest.mark.parametrize("missing", ["nowhere.xacro", "none.xacro", "$(find nowhere)/x.xacro"])
def test_what_is_not_reached_need_not_be_there_or_whole(links, missing):
    assert links('<xacro:if value="0">', f'<xacro:include filename="{missing}"/>', "</xacro:if>", '<link name="base"/>')


def test_figures_are_read_from_yaml_and_arguments(package):
    path = package / "robot/bot.xacro"
    path.write_text(robot("<link name=\"${xacro.load_yaml('$(find parts)/size.yaml').wheel.radius} $(arg name)\"/>"))
    assert read_xml(path, XacroValues({"name": "x"})).find("link").get("name") == "0.25 x"


def test_names_of_files_in_the_robot_are_those_of_the_originals(package):
    path = package / "robot/bot.xacro"
    path.write_text(
        robot(
            '<xacro:property name="of" value="parts"/>',
            '<mesh a="file://$(find parts)/a.stl" b="$(find ${of})/b.stl"/>',
            "<plugin>$(find ${of})/d.yaml</plugin>",
        )
    )
    found = read_xml(path)
    parts = package / "parts"
    assert dict(found.find("mesh").attrib) == {"a": f"file://{parts}/a.stl", "b": f"{parts}/b.stl"}
    assert found.find("plugin").text == f"{parts}/d.yaml"


def test_lines_are_told_below_the_folder_one_is_in_where_the_file_was_so_named(package, monkeypatch):
    (package / "robot/bot.xacro").write_text(robot('<xacro:include filename="../parts/urdf/left.xacro"/>'))
    monkeypatch.chdir(package)
    (link,) = read_xml((package / "robot/bot.xacro").relative_to(package)).findall("link")
    assert link.get(LINE) == "robot/../parts/urdf/left.xacro:2"


@pytest.mark.parametrize(
    ("line", "why"),
    [
        ('<xacro:include filename="${1 + 1}.xacro"/>', "included file '.*robot/urdf/2.xacro' is not there"),
        ("<xacro:include filename=\"$(find ${'no' + 'where'})/x.xacro\"/>", "no folder 'nowhere' about the file"),
        ('<mesh filename="$(find nowhere)/x.stl"/>', "no folder 'nowhere' about the file"),
        ("<link name=\"${xacro.load_yaml('none.yaml').x}\"/>", "bot.urdf.xacro: xacro cannot expand it: .*robot/urdf/none.yaml"),
        ('<xacro:include filename="none.xacro"/>', "robot/urdf/none.xacro:1: not valid XML"),
        ("<xacro:include filename=\"${'none'}.xacro\"/>", "robot/urdf/none.xacro:1: not valid XML"),
        ('<xacro:include filename="bot.urdf.xacro"/>', "uses itself; cut the ring"),
    ],
)
def test_what_cannot_be_expanded_is_told_in_one_line_by_the_names_of_the_originals(links, line, why):
    with pytest.raises(BadInput, match=why) as caught:
        links(line)
    assert "\n" not in str(caught.value) and "uvf-xacro" not in str(caught.value)


def test_of_a_strangers_robot_what_is_not_there_is_left_out_and_noted(links):
    notes = []
    lines = ['<xacro:include filename="$(find nowhere)/x.xacro"/>', '<xacro:include filename="${1 + 1}.xacro"/>', '<link name="base"/>']
    assert list(links(*lines, note=notes.append)) == ["base"]
    assert notes[0] == "included file not found, left out: nowhere/x.xacro"
    assert notes[1].endswith("robot/urdf/2.xacro")


def test_macros_of_a_file_that_is_not_there_are_told_as_that_file(links):
    with pytest.raises(BadInput, match=r"unknown macro name: xacro:arm; .*not there.*: elsewhere/arm\.xacro$"):
        links('<xacro:include filename="$(find elsewhere)/arm.xacro"/>', "<xacro:arm/>", note=lambda text: None)


def test_parts_are_turned_on_by_the_environment_and_those_that_can_be_are_told(package, monkeypatch):
    monkeypatch.delenv("BOT_LASER", raising=False)
    path, told = package / "robot/urdf/bot.urdf.xacro", []
    lines = ('<xacro:if value="$(optenv BOT_LASER 0)"><link name="laser"/></xacro:if>', '<link name="$(optenv BOT_NAME it)"/>')
    path.write_text(robot(*lines))
    assert [link.get("name") for link in read_xml(path, note=told.append).findall("link")] == ["it"]
    assert told == ["parts that --env NAME=1 or NAME=0 turns on or off: BOT_LASER"]
    given = XacroValues(environment={"BOT_LASER": "1", "BOT_NAME": "that"})
    assert [link.get("name") for link in read_xml(path, given).findall("link")] == ["laser", "that"]
    assert "BOT_LASER" not in os.environ


def test_what_name_space_the_prefix_stands_for_counts_for_nothing(package):
    """Robots of ROS's first years declare a schema of Gazebo's."""
    path = package / "robot/urdf/old.urdf.xacro"
    path.write_text(
        robot('<xacro:include filename="$(find parts)/urdf/all.xacro"/>').replace(
            "http://www.ros.org/wiki/xacro", "http://playerstage.sourceforge.net/gazebo/xmlschema/#interface"
        )
    )
    assert [link.get("name") for link in read_xml(path).iter("link")] == ["left", "right"]
