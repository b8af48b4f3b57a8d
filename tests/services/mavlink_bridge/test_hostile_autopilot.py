"""What an autopilot may tell that cannot be true, or that is far too much of it: left out, counted, told once."""

import math

import pytest

from schemas.messages import Event, MissionItem
from services.mavlink_bridge.autopilot import RESTARTS_APART
from services.mavlink_bridge.connection import PARTS_MOST, TEXT_LETTERS, TEXTS_MOST, Wire
from services.mavlink_bridge.modes import MODES_MOST, Modes
from services.mavlink_bridge.station import AUTOPILOTS_MOST, RIVALS_MOST
from services.mavlink_bridge.transfers import STANDS_FOR, Transfers
from tests.services.mavlink_bridge.far_end import US, heartbeat, item, text
from tests.services.mavlink_bridge.test_station import HERE, Air
from tests.services.mavlink_bridge.test_vehicle import HOME, Scripted, attitude, current, home, position
from uvf.mavlink import dialect as mav
from uvf.mavlink.text_bucket import TEXTS_AT_ONCE, TEXTS_PER_SECOND
from uvf.runtime.mavlink.mission_items import packed, unpacked
from uvf.runtime.messages.validation import error_in

NOWHERE = 2_140_000_000  # 1e-7 deg
HUGE = 3e38


@pytest.fixture
def plane():
    scripted = Scripted()
    scripted.tell(position(), attitude(), home(), current())
    scripted.run(3.0)
    return scripted


def test_a_home_that_is_nowhere_on_earth_is_no_place_for_the_world_to_begin():
    scripted = Scripted(origin=None)
    for bad in (home(lat=NOWHERE), home(lon=-NOWHERE), home(lat=0, lon=0), home(alt=2**31 - 1)):
        scripted.run(0.5, bad, bad)
    assert scripted.vehicle.chart is None
    assert len([words for words in scripted.texts() if "HOME_POSITION is not taken" in words]) == 1
    assert scripted.vehicle.refusals.counts["HOME_POSITION"] == 8
    scripted.run(0.5, home())
    assert scripted.vehicle.chart is not None


@pytest.mark.parametrize("bad", [position(2000, lat=NOWHERE), position(2000, lon=-NOWHERE), position(2000, alt=2**31 - 1)])
def test_a_position_that_is_nowhere_is_left_out_and_the_last_good_one_counts(plane, bad):
    plane.run(0.04, position(1990), bad)
    nav = plane.vehicle.telemetry.nav(plane.vehicle.chart)
    assert abs(nav.position.x) < 1.0 and plane.vehicle.refusals.counts["GLOBAL_POSITION_INT"] == 1


def test_numbers_that_no_reader_would_take_are_left_out_of_what_is_told(plane):
    wind = mav.MAVLink_wind_cov_message(0, HUGE, HUGE, HUGE, 0, 0, 0, 0, 0)
    hud = mav.MAVLink_vfr_hud_message(HUGE, HUGE, 0, 65535, HUGE, HUGE)
    steers = mav.MAVLink_nav_controller_output_message(HUGE, HUGE, 0, 0, 65535, HUGE, HUGE, HUGE)
    orbit = mav.MAVLink_orbit_execution_status_message(0, HUGE, 0, HOME[0], HOME[1], HUGE)
    quality = mav.MAVLink_estimator_status_message(0, 0, 0, 0, 0, 0, 0, 0, HUGE, HUGE)
    plane.run(0.04, wind, hud, steers, orbit, quality, position(2000), attitude(2000))
    nav, status = plane.vehicle.telemetry.nav(plane.vehicle.chart), plane.vehicle.status()
    assert error_in(nav) == error_in(status) == "" and status.throttle == 1.0 and not status.HasField("circle")


def test_rates_without_measure_make_no_attitude(plane):
    plane.telling.clear()
    plane.run(0.02, position(2000), mav.MAVLink_attitude_quaternion_message(2000, 1, 0, 0, 0, HUGE, 0, 0))
    assert plane.vehicle.telemetry.nav(plane.vehicle.chart) is None


def test_an_item_at_a_height_without_measure_is_carried_and_given_back_and_the_mission_can_be_read(plane):
    plane.keeper.plans[0] = [item(0), item(1, z=HUGE), item(2, command=17, p=(0.0, 0.0, HUGE, 0.0))]
    plane.tell(current(ids=(5, 0, 0), total=3))
    plane.run(3.0)
    mission = plane.vehicle.plans.mission
    assert error_in(mission) == "" and [i.kind for i in mission.items] == [MissionItem.WAYPOINT, MissionItem.JUMP, MissionItem.JUMP]
    assert [unpacked(i.origin)[9] for i in mission.items[1:]] == [pytest.approx(HUGE), 50.0]


def test_an_item_beyond_the_mission_is_not_flown_at(plane):
    plane.keeper.plans[0] = [item(0), item(1)]
    plane.tell(current(seq=60_000, ids=(5, 0, 0), total=2), mav.MAVLink_mission_item_reached_message(60_000))
    plane.run(3.0)
    assert plane.vehicle.status().waypoint == 2
    assert (plane.vehicle.progress().current, plane.vehicle.progress().reached) == (2, 1)


def test_words_cannot_steer_a_terminal_and_markup_stays_words(plane):
    plane.run(0.1, text("\x1b[2J<b>fire</b>\r\nx", mav.MAV_SEVERITY_INFO))
    assert plane.said[-1] == (Event.INFO, "[2J<b>fire</b>  x")
    mode = mav.MAVLink_available_modes_message(1, 1, 0, 7, 0, b"\x1b[2Jevil\n")
    modes = Modes(mav.MAV_AUTOPILOT_PX4, mav.MAV_TYPE_FIXED_WING)
    modes.hear(mode)
    assert modes.name_of(7) == "[2Jevil"


