"""What a real QGroundControl stumbled over, told by the emulator as its user saw it."""

import copy

import pytest

from schemas.messages import Event, Mission, Mode
from services.autopilot.mavlink.connection.facts import VehicleState
from services.autopilot.mavlink.connection.statustext import counted_from_one
from services.autopilot.mavlink.missions.missions import TOLD_WITHIN
from services.autopilot.mavlink.telemetry.events import NEWS, EventNews
from tests.services.autopilot.mavlink.qgroundcontrol import PAGES, PLANS, STANDARD_NAMES, QGroundControl
from tests.services.autopilot.mavlink.rig import GCS, OTHER, PLANE, ROVER, Rig, acks, long, of, texts
from uvf.mavlink import dialect as mav

NAN = float("nan")
LAND, MISSION = 100925440, 67371008


@pytest.mark.parametrize("year", STANDARD_NAMES)
def test_the_button_mission_means_mission_in_every_generation_of_the_numbers(year):
    station = QGroundControl(Rig(), PLANE)
    station._modes()
    shown = station.shown_modes(year)
    assert shown["Mission"] == MISSION and shown["Land"] == LAND


def test_clear_is_answered_for_all_three_plans_at_once():
    rig = Rig()
    station = QGroundControl(rig, PLANE)
    rig.run()
    station.clear()
    assert station.complaints == []
    assert {name for name, _ in rig.plane.asked} == {"set_mission", "set_fence", "set_rally"}


def test_a_clear_ends_the_senders_own_upload_and_waits_for_anothers():
    rig = Rig()
    rig.run()
    rig.say(mav.MAVLink_mission_count_message(PLANE, 1, 3, 0))
    rig.run(0.04)
    rig.say(mav.MAVLink_mission_clear_all_message(PLANE, 1, 0), peer=OTHER)
    rig.run(0.04)
    assert [m.type for m in of(rig.heard(OTHER), "MISSION_ACK")] == [mav.MAV_MISSION_DENIED]
    rig.say(mav.MAVLink_mission_clear_all_message(PLANE, 1, 0))
    heard = rig.run(1.0)
    assert [m.type for m in of(heard, "MISSION_ACK")] == [mav.MAV_MISSION_ACCEPTED] and not of(heard, "MISSION_REQUEST_INT")[1:]


def asked_for_plan(rig, seconds):
    rig.say(mav.MAVLink_mission_request_list_message(PLANE, 1, 0))
    return [m.count for m in of(rig.run(seconds), "MISSION_COUNT")]


def test_a_plan_that_is_not_known_yet_is_not_told_as_empty_but_as_soon_as_it_is():
    rig = Rig()
    rig.plane.mission, mission = None, Mission(id=3)
    mission.items.add()
    assert asked_for_plan(rig, 1.4) == []
    rig.plane.mission = mission
    assert [m.count for m in of(rig.run(0.04), "MISSION_COUNT")] == [1]


def test_a_vehicle_that_tells_no_plan_for_long_has_none():
    rig = Rig()
    rig.plane.mission = None
    rig.run(TOLD_WITHIN)
    assert asked_for_plan(rig, 0.1) == [0]


def test_nothing_is_said_of_the_missions_progress_before_it_is_known():
    rig = Rig()
    rig.plane.progress = None
    assert not of(rig.run(2.0), "MISSION_CURRENT", PLANE)


def test_pause_on_a_rover_holds_it_whatever_the_altitude():
    rig = Rig()
    rig.rover.status.mode = Mode.MODE_MISSION
    rig.run()
    rig.say(long(192, -1.0, 1.0, 0.0, NAN, NAN, NAN, 312.5, system=ROVER))
    heard = rig.run()
    assert acks(heard) == [(192, mav.MAV_RESULT_ACCEPTED)] and not any("refused" in text for text in texts(heard))
    assert [(name, request.mode) for name, request in rig.rover.asked] == [("set_mode", Mode.MODE_HOLD)]


@pytest.mark.parametrize("system", [PLANE, ROVER])
@pytest.mark.parametrize("page", PAGES)
def test_every_page_finds_its_parameters_and_a_name_for_every_number(page, system):
    station = QGroundControl(Rig(), system)
    station._download_metadata()
    station._download_parameters()
    station.open(page)
    assert station.complaints == []


def test_a_page_without_its_parameter_would_be_noticed():
    station = QGroundControl(Rig(), PLANE)
    station._download_metadata()
    station._download_parameters()
    del station.parameters["SDLOG_MODE"]
    station.metadata["NAV_RCL_ACT"]["values"].clear()
    station.open("Safety")
    assert [text.split(":")[0] for text in station.complaints] == ["Parameters are missing from firmware", "Unknown"]


def test_each_vehicle_has_metadata_under_names_of_its_own():
    rig = Rig()
    uris = [QGroundControl(rig, system)._request(397, "COMPONENT_METADATA").uri for system in (PLANE, ROVER)]
    names = [set(vehicle.line.files) for vehicle in rig.service._vehicles.values()]
    assert uris[0] != uris[1] and not names[0] & names[1]


