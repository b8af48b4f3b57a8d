"""The mission protocol: transactions, exact round trips, refusals that leave the old plan in force."""

import math
import struct

import pytest

from schemas.messages import Mission, MissionItem, MissionProgress, Vector3
from tests.services.autopilot.mavlink.rig import GCS, OTHER, PLANE, ROVER, Rig, of, texts
from uvf.mavlink import dialect as mav

LAT, LON = 407_701_234, 147_905_678
NAN = math.nan


def item(seq, command=16, frame=3, p=(0.0, 0.0, 0.0, NAN), place=(LAT, LON, 50.0), current=0, kind=0):
    return mav.MAVLink_mission_item_int_message(PLANE, 1, seq, frame, command, current, 1, *p, *place, kind)


def count(n, kind=0):
    return mav.MAVLink_mission_count_message(PLANE, 1, n, kind)


def upload(rig, items, lose=lambda n: False, kind=0):
    """As QGroundControl: says an item only when it is asked for; ``lose(n)`` drops the n-th packet either way."""
    packet = iter(range(10_000))
    rig.say(count(len(items), kind))
    for _ in range(2000):
        heard = rig.run(0.02)
        if ack := of(heard, "MISSION_ACK"):
            return ack[-1], heard
        for request in of(heard, "MISSION_REQUEST_INT"):
            if not lose(next(packet)) and not lose(next(packet)):
                rig.say(items[request.seq])
    raise AssertionError("no final acknowledgement")


def download(rig, system=255, peer=GCS, kind=0):
    rig.say(mav.MAVLink_mission_request_list_message(PLANE, 1, kind), system=system, peer=peer)
    rig.run()
    n = of(rig.heard(peer), "MISSION_COUNT")[-1].count
    for seq in reversed(range(n)):
        rig.say(mav.MAVLink_mission_request_int_message(PLANE, 1, seq, kind), system=system, peer=peer)
    rig.run()
    return sorted(of(rig.heard(peer), "MISSION_ITEM_INT"), key=lambda m: m.seq)


def content(message):
    """Everything of an item that must come back, floats as their bits."""
    bits = struct.pack("<5f", message.param1, message.param2, message.param3, message.param4, message.z)
    return message.seq, message.frame, message.command, message.autocontinue, bits, message.x, message.y


PLAN = [
    item(0, p=(2.0, 15.0, 0.0, NAN)),
    item(1, command=178, frame=2, p=(0.0, 18.5, -1.0, 0.0), place=(0, 0, 0.0)),
    item(2, frame=0, place=(LAT, LON, 412.3)),
    item(3, command=18, frame=6, p=(2.0, 0.0, -80.0, 1.0)),
    item(4, command=177, frame=2, p=(0.0, 3.0, 0.0, 0.0), place=(0, 0, 0.0)),
    item(5, command=20, frame=2, p=(0.0, 0.0, 0.0, 0.0), place=(0, 0, 0.0)),
]


def test_what_was_uploaded_comes_back_bit_for_bit_in_any_order():
    rig = Rig()
    rig.run()
    ack, _ = upload(rig, PLAN)
    assert ack.type == mav.MAV_MISSION_ACCEPTED and ack.opaque_id == rig.plane.mission.id != 0
    assert [content(m) for m in download(rig, system=250, peer=OTHER)] == [content(m) for m in PLAN]


def test_items_mean_in_the_system_what_they_mean_on_the_wire():
    rig = Rig()
    rig.run()
    upload(rig, PLAN)
    way, speed, absolute, orbit, jump, back = rig.plane.mission.items
    assert (way.kind, way.hold, way.acceptance_radius) == (MissionItem.WAYPOINT, 2.0, 15.0)
    assert way.position.z == pytest.approx(70.0)  # home lies at 20 m
    assert (speed.kind, speed.speed) == (MissionItem.SPEED, 18.5)
    assert absolute.position.z == pytest.approx(112.3, abs=1e-4)  # the origin lies at 300 m
    assert (orbit.kind, orbit.turns, orbit.radius) == (MissionItem.ORBIT, 2.0, -80.0)
    assert (jump.kind, jump.jump_to, jump.repeat) == (MissionItem.JUMP, 0, 3)
    assert back.kind == MissionItem.RETURN


