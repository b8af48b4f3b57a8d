"""Fence and rally points over MAVLink: what was uploaded counts and comes back, what was set elsewhere is shown, nonsense is refused."""

import math

import pytest

from schemas.messages import Breach, Fence, FenceZone, RallyPoints, Vector3
from tests.services.autopilot.mavlink import qgroundcontrol as qgc
from tests.services.autopilot.mavlink.missions.test_missions import LAT, LON, NAN, content, count, download, item, upload
from tests.services.autopilot.mavlink.qgroundcontrol import QGroundControl
from tests.services.autopilot.mavlink.rig import PLANE, ROVER, Rig, acks, long, of, texts
from uvf.mavlink import dialect as mav
from uvf.runtime.messages.plans.fences import fencing

STEP = 20_000  # 1e-7 deg, about 220 m


def vertex(seq, north, east, command=5001, corners=4.0, frame=0, group=0.0):
    place = (LAT + north * STEP, LON + east * STEP, 0.0)
    return item(seq, command=command, frame=frame, p=(corners, group, NAN, 0.0), place=place, kind=1)


def circle(seq, radius=100.0, command=5004, frame=5, latitude=LAT):
    return item(seq, command=command, frame=frame, p=(radius, 0.0, 0.0, 0.0), place=(latitude, LON, 0.0), kind=1)


SQUARE = [vertex(i, *corner) for i, corner in enumerate([(-2, -2), (-2, 2), (2, 2), (2, -2)])]
FENCE = [*SQUARE, circle(4), item(5, command=5000, frame=3, p=(0.0,) * 4, place=(LAT + STEP, LON, 60.0), kind=1)]
RALLY = [item(i, command=5100, p=(0.0, 0.0, 0.0, NAN), place=(LAT + i * STEP, LON, 50.0 + i), kind=2) for i in range(3)]


def room(rig, north, east):
    place = rig.service._vehicles["plane"].line.facts.world((LAT + north * STEP) * 1e-7, (LON + east * STEP) * 1e-7, 0.0)
    return fencing(rig.plane.fence).region.at((place.x, place.y))


@pytest.mark.parametrize(("kind", "plan"), [(1, FENCE), (2, RALLY)])
def test_what_was_uploaded_comes_back_bit_for_bit_and_can_be_cleared(kind, plan):
    rig = Rig()
    rig.run()
    ack, _ = upload(rig, plan, kind=kind)
    assert (ack.type, ack.mission_type) == (mav.MAV_MISSION_ACCEPTED, kind) and ack.opaque_id != 0
    assert [content(m) for m in download(rig, kind=kind)] == [content(m) for m in plan]
    told = of(rig.run(1.1), "MISSION_CURRENT", PLANE)[-1]
    assert {1: told.fence_id, 2: told.rally_points_id}[kind] == ack.opaque_id
    rig.say(mav.MAVLink_mission_clear_all_message(PLANE, 1, kind))
    assert [(m.type, m.mission_type, m.opaque_id) for m in of(rig.run(), "MISSION_ACK")] == [(0, kind, 0)]
    assert download(rig, kind=kind) == []


def test_the_id_changes_with_the_content_and_only_with_it():
    rig = Rig()
    rig.run()
    first, again = upload(rig, FENCE, kind=1)[0].opaque_id, upload(rig, FENCE, kind=1)[0].opaque_id
    other = upload(rig, FENCE[:5], kind=1)[0].opaque_id
    assert first == again != other


def test_the_fence_is_in_force_with_floor_ceiling_and_action_as_they_were():
    rig = Rig()
    rig.plane.fence = Fence(ceiling=120.0, action=Fence.HOLD)
    rig.run()
    upload(rig, FENCE, kind=1)
    fence = rig.plane.fence
    assert (fence.ceiling, fence.action, fence.HasField("floor")) == (120.0, Fence.HOLD, False)
    assert room(rig, 1, 0) > 50.0 and room(rig, 3, 0) < 0 and room(rig, 0, 0) == pytest.approx(-100.0, abs=0.1)
    assert fence.return_point.z == pytest.approx(80.0)  # home lies at 20 m


