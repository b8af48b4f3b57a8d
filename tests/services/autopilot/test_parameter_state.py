"""Parameters in force are told at the start and after each change, and outlive the instance that was told of them."""

import json

import msgspec

from services.autopilot.ground.params import GroundAutopilotParams
from services.autopilot.parameter_state import ToldParams

FILE = GroundAutopilotParams(link_timeout=7.0)


def test_they_are_told_once_and_again_after_a_change():
    told = ToldParams()
    first = told.news(0.0, FILE)
    assert first.changes == 0
    assert {name: json.loads(value) for name, value in first.values.items()} == msgspec.to_builtins(FILE)
    assert told.news(0.1, FILE) is None
    second = told.news(0.2, msgspec.structs.replace(FILE, low_action="hold"))
    assert (second.changes, second.values["low_action"]) == (1, '"hold"')


def test_the_next_instance_goes_on_with_what_was_set():
    told = ToldParams()
    told.news(0.0, FILE)
    said = told.news(0.2, msgspec.structs.replace(FILE, low_action="hold", tilt_max=0.5))
    heir = ToldParams()
    params = heir.taken_up(said, FILE)
    assert params == GroundAutopilotParams(link_timeout=7.0, low_action="hold", tilt_max=0.5)
    assert heir.news(1.0, params).changes == 1