def test_a_severity_that_is_none_is_no_emergency(plane):
    plane.run(0.1, text("hello", 200))
    assert plane.said[-1] == (Event.WARNING, "hello")


def test_a_flood_of_texts_is_told_in_part_and_that_it_is_once(plane):
    before = len(plane.said)
    for n in range(100):
        plane.run(0.1, *[text(f"text {n} {i}", mav.MAV_SEVERITY_INFO) for i in range(20)])
    assert len(plane.said) - before <= TEXTS_AT_ONCE + 10.2 * TEXTS_PER_SECOND + 1
    assert len([words for words in plane.texts() if "STATUSTEXT is not taken" in words]) == 1
    assert len(plane.vehicle.wire.texts) <= TEXTS_MOST


def test_texts_that_never_end_take_no_room():
    wire = Wire(1, 1)
    whole = [wire.hear_text(text("x" * 50, id=7, seq=n)) for n in range(100)]
    for id in range(1, 1000):
        wire.hear_text(text("x" * 50, id=id))
    assert len(wire._parts) <= PARTS_MOST
    assert max(len(said.text) for texts in whole for said in texts) <= TEXT_LETTERS


def test_a_list_of_modes_without_end_is_asked_for_once_a_line_and_remembered_in_part(plane):
    sent = len(plane.sent)
    lines = [mav.MAVLink_available_modes_message(255, 1, 0, n, 0, b"x") for n in range(100_000, 101_000)]
    plane.run(0.04, *lines)
    assert len([m for m in plane.sent[sent:] if "COMMAND_" in m.get_type()]) <= 2
    assert len(plane.vehicle.modes._by_custom) <= MODES_MOST


def test_a_clock_that_jumps_to_and_fro_is_no_restart_each_time(plane):
    for n in range(100):
        plane.run(0.04, position(90_000 if n % 2 else 500), attitude(90_000 if n % 2 else 500))
    assert plane.texts().count("the autopilot has started anew") <= 1 + 4.0 / RESTARTS_APART
    assert len([words for words in plane.texts() if "it goes to and fro" in words]) == 1


def test_a_plan_whose_id_changes_each_time_is_read_once_a_second(plane):
    plane.keeper.plans[0] = [item(0)]
    sent = len(plane.sent)
    for n in range(1, 200):
        plane.run(0.02, current(ids=(n, 0, 0), total=1))
    lists = [m for m in plane.sent[sent:] if m.get_type() == "MISSION_REQUEST_LIST"]
    assert 2 <= len(lists) <= 5


def test_an_upload_of_which_the_same_item_is_wanted_for_ever_ends():
    wire, ended = Wire(1, 1), []
    transfers = Transfers(wire)
    transfers.write(0, [unpacked(packed(item(n))) for n in range(3)], lambda good, why, opaque: ended.append(why))
    for asked in (1, 2):
        while wire.t < 2 * STANDS_FOR and not ended:
            wire.t += 0.5
            transfers.handlers()[51](mav.MAVLink_mission_request_int_message(*US, asked, 0))
            transfers.tick()
        assert ended == ["for 30 s the autopilot has asked for no item after item 1"]


def test_a_plan_of_as_many_items_as_the_wire_counts_is_not_read(plane):
    answered = plane.keeper.hear
    plane.keeper.hear = lambda t, messages: None
    plane.run(0.1, current(ids=(5, 0, 0), total=3))
    plane.run(0.1, mav.MAVLink_mission_count_message(*US, 65535, 0, 0))
    assert any("a plan of 65535 items" in words for words in plane.texts())
    plane.keeper.hear = answered


def test_heartbeats_of_all_ids_make_a_few_vehicles_and_one_line_and_a_named_one_is_always_taken():
    air = Air()
    air.station.expected = frozenset({200})
    told = []
    for t in range(5):
        for system in range(1, 255):
            air.say(heartbeat(), system)
        told += air.station.poll(float(t))
    assert len(air.station.autopilots) == AUTOPILOTS_MOST + 1 and 200 in air.station.autopilots
    assert len(told) == 1 and "is left alone, as all others that come" in told[0]


def test_a_flood_from_many_ports_makes_no_peers_few_lines_and_does_not_deafen():
    air = Air()
    air.say(heartbeat())
    air.station.poll(0.0)
    told = []
    for n in range(2000):
        air.say(heartbeat(custom=1), peer=("127.0.0.1", 10_000 + n))
        air.say(text("hello"), system=9, peer=("127.0.0.1", 20_000 + n))
        told += air.station.poll(0.001 * n)
    assert len(told) == len(air.station.autopilots[1].rivals) == RIVALS_MOST
    assert air.link.peers(2.0) == [HERE] and air.station.autopilots[1].peer == HERE


def test_what_does_not_fit_its_field_is_not_sent_and_told_once():
    air = Air()
    air.say(heartbeat())
    air.station.poll(0.0)
    for _ in range(3):
        air.station.send(1, [mav.MAVLink_mission_count_message(1, 1, 70_000, 0, 0), mav.MAVLink_param_set_message(1, 1, b"X", math.pi, 9)])
    assert air.station.poll(0.1) == ["MISSION_COUNT is not sent: a number does not fit its field"]
    assert [m.get_type() for m in air.sent(HERE)].count("PARAM_SET") == 3