def test_a_plan_of_a_mission_file_can_be_downloaded():
    rig = Rig()
    rig.plane.mission = Mission(
        id=7,
        items=[
            MissionItem(position=Vector3(x=100.0, y=-50.0, z=60.0), hold=3.0),
            MissionItem(kind=MissionItem.JUMP, jump_to=0, repeat=-1),
        ],
    )
    rig.run()
    way, jump = download(rig)
    assert (way.frame, way.command, way.param1, way.z) == (6, 16, 3.0, 40.0)  # home lies at 20 m
    assert (jump.command, jump.param1, jump.param2) == (177, 0.0, -1.0)
    upload(rig, [way, jump])
    again = rig.plane.mission.items[0].position
    assert (again.x, again.y, again.z) == pytest.approx((100.0, -50.0, 60.0), abs=0.02)


@pytest.mark.parametrize("lost", range(12))
def test_any_single_lost_packet_is_asked_for_again(lost):
    rig = Rig()
    rig.run()
    start = rig.t
    ack, _ = upload(rig, PLAN, lambda n: n == lost)
    assert ack.type == mav.MAV_MISSION_ACCEPTED
    assert rig.t - start < 1.0


def test_requests_are_repeated_every_250_ms_and_given_up_in_the_end():
    rig = Rig()
    rig.say(count(3))
    assert len(of(rig.run(1.02), "MISSION_REQUEST_INT")) in (4, 5)
    assert [m.type for m in of(rig.run(2.0), "MISSION_ACK")] == [mav.MAV_MISSION_OPERATION_CANCELLED]
    assert rig.plane.asked == []


def test_duplicates_and_items_out_of_order_do_no_harm():
    rig = Rig()
    rig.say(count(3))
    for seq in (0, 0, 2, 1, 1, 0, 2):
        rig.say(item(seq, place=(LAT + seq, LON, 50.0)))
    heard = rig.run()
    assert [m.type for m in of(heard, "MISSION_ACK")] == [mav.MAV_MISSION_ACCEPTED]
    assert [content(m)[-2] for m in download(rig)] == [LAT, LAT + 1, LAT + 2]


@pytest.mark.parametrize(
    ("bad", "result"),
    [
        (item(1, command=5000), mav.MAV_MISSION_UNSUPPORTED),
        (item(1, command=115, frame=2), mav.MAV_MISSION_UNSUPPORTED),
        (item(1, command=183, frame=2), mav.MAV_MISSION_UNSUPPORTED),
        (item(1, frame=10), mav.MAV_MISSION_UNSUPPORTED_FRAME),
        (item(1, place=(2_000_000_000, LON, 50.0)), mav.MAV_MISSION_INVALID_PARAM5_X),
        (item(1, place=(LAT, 2_000_000_000, 50.0)), mav.MAV_MISSION_INVALID_PARAM6_Y),
        (item(1, place=(LAT, LON, NAN)), mav.MAV_MISSION_INVALID_PARAM7),
        (item(1, p=(-5.0, 0.0, 0.0, 0.0)), mav.MAV_MISSION_INVALID_PARAM1),
        (item(1, p=(math.inf, 0.0, 0.0, 0.0)), mav.MAV_MISSION_INVALID),
        (item(1, command=177, frame=2, p=(9.0, 1.0, 0.0, 0.0)), mav.MAV_MISSION_INVALID_PARAM1),
    ],
)
def test_a_bad_item_is_refused_by_name_and_the_old_plan_stays(bad, result):
    rig = Rig()
    rig.run()
    upload(rig, PLAN)
    ack, heard = upload(rig, [PLAN[0], bad])
    assert ack.type == result
    assert any(text.startswith("Mission refused: item 2") for text in texts(heard))
    assert len(download(rig)) == len(PLAN)