def test_zones_to_stay_in_count_together_within_a_group_and_one_group_is_enough():
    rig = Rig()
    rig.run()
    right = [vertex(4 + i, *corner) for i, corner in enumerate([(-2, 0), (-2, 4), (2, 4), (2, 0)])]
    upload(rig, [*SQUARE, *right], kind=1)
    assert room(rig, 0, 1) > 0 > room(rig, 0, 3) and room(rig, 0, -1) < 0
    other = [vertex(4 + i, *corner, group=1.0) for i, corner in enumerate([(-2, 0), (-2, 4), (2, 4), (2, 0)])]
    upload(rig, [*SQUARE, *other], kind=1)
    assert room(rig, 0, 3) > 0 and room(rig, 0, -1) > 0


def test_a_fence_that_was_set_elsewhere_is_shown_and_means_the_same_when_it_comes_back():
    rig = Rig()
    corners = [Vector3(x=x, y=y) for x, y in ((-300, -300), (300, -300), (300, 300), (-300, 300))]
    zones = [FenceZone(vertices=corners), FenceZone(centre=Vector3(x=50.0), radius=40.0, excludes=True)]
    rig.plane.fence = before = Fence(zones=zones, return_point=Vector3(x=-100.0, z=70.0), floor=10.0)
    rig.run()
    shown = download(rig, kind=1)
    assert [m.command for m in shown] == [5001, 5001, 5001, 5001, 5004, 5000]
    upload(rig, shown, kind=1)
    after = rig.plane.fence
    assert [(v.x, v.y) for v in after.zones[0].vertices] == [pytest.approx((v.x, v.y), abs=0.02) for v in corners]
    assert (after.zones[1].radius, after.zones[1].excludes, after.floor) == (40.0, True, 10.0)
    assert after.return_point.z == pytest.approx(before.return_point.z, abs=1e-3)


def test_rally_points_reach_the_autopilot_and_those_of_elsewhere_a_ground_station():
    rig = Rig()
    rig.run()
    upload(rig, RALLY, kind=2)
    assert [p.z for p in rig.plane.rally.points] == pytest.approx([70.0, 71.0, 72.0])
    rig.plane.rally = RallyPoints(points=[Vector3(x=10.0, y=20.0, z=90.0)])
    rig.run()
    ((command, frame, height),) = [(m.command, m.frame, m.z) for m in download(rig, kind=2)]
    assert (command, frame, height) == (5100, 3, 70.0)


@pytest.mark.parametrize(
    ("bad", "result", "why"),
    [
        ([*SQUARE[:3]], mav.MAV_MISSION_INVALID, "item 1: a polygon of 4 corners ends after 3"),
        ([*SQUARE[:2], circle(2)], mav.MAV_MISSION_INVALID, "item 1: a polygon of 4 corners ends after 2"),
        ([vertex(0, 0, 0, corners=2.0)], mav.MAV_MISSION_INVALID_PARAM1, "item 1: a polygon of 2 corners"),
        ([vertex(0, 0, 0, corners=NAN)], mav.MAV_MISSION_INVALID_PARAM1, "item 1: a polygon of nan corners"),
        ([vertex(0, 0, 0, group=-1.0)], mav.MAV_MISSION_INVALID_PARAM2, "item 1: group"),
        ([circle(0), circle(1, radius=-5.0)], mav.MAV_MISSION_INVALID_PARAM1, "item 2: radius -5"),
        ([circle(0, frame=10)], mav.MAV_MISSION_UNSUPPORTED_FRAME, "item 1: frame GLOBAL_TERRAIN_ALT"),
        ([item(0, kind=1)], mav.MAV_MISSION_UNSUPPORTED, "item 1: NAV_WAYPOINT is none of a fence"),
        (
            [item(0, command=5004, p=(9.0, 0, 0, 0), place=(2**31 - 1, LON, 0.0), kind=1)],
            mav.MAV_MISSION_INVALID_PARAM5_X,
            "item 1: latitude",
        ),
        (
            [vertex(i, *corner) for i, corner in enumerate([(-2, -2), (2, 2), (2, -2), (-2, 2)])],
            mav.MAV_MISSION_INVALID,
            "item 1: the polygon's edges from items 1 and 3 cross each other",
        ),
        ([circle(i) for i in range(33)], mav.MAV_MISSION_NO_SPACE, "33 zones"),
    ],
)
def test_a_bad_fence_is_refused_with_item_and_reason_and_the_old_one_stays(bad, result, why):
    rig = Rig()
    rig.run()
    upload(rig, FENCE, kind=1)
    ack, heard = upload(rig, bad, kind=1)
    assert (ack.type, ack.mission_type) == (result, 1)
    assert any(text.startswith(f"Fence refused: {why}") for text in texts(heard))
    assert len(download(rig, kind=1)) == len(FENCE)


