"""A URDF that an engine would choke on, or would take in silence, is refused in one line."""

import pytest

from uvf.models.scenario import ROOT
from uvf.models.urdf.model import check_urdf
from uvf.models.yaml_data import BadInput

WHOLE = (ROOT / "vehicles" / "burger" / "burger.urdf").read_text()
LINK = '<link name="{}"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial></link>'
JOINT = '<joint name="{}" type="fixed"><parent link="{}"/><child link="{}"/></joint></robot>'
MISTAKES = {
    "an axis of no direction": ('<axis xyz="0 1 0"/>', '<axis xyz="0 0 0"/>', "an axis of no direction"),
    "an axis of two numbers": ('<axis xyz="0 1 0"/>', '<axis xyz="0 1"/>', "three numbers must stand there"),
    "an origin that is none": ('<origin xyz="-0.032 0 0.060"/>', '<origin xyz="nan 0 0"/>', "three numbers must stand there"),
    "an infinite origin": ('<origin xyz="-0.032 0 0.060"/>', '<origin xyz="inf 0 0"/>', "three numbers must stand there"),
    "an infinite mass": ('<mass value="0.824"/>', '<mass value="inf"/>', 'burger.urdf:16: <mass value="inf">: a number must stand there'),
    "no inertia": ('ixx="0.002414"', 'ixx="0"', "must be numbers above zero"),
    "a box of no size": ('<box size="0.10 0.08 0.036"/>', '<box size="0.10 0 0.036"/>', "3 number(s) above zero"),
    "a cylinder of no length": ('length="0.143"', 'length="-1"', '<cylinder length="-1">'),
    "an unknown kind of joint": ('type="fixed"', 'type="fixd"', "type 'fixd'; did you mean 'fixed'?"),
    "a link twice": ("</robot>", LINK.format("base_link") + "</robot>", "link 'base_link' is given twice"),
    "a child of two": ("</robot>", JOINT.format("j", "castor_link", "wheel_left_link"), "is the child of two joints"),
    "a ring": (
        "</robot>",
        LINK.format("a") + LINK.format("b") + JOINT.format("ab", "a", "b")[:-8] + JOINT.format("ba", "b", "a"),
        "hangs on itself in a ring of joints",
    ),
}


@pytest.mark.parametrize("case", MISTAKES)
def test_a_mistake_is_one_line(tmp_path, case):
    old, new, why = MISTAKES[case]
    assert old in WHOLE
    path = tmp_path / "burger.urdf"
    path.write_text(WHOLE.replace(old, new, 1))
    with pytest.raises(BadInput) as caught:
        check_urdf(path, ())
    assert why in str(caught.value) and str(path) in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_folder_or_bytes_in_its_place_are_refused(tmp_path):
    path = tmp_path / "burger.urdf"
    path.mkdir()
    with pytest.raises(BadInput, match="no such file"):
        check_urdf(path, ())
    path = tmp_path / "bytes.urdf"
    path.write_bytes(bytes(range(256)))
    with pytest.raises(BadInput, match="not valid XML"):
        check_urdf(path, ())
