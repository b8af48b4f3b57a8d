"""Parameters by name: read, set until the autopilot says so, both ways that integers travel."""

import json
import struct

import pytest

from services.mavlink_bridge.connection import Wire
from services.mavlink_bridge.parameters import ParameterClient
from uvf.mavlink import dialect as mav

REAL, INT = mav.MAV_PARAM_TYPE_REAL32, mav.MAV_PARAM_TYPE_INT32


class Shelf:
    """The autopilot's half, for one parameter of each type."""

    def __init__(self, bytewise=True):
        self.wire = Wire(1, 1)
        self.parameters = ParameterClient(self.wire)
        self.parameters.bytewise = bytewise
        self.values = {"RTL_ALT": (60.0, REAL), "NAV_DLL_ACT": (2, INT)}
        self.fixed, self.silent, self.errors = set(), False, False
        self.bytewise = bytewise
        self.replies = []

    def coded(self, value, kind):
        return struct.unpack("<f", struct.pack("<i", value))[0] if kind == INT and self.bytewise else float(value)

    def run(self, seconds=0.2):
        for _ in range(round(seconds / 0.02)):
            self.wire.t += 0.02
            self.parameters.tick()
            for m in self.wire.take_out():
                self.hear(m)

    def hear(self, m):
        name = m.param_id
        if self.silent:
            return
        if name not in self.values:
            if self.errors:
                self.parameters._on_error(mav.MAVLink_param_error_message(255, 240, name.encode(), -1, 1))
            return
        if m.get_type() == "PARAM_SET" and name not in self.fixed:
            is_bytes = m.param_type == INT and self.bytewise
            value = struct.unpack("<i", struct.pack("<f", m.param_value))[0] if is_bytes else m.param_value
            self.values[name] = (value, m.param_type)
        value, kind = self.values[name]
        self.parameters.handlers()[22](mav.MAVLink_param_value_message(name.encode(), self.coded(value, kind), kind, 2, 0))

    def ask(self, name, value="", seconds=0.5):
        self.parameters.ask(name, value, self.replies.append)
        self.run(seconds)
        return self.replies[-1] if self.replies else None


@pytest.mark.parametrize("bytewise", [True, False], ids=["PX4", "ArduPilot"])
def test_numbers_are_read_and_set_as_the_autopilot_has_them(bytewise):
    shelf = Shelf(bytewise)
    assert json.loads(shelf.ask("NAV_DLL_ACT").params[0].value) == 2
    assert shelf.ask("NAV_DLL_ACT", "-5").accepted and shelf.values["NAV_DLL_ACT"][0] == -5
    assert shelf.ask("RTL_ALT", "75.5").accepted and shelf.values["RTL_ALT"][0] == 75.5


def test_what_stays_as_it_was_is_refused():
    shelf = Shelf()
    shelf.fixed.add("RTL_ALT")
    reply = shelf.ask("RTL_ALT", "80", 1.5)
    assert not reply.accepted and reply.reason == "RTL_ALT stays 60"


@pytest.mark.parametrize(
    ("name", "value", "why"),
    [
        ("RTL_ALT", '"high"', "is no number"),
        ("RTL_ALT", "true", "is no number"),
        ("NAV_DLL_ACT", "1.5", "1.5 is no whole number"),
        ("", "", "name one parameter"),
        ("A_NAME_THAT_IS_TOO_LONG", "", "at most 16"),
    ],
)
def test_what_cannot_be_meant_is_refused(name, value, why):
    reply = Shelf().ask(name, value)
    assert not reply.accepted and why in reply.reason


def test_an_unknown_name_ends_by_the_autopilots_error_or_by_its_silence():
    shelf = Shelf()
    shelf.errors = True
    assert "there is none of this name" in shelf.ask("NOPE", "", 1.0).reason
    shelf.errors = False
    assert "no answer" in shelf.ask("NOPE", "", 5.0).reason


def test_when_the_link_is_lost_nobody_waits():
    shelf = Shelf()
    shelf.silent = True
    shelf.ask("RTL_ALT")
    shelf.parameters.give_up("the link was lost")
    assert shelf.replies[-1].reason == "the link was lost"