def test_the_autopilots_refusal_keeps_the_old_plan():
    rig = Rig()
    rig.run()
    rig.plane.refuse["set_mission"] = "too far away"
    ack, heard = upload(rig, PLAN)
    assert ack.type == mav.MAV_MISSION_ERROR
    assert "Mission refused: too far away" in texts(heard)
    assert download(rig) == []


def test_a_second_partner_has_to_wait_and_the_first_may_start_anew():
    rig = Rig()
    rig.say(count(3))
    rig.run(0.02)
    rig.say(count(2), system=250, peer=OTHER)
    rig.run(0.02)
    assert [m.type for m in of(rig.heard(OTHER), "MISSION_ACK")] == [mav.MAV_MISSION_DENIED]
    assert upload(rig, PLAN)[0].type == mav.MAV_MISSION_ACCEPTED


def test_a_cancelled_upload_leaves_no_requests_behind():
    rig = Rig()
    rig.say(count(3))
    rig.run()
    rig.say(mav.MAVLink_mission_ack_message(PLANE, 1, mav.MAV_MISSION_OPERATION_CANCELLED, 0))
    assert of(rig.run(1.0), "MISSION_REQUEST_INT") == []


@pytest.mark.parametrize("message", [count(0), mav.MAVLink_mission_clear_all_message(PLANE, 1, 255)])
def test_clearing(message):
    rig = Rig()
    rig.run()
    upload(rig, PLAN)
    rig.say(message)
    assert [(m.type, m.opaque_id) for m in of(rig.run(), "MISSION_ACK")] == [(mav.MAV_MISSION_ACCEPTED, 0)]
    assert download(rig) == []


def test_what_is_out_of_range_or_not_offered_gets_its_code():
    rig = Rig()
    rig.say(mav.MAVLink_mission_request_int_message(PLANE, 1, 3, 0))
    rig.say(mav.MAVLink_mission_write_partial_list_message(PLANE, 1, 0, 1, 0))
    rig.say(count(501))
    rig.say(mav.MAVLink_mission_request_list_message(PLANE, 1, 3))
    rig.say(mav.MAVLink_mission_clear_all_message(PLANE, 1, 3))
    codes = [m.type for m in of(rig.run(), "MISSION_ACK")]
    assert codes == [13, 3, 4, 3, 3]


def test_the_older_request_gets_the_same_item():
    rig = Rig()
    rig.run()
    upload(rig, PLAN)
    rig.say(mav.MAVLink_mission_request_message(PLANE, 1, 2, 0))
    assert [content(m) for m in of(rig.run(), "MISSION_ITEM_INT")] == [content(PLAN[2])]


def test_camera_items_are_carried_but_not_flown():
    rig = Rig()
    rig.run()
    camera = item(1, command=2000, frame=2, p=(0.0, 2.0, 0.0, NAN), place=(0, 0, 0.0))
    ack, heard = upload(rig, [PLAN[0], camera])
    assert ack.type == mav.MAV_MISSION_ACCEPTED
    assert "Mission: camera and gimbal items are skipped" in texts(heard)
    skipped = rig.plane.mission.items[1]
    assert (skipped.kind, skipped.repeat) == (MissionItem.JUMP, 0)  # a jump that is never taken


