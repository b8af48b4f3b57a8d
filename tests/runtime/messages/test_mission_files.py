"""A mission file's lines keep their meaning, and a mission's id tells its content."""

import math
import zlib

import pytest

from schemas.messages import MissionItem
from uvf.models.mission.file import Waypoint
from uvf.runtime.messages.plans import mission_files
from uvf.runtime.messages.plans.plan_ids import mission_id


def test_a_line_of_a_mission_file_becomes_an_item():
    message = mission_files.item_from_file(Waypoint(x=1.0, y=2.0, z=math.pi, kind="jump", jump_to=3, repeat=-1))
    assert (message.kind, message.jump_to, message.repeat) == (MissionItem.JUMP, 3, -1)
    assert (message.position.x, message.position.y, message.position.z) == (1.0, 2.0, math.pi)


@pytest.mark.parametrize("field", ["acceptance_radius", "hold", "radius", "turns", "speed"])
def test_no_number_of_a_line_is_left_out(field):
    assert getattr(mission_files.item_from_file(Waypoint(x=0.0, y=0.0, **{field: 7.5})), field) == 7.5


def test_an_id_tells_missions_apart():
    one, other = MissionItem(repeat=1), MissionItem(repeat=2)
    assert mission_id([one]) == mission_id([MissionItem(repeat=1)]) != mission_id([other])
    assert mission_id([one, other]) != mission_id([other, one])


def test_only_an_empty_mission_has_the_id_0(monkeypatch):
    assert mission_id([]) == 0
    monkeypatch.setattr(zlib, "crc32", lambda content: 0)
    assert mission_id([MissionItem()]) == 1