def test_the_autopilots_refusal_is_told_with_its_reason():
    rig = Rig()
    rig.run()
    rig.plane.refuse["set_rally"] = "item 1: (4000, 0) is 2500 m outside of the fence"
    ack, heard = upload(rig, RALLY, kind=2)
    assert ack.type == mav.MAV_MISSION_INVALID
    assert "Rally refused: item 2: (4000, 0) is 2500 m outside of the fence" in texts(heard)
    rig.say(count(21, 2))
    assert [(m.type, m.mission_type) for m in of(rig.run(), "MISSION_ACK")] == [(mav.MAV_MISSION_NO_SPACE, 2)]


def test_clearing_everything_clears_all_three():
    rig = Rig()
    rig.run()
    for kind, plan in ((0, [item(0)]), (1, FENCE), (2, RALLY)):
        upload(rig, plan, kind=kind)
    rig.say(mav.MAVLink_mission_clear_all_message(PLANE, 1, 255))
    assert [(m.type, m.mission_type) for m in of(rig.run(0.3), "MISSION_ACK")] == [(0, 255)]
    assert [download(rig, kind=kind) for kind in (0, 1, 2)] == [[], [], []]


def test_a_breach_is_told_at_once_and_its_end_too():
    rig = Rig()
    rig.run()
    geofence = mav.MAV_SYS_STATUS_GEOFENCE
    heard = rig.run(1.1)
    assert of(heard, "FENCE_STATUS", PLANE) == []
    assert of(heard, "SYS_STATUS", PLANE)[-1].onboard_control_sensors_health & geofence, "MAVProxy would say 'fence breach'"
    upload(rig, FENCE, kind=1)
    rig.run(1.1)
    rig.plane.status.breach, rig.plane.status.breaches = Breach.BREACH_CEILING, 1
    heard = rig.run(0.06)
    (told,) = of(heard, "FENCE_STATUS", PLANE)
    assert (told.breach_status, told.breach_type, told.breach_count) == (1, mav.FENCE_BREACH_MAXALT, 1)
    assert told.breach_time == pytest.approx(rig.t * 1e3, abs=80)
    bits = of(heard, "SYS_STATUS", PLANE)[-1]
    assert bits.onboard_control_sensors_enabled & geofence and not bits.onboard_control_sensors_health & geofence
    rig.plane.status.breach = Breach.BREACH_NONE
    heard = rig.run(0.06)
    assert of(heard, "FENCE_STATUS", PLANE)[0].breach_status == 0
    assert of(heard, "SYS_STATUS", PLANE)[-1].onboard_control_sensors_health & geofence
    rig.plane.fence = Fence(zones=rig.plane.fence.zones, disabled=True)
    rig.run(1.1)
    assert not of(rig.run(1.1), "SYS_STATUS", PLANE)[-1].onboard_control_sensors_enabled & geofence


