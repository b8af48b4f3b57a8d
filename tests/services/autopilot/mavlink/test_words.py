"""What a refusal says is for who flies: counted as on the map, with names, and with what to do."""

import math

import pytest

from services.autopilot.mavlink.connection.refusals import plain
from tests.services.autopilot.mavlink.missions.test_missions import LAT, LON, item, upload
from tests.services.autopilot.mavlink.rig import PLANE, ROVER, Rig, acks, long, of, texts
from tests.services.autopilot.mavlink.test_fence_and_rally import item as plan_item
from uvf.mavlink import dialect as mav

NAN = math.nan
FENCE, RALLY = mav.MAV_MISSION_TYPE_FENCE, mav.MAV_MISSION_TYPE_RALLY
FAR = "that place is 4324 km away from the field: name one within 200 km"
CIRCLE, POINT = 5003, 5100


@pytest.mark.parametrize(
    ("bad", "kind", "result", "words"),
    [
        (item(0, place=(0, 0, 50.0)), 0, mav.MAV_MISSION_INVALID_PARAM5_X, f"Mission refused: item 1: {FAR}"),
        (
            item(0, place=(LAT, LON, 3e38)),
            0,
            mav.MAV_MISSION_INVALID_PARAM7,
            "Mission refused: item 1: that place is 3e+38 m high: name one",
        ),
        (
            item(0, command=17, p=(0, 0, 1e30, NAN)),
            0,
            mav.MAV_MISSION_INVALID_PARAM3,
            "Mission refused: item 1: a radius of 1e+30 m: name one",
        ),
        (
            item(0, command=31, p=(0, -1e30, 0, NAN)),
            0,
            mav.MAV_MISSION_INVALID_PARAM2,
            "Mission refused: item 1: a radius of -1e+30 m: name",
        ),
        (item(0, command=178, p=(0, 1e30, 0, NAN)), 0, mav.MAV_MISSION_INVALID_PARAM2, "Mission refused: item 1: speed 1e+30 is out of"),
        (
            item(0, frame=10),
            0,
            mav.MAV_MISSION_UNSUPPORTED_FRAME,
            "Mission refused: item 1: frame GLOBAL_TERRAIN_ALT is not supported: choose",
        ),
        (
            item(0, command=82),
            0,
            mav.MAV_MISSION_UNSUPPORTED,
            "Mission refused: item 1: NAV_SPLINE_WAYPOINT is not supported: leave it out",
        ),
        (
            plan_item(0, command=CIRCLE, p=(50.0, 0, 0, 0), place=(0, 0, 0.0), kind=FENCE),
            FENCE,
            mav.MAV_MISSION_INVALID_PARAM5_X,
            f"Fence refused: item 1: {FAR}",
        ),
        (
            plan_item(0, command=POINT, place=(0, 0, 0.0), kind=RALLY),
            RALLY,
            mav.MAV_MISSION_INVALID_PARAM5_X,
            f"Rally refused: item 1: {FAR}",
        ),
    ],
)
def test_a_plan_that_cannot_be_is_refused_before_it_is_asked_for(bad, kind, result, words):
    rig = Rig()
    rig.run()
    ack, heard = upload(rig, [bad], kind=kind)
    assert ack.type == result and any(text.startswith(words) for text in texts(heard)), texts(heard)
    assert rig.plane.asked == []


def whole(number, *p, x=LAT, y=LON, z=400.0, frame=0):
    return mav.MAVLink_command_int_message(PLANE, 1, frame, number, 0, 0, *p, x, y, z)


@pytest.mark.parametrize(
    ("command", "words"),
    [
        (whole(192, -1, 1, 0, NAN, x=0, y=0), f"Go to refused: {FAR}"),
        (whole(192, -1, 1, 0, NAN, z=1e8), "Go to refused: an altitude of 1e+08 m: name one within 100000 m"),
        (whole(192, -1, 1, 1e8, NAN), "Go to refused: a radius of 1e+08 m: name one within 200000 m"),
        (whole(192, -1, 1, 0, NAN, frame=10), "Go to refused: frame GLOBAL_TERRAIN_ALT is not supported: choose an altitude above home"),
        (whole(34, -1e8, NAN, NAN, NAN), "Orbit refused: a radius of -1e+08 m: name one within 200000 m"),
        (whole(34, NAN, NAN, NAN, NAN, x=0, y=0), f"Orbit refused: {FAR}"),
        (long(192, math.inf, 1, 0), "DO_REPOSITION refused: parameter 1 is inf: name a number within 1e+09, or NaN to leave it out"),
        (long(176, 1, 77, 3), "There is no such mode. There are Manual, Stabilized, Altitude"),
        (long(176, 1, 77, 3, system=ROVER), "There is no such mode. There are Manual, Hold, Mission, Return, Offboard"),
        (mav.MAVLink_set_mode_message(PLANE, 1, 9 << 16), "There is no mode 9.0 (custom_mode 0x90000). There are Manual"),
    ],
)
def test_a_command_that_cannot_be_is_refused_with_names_and_what_to_do(command, words):
    rig = Rig()
    rig.run()
    rig.say(command)
    heard = rig.run()
    assert any(text.startswith(words) for text in texts(heard)), texts(heard)
    assert rig.plane.asked == [] and mav.MAV_RESULT_ACCEPTED not in dict(acks(heard)).values()


@pytest.mark.parametrize(
    ("said", "words"),
    [
        (
            "uvf/milvus/srv/mission: broken uvf.v1.MissionRequest: mission.items[4].position.z: 3e+38 is not finite or beyond 1e+12",
            "item 4: the position cannot be that (3e+38 is not finite or beyond 1e+12)",
        ),
        (
            "uvf/milvus/srv/orbit: broken uvf.v1.OrbitRequest: radius: 1e+30 is more than 9",
            "the radius cannot be that (1e+30 is more than 9)",
        ),
        (
            "uvf/milvus/srv/vehicle_command: broken uvf.v1.VehicleCommandRequest: Error parsing message",
            "it is too large, or has a number that cannot be",
        ),
        (
            "uvf/milvus/srv/fence: 9999999 bytes, 2097152 are the most for uvf.v1.FenceRequest",
            "it is too large, or has a number that cannot be",
        ),
        ("the aircraft is outside of it", "the aircraft is outside of it"),
    ],
)
def test_what_the_border_says_is_put_into_plain_words(said, words):
    assert plain(said) == words


def test_a_station_reads_no_names_of_messages():
    rig = Rig()
    rig.run()
    rig.plane.refuse["set_mission"] = "uvf/plane/srv/mission: broken uvf.v1.MissionRequest: mission.items[0].hold: 1e+30 is more than 1"
    ack, heard = upload(rig, [item(0)])
    assert "Mission refused: item 1: the hold cannot be that (1e+30 is more than 1)" in texts(heard)
    assert of(heard, "MISSION_ACK")[-1].type == ack.type == mav.MAV_MISSION_INVALID