def test_triggers_courses_and_circles_to_an_altitude_are_flown():
    rig = Rig()
    rig.run()
    plan = [
        item(0, command=206, frame=2, p=(25.0, 0.0, 1.0, 0.0), place=(0, 0, 0.0)),
        item(1, p=(0.0, 0.0, 0.0, 90.0)),
        item(2, p=(0.0, 0.0, 0.0, 0.0)),
        item(3, command=31, p=(0.0, -90.0, 0.0, 0.0)),
        item(4, command=203, frame=2, p=(0.0, 0.0, 0.0, 0.0), place=(0, 0, 0.0)),
    ]
    _, heard = upload(rig, plan)
    assert texts(heard) == []
    distance, east, any_course, circle, once = rig.plane.mission.items
    assert (distance.kind, distance.distance) == (MissionItem.TRIGGER_DISTANCE, 25.0)
    assert east.course == pytest.approx(0.0)
    assert not any_course.HasField("course")
    assert (circle.kind, circle.to_altitude, circle.radius) == (MissionItem.ORBIT, True, -90.0)
    assert once.kind == MissionItem.TRIGGER


def test_what_a_mission_file_says_of_courses_and_pictures_comes_back_after_a_download():
    rig = Rig()
    items = [
        MissionItem(position=Vector3(x=100.0, z=60.0), course=math.pi / 2),
        MissionItem(kind=MissionItem.ORBIT, position=Vector3(x=100.0, z=60.0), radius=90.0, to_altitude=True),
        MissionItem(kind=MissionItem.TRIGGER_DISTANCE, distance=30.0),
    ]
    rig.plane.mission = Mission(id=7, items=items)
    rig.run()
    north, circle, camera = download(rig)
    assert (north.param4, circle.command, camera.command, camera.param1) == (360.0, 31, 206, 30.0)
    upload(rig, [north, circle, camera])
    again = rig.plane.mission.items
    assert again[0].course == pytest.approx(math.pi / 2)
    assert again[1].to_altitude and again[1].radius == 90.0
    assert again[2].distance == 30.0


def test_progress_is_told_when_it_happens():
    rig = Rig()
    rig.run()
    upload(rig, PLAN)
    rig.run(0.5)
    rig.plane.progress.reached, rig.plane.progress.current = 0, 1
    heard = rig.run(0.04)
    assert [m.seq for m in of(heard, "MISSION_ITEM_REACHED", PLANE)] == [0]
    told = of(heard, "MISSION_CURRENT", PLANE)[0]
    assert (told.seq, told.total, told.mission_state, told.mission_id) == (1, 6, 2, rig.plane.mission.id)
    assert of(rig.run(0.5), "MISSION_ITEM_REACHED") == []


def test_the_last_item_is_told_to_be_the_current_one_before_it_is_reached():
    """On a busy machine both are known at once; MAVSDK and others would otherwise count back from 6 of 6 to 5 of 6."""
    rig = Rig()
    rig.run()
    upload(rig, PLAN)
    rig.run(0.5)
    progress = rig.plane.progress
    progress.reached = progress.current = len(rig.plane.mission.items) - 1
    progress.state = MissionProgress.COMPLETE
    told = [m for m in rig.run(0.04) if m.get_type() in ("MISSION_CURRENT", "MISSION_ITEM_REACHED")]
    reached = [k for k, m in enumerate(told) if m.get_type() == "MISSION_ITEM_REACHED"]
    assert told[reached[-1]].seq == told[reached[-1] - 1].seq == progress.current
    assert told[reached[-1] - 1].get_type() == "MISSION_CURRENT"


def test_set_current_by_message():
    rig = Rig()
    rig.run()
    upload(rig, PLAN)
    rig.say(mav.MAVLink_mission_set_current_message(PLANE, 1, 4))
    assert of(rig.run(), "MISSION_CURRENT", PLANE)[0].seq == 4
    rig.plane.refuse["set_current"] = "no such item"
    rig.say(mav.MAVLink_mission_set_current_message(PLANE, 1, 44))
    assert "Set waypoint refused: no such item" in texts(rig.run())


def test_a_guided_item_is_flown_to_and_kept_out_of_the_plan():
    rig = Rig()
    rig.run()
    rig.say(item(0, frame=3, current=2))
    assert [m.type for m in of(rig.run(), "MISSION_ACK")] == [mav.MAV_MISSION_ACCEPTED]
    ((name, goal),) = rig.plane.asked
    assert name == "goal" and goal.position.z == pytest.approx(70.0)


