"""Mode words of PX4 and back, and the list of modes that every vehicle sends."""

import math

import pytest

from schemas.messages import Mode
from services.autopilot.ground.multiplexer import SOURCES
from tests.services.autopilot.mavlink.rig import GCS, OTHER, PLANE, ROVER, Rig, acks, long, of
from uvf.mavlink import dialect as mav
from uvf.runtime.mavlink import modes

WORDS = {
    Mode.MODE_MANUAL: 65536,
    Mode.MODE_STABILIZED: 458752,
    Mode.MODE_ALTITUDE: 131072,
    Mode.MODE_POSITION: 196608,
    Mode.MODE_TAKEOFF: 33816576,
    Mode.MODE_HOLD: 50593792,
    Mode.MODE_MISSION: 67371008,
    Mode.MODE_RETURN: 84148224,
    Mode.MODE_LAND: 100925440,
    Mode.MODE_ORBIT: 16973824,
    Mode.MODE_OFFBOARD: 393216,
    Mode.MODE_FOLLOW: 134479872,
}


def test_a_rover_names_the_modes_that_it_takes():
    assert {row.mode for row in modes.TABLE if row.on_ground} == set(SOURCES)


def test_words_are_those_of_px4():
    assert {row.mode: row.custom for row in modes.TABLE} == WORDS


@pytest.mark.parametrize("mode", WORDS)
def test_words_lead_back_to_the_mode_in_every_form(mode):
    word = WORDS[mode]
    assert modes.from_custom(word).mode == mode
    assert modes.from_command(float(word), math.nan).mode == mode
    assert modes.from_command(float(word >> 16 & 255), float(word >> 24)).mode == mode


@pytest.mark.parametrize(
    "params", [(math.nan, math.nan), (4.0, math.nan), (-1.0, 0.0), (4.0, 300.0), (4.0, -1.0), (1e9, 0.0), (math.inf, 0.0)]
)
def test_what_is_no_mode_is_none(params):
    assert modes.from_command(*params) is None


def mode_list(rig, system):
    first = ask(rig, system, 1)
    return [first, *(ask(rig, system, i) for i in range(2, first.number_modes + 1))]


def ask(rig, system, index):
    rig.say(long(512, 435.0, float(index), system=system))
    return of(rig.run(0.04), "AVAILABLE_MODES", system)[0]


def test_plane_and_rover_send_the_same_list_with_the_five_that_buttons_need():
    rig = Rig()
    plane, rover = mode_list(rig, PLANE), mode_list(rig, ROVER)
    assert [m.get_payload() for m in plane] == [m.get_payload() for m in rover]
    assert [m.mode_index for m in plane] == list(range(1, len(plane) + 1))
    assert {33816576, 50593792, 67371008, 84148224, 100925440} <= {m.custom_mode for m in plane}
    assert {m.mode_name: m.standard_mode for m in plane}["Return"] == 0


def test_index_0_sends_all_and_beyond_the_end_is_refused():
    rig = Rig()
    rig.say(long(512, 435.0, 0.0))
    assert len(of(rig.run(), "AVAILABLE_MODES")) == len(modes.TABLE)
    rig.say(long(512, 435.0, 99.0))
    assert acks(rig.run()) == [(512, 2)]


def test_current_mode_tells_what_was_wanted_too():
    rig = Rig()
    rig.run(0.5)
    rig.plane.refuse["set_mode"] = "not now"
    rig.say(long(176, 1.0, 4.0, 4.0))
    told = of(rig.run(2.1), "CURRENT_MODE", PLANE)[-1]
    assert (told.custom_mode, told.intended_custom_mode) == (WORDS[Mode.MODE_HOLD], WORDS[Mode.MODE_MISSION])


def test_of_two_stations_that_fight_over_the_mode_the_last_word_counts_and_both_see_it():
    rig = Rig()
    rig.run(0.5)
    other = {"system": 250, "peer": OTHER}
    for mode, station in ((Mode.MODE_RETURN, {}), (Mode.MODE_HOLD, other), (Mode.MODE_MISSION, {})):
        rig.say(mav.MAVLink_set_mode_message(PLANE, 157, WORDS[mode]), **station)
    rig.run(0.1)
    assert [of(rig.heard(peer), "HEARTBEAT", PLANE)[-1].custom_mode for peer in (GCS, OTHER)] == [WORDS[Mode.MODE_MISSION]] * 2
    assert [request.mode for _, request in rig.plane.asked] == [Mode.MODE_RETURN, Mode.MODE_HOLD, Mode.MODE_MISSION]