def test_the_first_text_comes_when_the_station_listens():
    station = QGroundControl(Rig(), PLANE)
    station.connect()
    station._listen(2.0)
    assert sum("not PX4" in text for text in station.texts) == 1


def test_whoever_says_nothing_to_the_vehicle_is_told_after_its_heartbeat():
    rig = Rig()
    rig.run(0.3)
    rig.say(mav.MAVLink_heartbeat_message(mav.MAV_TYPE_GCS, mav.MAV_AUTOPILOT_INVALID, 0, 0, 0, 3))
    heard = rig.run(2.0)
    kinds = [m.get_type() for m in heard if m.get_srcSystem() == PLANE and m.get_type() in ("HEARTBEAT", "STATUSTEXT")]
    assert kinds[0] == "HEARTBEAT" and "STATUSTEXT" in kinds


def event(t, text="battery low"):
    told = Event(text=text)
    told.timestamp.FromNanoseconds(round(t * 1e9))
    return told


def test_a_link_that_starts_again_says_no_old_event_once_more():
    rig = Rig()
    rig.run(2 * NEWS)
    rig.restart()
    rig.events = {"plane": [event(1.0, "old"), event(rig.t - 1.0, "of just now")]}
    heard = texts(rig.run(0.1))
    assert "of just now" in heard and "old" not in heard


def test_events_that_come_before_the_time_is_known_wait_and_a_new_simulation_is_news():
    news, latest = EventNews(), VehicleState()
    assert news.of(latest, [event(0.5), event(99.0)]) == []
    latest.clock = Rig().clock
    latest.clock.t_ns = 100 * 10**9
    assert [round(e.timestamp.ToNanoseconds() * 1e-9) for e in news.of(latest, [])] == [99]
    latest.clock.t_ns = 10**9
    assert len(news.of(latest, [event(0.5)])) == 1


def test_items_reached_are_no_texts_beside_their_message():
    assert EventNews().of(VehicleState(clock=Rig().clock), [event(0.0, "mission item 3 reached"), event(0.0, "camera trigger 7")]) == []


def test_items_are_counted_as_on_the_map():
    assert counted_from_one("Mission refused: item 0: too low; jumps to item 9") == "Mission refused: item 1: too low; jumps to item 10"


def test_satellites_come_with_dilutions():
    rig = Rig()
    rig.plane.gnss.horizontal_accuracy, rig.plane.gnss.vertical_accuracy = 0.9, 1.4
    fix = of(rig.run(0.5), "GPS_RAW_INT", PLANE)[-1]
    assert (fix.eph, fix.epv, fix.satellites_visible) == (90, 140, 12)


def test_an_aircraft_that_glides_is_not_ready_to_fly():
    rig = Rig()
    rig.plane.status.landed = False
    heard = rig.run(1.2)
    assert not of(heard, "SYS_STATUS", PLANE)[-1].onboard_control_sensors_health & mav.MAV_SYS_STATUS_PREARM_CHECK
    assert "PreArm: it glides, the motor is off" in texts(heard)
    assert of(heard, "HEARTBEAT", PLANE)[-1].system_status == mav.MAV_STATE_CRITICAL
    rig.plane.status.armed = True
    assert of(rig.run(1.2), "SYS_STATUS", PLANE)[-1].onboard_control_sensors_health & mav.MAV_SYS_STATUS_PREARM_CHECK


def test_console_logs_and_calibration_are_answered_at_once():
    rig = Rig()
    rig.run()
    shell = mav.MAVLink_serial_control_message(mav.SERIAL_CONTROL_DEV_SHELL, 2, 0, 0, 3, b"ls\n".ljust(70, b"\0"), PLANE, 1)
    rig.say(shell)
    rig.say(mav.MAVLink_log_request_data_message(PLANE, 1, 4, 180, 900))
    rig.say(mav.MAVLink_log_request_list_message(PLANE, 1, 0, 0xFFFF))
    rig.say(long(mav.MAV_CMD_PREFLIGHT_CALIBRATION, 1.0))
    heard = rig.run(0.04)
    assert b"no console" in bytes(of(heard, "SERIAL_CONTROL")[0].data)
    assert [(m.id, m.ofs, m.count) for m in of(heard, "LOG_DATA")] == [(4, 180, 0)]
    assert of(heard, "LOG_ENTRY")[0].num_logs == 0
    assert acks(heard) == [(241, mav.MAV_RESULT_UNSUPPORTED)]


def test_another_vehicle_of_the_link_is_no_traffic_to_a_station_that_hears_it():
    rig = Rig()
    assert not of(rig.run(2.5), "ADSB_VEHICLE")
    rig.say(long(512, float(mav.MAVLINK_MSG_ID_ADSB_VEHICLE)))
    assert acks(rig.run()) == [(512, mav.MAV_RESULT_TEMPORARILY_REJECTED)]


def test_the_emulator_knows_the_plans_it_clears():
    station = QGroundControl(Rig(), PLANE, lambda m: None if m.get_type() == "MISSION_ACK" and m.mission_type else copy.copy(m))
    station.rig.run()
    station.clear()
    assert station.complaints == [PLANS[1], PLANS[2]]
    assert station.rig.heard(GCS) is not None