def test_a_landing_pattern_is_taken_with_its_mark_and_a_delay_is_spent_where_it_stands():
    rig = Rig()
    rig.run()
    nowhere = (0, 0, 0.0)
    plan = [
        item(0),
        item(1, command=93, frame=2, p=(20.0, -1.0, -1.0, -1.0), place=nowhere),
        item(2, command=189, frame=2, p=(0.0, 0.0, 0.0, 0.0), place=nowhere),
        item(3, command=31, p=(1.0, 80.0, 0.0, 1.0)),
        item(4, command=21, p=(0.0, 0.0, 0.0, NAN), place=(LAT, LON, 0.0)),
    ]
    ack, heard = upload(rig, plan)
    assert ack.type == mav.MAV_MISSION_ACCEPTED and texts(heard) == []
    way, delay, mark, circle, land = rig.plane.mission.items
    assert (delay.kind, delay.hold, delay.position) == (MissionItem.WAYPOINT, 20.0, way.position)
    assert mark.kind == MissionItem.LAND_START
    assert (circle.to_altitude, circle.radius, land.kind) == (True, 80.0, MissionItem.LAND)
    assert [content(m) for m in download(rig)] == [content(m) for m in plan]


def test_home_cruise_and_single_pictures_are_items_too():
    rig = Rig()
    rig.run()
    nowhere = (0, 0, 0.0)
    plan = [
        item(0),
        item(1, command=179, p=(0.0, 0.0, 0.0, 0.0), place=(LAT, LON, 5.0)),
        item(2, command=179, frame=2, p=(1.0, 0.0, 0.0, 0.0), place=nowhere),
        item(3, command=178, frame=2, p=(0.0, -2.0, -1.0, 0.0), place=nowhere),
        item(4, command=2000, frame=2, p=(0.0, 0.0, 1.0, 0.0), place=nowhere),
    ]
    ack, heard = upload(rig, plan)
    assert ack.type == mav.MAV_MISSION_ACCEPTED and texts(heard) == []
    _, there, here, cruise, picture = rig.plane.mission.items
    assert there.kind == here.kind == MissionItem.SET_HOME
    assert there.position.z == pytest.approx(25.0) and not here.HasField("position")
    assert (cruise.kind, cruise.speed, picture.kind) == (MissionItem.SPEED, 0.0, MissionItem.TRIGGER)
    rig.plane.mission = Mission(id=8, items=[MissionItem.FromString(m.SerializeToString()) for m in rig.plane.mission.items])
    for message in rig.plane.mission.items:
        message.ClearField("origin")
    rig.run()
    assert [(m.command, m.param1, m.param2) for m in download(rig)][1:4] == [(179, 0.0, 0.0), (179, 1.0, 0.0), (178, 0.0, -2.0)]


@pytest.mark.parametrize("command", [18, 21, 22, 31, 189])
def test_what_only_aircraft_do_is_refused_by_a_rover_as_unsupported(command):
    rig = Rig()
    rig.run()
    plan = item(0, command=command)
    rig.say(mav.MAVLink_mission_count_message(ROVER, 1, 1, 0))
    rig.run()
    plan.target_system = ROVER
    rig.say(plan)
    heard = rig.run()
    assert [m.type for m in of(heard, "MISSION_ACK")] == [mav.MAV_MISSION_UNSUPPORTED]
    assert any(text.endswith("is not for a ground vehicle") for text in texts(heard))


def test_a_delay_with_no_place_before_it_is_refused():
    rig = Rig()
    rig.run()
    ack, heard = upload(rig, [item(0, command=93, frame=2, p=(20.0, -1.0, -1.0, -1.0), place=(0, 0, 0.0))])
    assert ack.type == mav.MAV_MISSION_INVALID_SEQUENCE
    assert "Mission refused: item 1: a delay needs a place before it" in texts(heard)