def prepared():
    rig = Rig()
    rig.run()
    upload(rig, FENCE, kind=1)
    upload(rig, RALLY, kind=2)
    return rig


def spoilt(kind):
    return lambda m: None if m.get_type() == "MISSION_ITEM_INT" and m.mission_type == kind else m


def test_qgroundcontrol_reads_both_as_it_connects_and_would_complain_without_them():
    station = QGroundControl(prepared(), PLANE)
    station.connect()
    assert station.complaints == []
    assert [len(station.plans[kind]) for kind in (1, 2)] == [len(FENCE), len(RALLY)]
    for kind in (1, 2):
        deprived = QGroundControl(prepared(), PLANE, spoilt(kind))
        deprived.connect()
        assert deprived.complaints == [qgc.PLANS[kind]]


@pytest.mark.parametrize("system", [PLANE, ROVER])
def test_qgroundcontrol_uploads_without_ever_repeating_itself(system):
    station = QGroundControl(Rig(), system)
    assert station.upload([item(0), item(1)], 0) < qgc.PLAN_WAIT
    assert station.upload(FENCE, 1) < qgc.PLAN_WAIT
    assert station.upload(RALLY, 2) < qgc.PLAN_WAIT
    assert station.complaints == []


def test_an_upload_that_goes_wrong_would_be_noticed():
    for lost, complaint in (("MISSION_REQUEST_INT", qgc.NOT_ALL_ITEMS), ("MISSION_ACK", qgc.NO_FINAL_ACK)):
        station = QGroundControl(Rig(), PLANE, lambda m, lost=lost: None if m.get_type() == lost else m)
        assert station.upload([item(0), item(1)]) is None
        assert station.complaints == [complaint]
    station = QGroundControl(Rig(), PLANE)
    station.upload([item(0, command=31000)])
    assert station.complaints == [qgc.PLANS[0]]


def test_five_hundred_items_arrive_within_twenty_seconds():
    station = QGroundControl(Rig(), PLANE)
    assert station.upload([item(seq, place=(LAT + seq, LON, 50.0)) for seq in range(500)]) < 20.0
    assert station.complaints == []


def test_items_of_old_partners_with_floats_are_taken():
    rig = Rig()
    rig.run()
    rig.say(count(2))
    rig.run(0.02)
    for seq, latitude in ((0, 40.77), (1, math.nan)):
        rig.say(mav.MAVLink_mission_item_message(PLANE, 1, seq, 3, 16, 0, 1, 0.0, 0.0, 0.0, 0.0, latitude, 14.79, 50.0))
        heard = rig.run(0.04)
    assert [m.type for m in of(heard, "MISSION_ACK")] == [mav.MAV_MISSION_INVALID_PARAM5_X]
    rig.say(count(1))
    rig.run(0.02)
    rig.say(mav.MAVLink_mission_item_message(PLANE, 1, 0, 3, 16, 0, 1, 0.0, 0.0, 0.0, 0.0, 40.77, 14.79, 50.0))
    assert [m.type for m in of(rig.run(), "MISSION_ACK")] == [mav.MAV_MISSION_ACCEPTED]
    assert [(m.x, m.y) for m in download(rig)] == [pytest.approx((407_700_000, 147_900_000), abs=30)]  # as floats have it


def test_the_fence_is_switched_off_and_on_by_command():
    rig = prepared()
    for wanted, disabled in ((0.0, True), (1.0, False)):
        rig.say(long(207, wanted))
        assert acks(rig.run()) == [(207, mav.MAV_RESULT_ACCEPTED)]
        assert rig.plane.fence.disabled is disabled and len(rig.plane.fence.zones) == 2
    rig.say(long(207, 7.0))
    assert acks(rig.run()) == [(207, mav.MAV_RESULT_DENIED)]
