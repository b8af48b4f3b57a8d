"""Guided commands: where a vehicle is sent, how it circles, how high and how fast; at a field 300 m above the sea."""

import math

import pytest

from schemas.messages import MissionItem, Mode, Vector3
from tests.services.autopilot.mavlink.rig import ORIGIN as FIELD
from tests.services.autopilot.mavlink.rig import PLANE, ROVER, Rig, acks, long, of, texts
from uvf.mavlink import dialect as mav
from uvf.runtime.mavlink.mission_items import ORIGIN

NAN = math.nan
ACCEPTED, REJECTED, DENIED, UNSUPPORTED, BAD_FRAME = 0, 1, 2, 3, 9
AMSL, ABOVE_HOME, TERRAIN = 0, 6, 10
X, Y = 407_700_000, 147_900_000  # the world's origin
HOME = 20.0  # m, world
SEA = 300.0  # m: the world's z is that much less than the altitude above sea level


def whole(number, *p, frame=AMSL, x=X, y=Y, z=NAN, system=PLANE):
    """COMMAND_INT; parameters left out are NaN."""
    return mav.MAVLink_command_int_message(system, 1, frame, number, 0, 0, *p, *[NAN] * (4 - len(p)), x, y, z)


def rig_in(mode=Mode.MODE_HOLD, circle=True):
    rig = Rig()
    rig.plane.status.mode = mode
    if not circle:
        rig.plane.status.ClearField("circle")
    rig.run()
    return rig


def asked(rig, command, vehicle=None, result=ACCEPTED, seconds=0.2):
    """What the vehicle has been asked for by a command that is answered as expected."""
    vehicle = vehicle or rig.plane
    vehicle.asked.clear()
    rig.say(command)
    heard = rig.run(seconds)
    assert acks(heard) == [(command.command, result)], texts(heard)
    assert result == ACCEPTED or texts(heard)
    return vehicle.asked


def xyz(v):
    return v.x, v.y, v.z


# take-off


@pytest.mark.parametrize(
    ("command", "z"),
    [
        (long(22, NAN, NAN, NAN, NAN, NAN, NAN, 420.0), 120.0),
        (whole(22, frame=AMSL, z=420.0), 120.0),
        (whole(22, frame=ABOVE_HOME, z=50.0), HOME + 50.0),
    ],
)
def test_a_take_off_has_its_altitude_above_the_sea_or_above_home(command, z):
    rig = rig_in()
    rig.plane.nav.position.z = HOME
    ((name, order),) = asked(rig, command)
    assert (name, order.takeoff.altitude, order.source) == ("order", pytest.approx(z), "mavlink")


def test_a_take_off_without_an_altitude_is_the_mode():
    ((name, request),) = asked(rig_in(), long(22))
    assert (name, request.mode) == ("set_mode", Mode.MODE_TAKEOFF)


def test_a_take_off_altitude_that_was_meant_above_home_is_refused_with_an_explanation():
    rig = rig_in()
    rig.say(long(22, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 50.0))
    heard = rig.run()
    assert acks(heard) == [(22, DENIED)]
    assert "Takeoff refused: the altitude is above sea level (home is at 320 m), 50 m is too low" in texts(heard)
    assert rig.plane.asked == []


# go to


def test_everything_left_out_is_hold_here():
    ((name, request),) = asked(rig_in(Mode.MODE_MISSION), long(192, -1.0, 1.0, 0.0))
    assert (name, request.mode) == ("set_mode", Mode.MODE_HOLD)


@pytest.mark.parametrize("mode", [Mode.MODE_HOLD, Mode.MODE_ORBIT, Mode.MODE_RETURN])
def test_only_an_altitude_keeps_the_circle(mode):
    ((name, order),) = asked(rig_in(mode), long(192, -1.0, 1.0, 0.0, NAN, NAN, NAN, 450.0))
    assert (name, order.altitude.altitude) == ("order", 150.0)


def test_only_an_altitude_from_a_mission_holds_first():
    (first, mode), (second, order) = asked(rig_in(Mode.MODE_MISSION, circle=False), long(192, -1.0, 1.0, 0.0, NAN, NAN, NAN, 450.0))
    assert (first, mode.mode, second, order.altitude.altitude) == ("set_mode", Mode.MODE_HOLD, "order", 150.0)


@pytest.mark.parametrize(
    ("p", "radius", "speed"),
    [
        ((-1.0, 1.0, 0.0, NAN), 0.0, 0.0),
        ((NAN, 1.0, NAN, 0.0), 0.0, 0.0),
        ((22.0, 1.0, 120.0, 0.0), 120.0, 22.0),
        ((-1.0, 1.0, 120.0, 1.0), -120.0, 0.0),
        ((-1.0, 1.0, 0.0, 1.0), -90.0, 0.0),
        ((-1.0, 1.0, 0.0, 1.57), 0.0, 0.0),
    ],
)
def test_a_place_has_a_speed_a_radius_and_a_direction(p, radius, speed):
    ((name, goal),) = asked(rig_in(), whole(192, *p, z=400.0))
    assert (name, goal.radius, goal.speed) == ("goal", radius, speed)
    assert xyz(goal.position) == pytest.approx((0.0, 0.0, 100.0), abs=0.02)


def test_a_radius_alone_circles_here_in_another_way():
    ((name, goal),) = asked(rig_in(), long(192, -1.0, 1.0, 150.0))
    assert (name, goal.radius, xyz(goal.position)) == ("goal", 150.0, pytest.approx((100.0, 200.0, 80.0), abs=0.01))


@pytest.mark.parametrize(
    ("command", "result"),
    [
        (whole(192, -1.0, 1.0, -50.0), DENIED),
        (whole(192, -1.0, 1.0, 0.0, frame=TERRAIN, z=400.0), BAD_FRAME),
        (whole(192, -1.0, 1.0, 0.0, x=0, y=0, z=400.0), DENIED),
        (whole(192, -1.0, 1.0, 0.0, z=310.0), DENIED),
        (whole(34, 50.0, frame=TERRAIN, z=400.0), BAD_FRAME),
        (whole(34, 50.0, NAN, NAN, 7.0, z=400.0), DENIED),
        (whole(34, 50.0, -3.0, z=400.0), DENIED),
        (whole(34, 50.0, z=310.0), DENIED),
        (long(186), DENIED),
        (long(186, 400.0, 10.0), BAD_FRAME),
        (long(178, 7.0, 20.0), DENIED),
        (long(178, 0.0, 0.0), DENIED),
        (long(178, 0.0, -5.0), DENIED),
        (long(179, 0.0), DENIED),
        (long(179, 0.0, NAN, NAN, NAN, 0.0, 0.0, 0.0), DENIED),
        (long(189), DENIED),
        (long(203, 0.0, 0.0, 0.0, 0.0, 0.0), DENIED),
        (long(2000, 0.0, 1.0, 0.0), DENIED),
        (long(206, -1.0), DENIED),
        (long(246, 3.0), UNSUPPORTED),
        (long(185, 1.0), UNSUPPORTED),
        (long(262, 99.0), DENIED),
        (long(262), DENIED),
    ],
)
def test_what_cannot_be_is_refused_in_words_and_reaches_no_autopilot(command, result):
    assert asked(rig_in(), command, result=result) == []


def test_in_another_mode_a_place_needs_leave_to_change_it():
    rig = rig_in(Mode.MODE_MISSION)
    assert asked(rig, whole(192, -1.0, 0.0, 0.0, z=400.0), result=DENIED) == []
    assert asked(rig, whole(192, -1.0, 1.0, 0.0, z=400.0))[0][0] == "goal"


def test_the_autopilots_reason_is_told():
    rig = rig_in()
    for call, command in (("goal", whole(192, -1.0, 1.0, 0.0, z=400.0)), ("orbit", whole(34, 5.0)), ("order", long(178, 0.0, 90.0))):
        rig.plane.refuse[call] = f"no {call} now"
        rig.say(command)
        heard = rig.run()
        assert acks(heard) == [(command.command, REJECTED)]
        assert any(text.endswith(f"refused: no {call} now") for text in texts(heard))


# altitude, circles


@pytest.mark.parametrize(("frame", "z"), [(0.0, 100.0), (NAN, 100.0), (3.0, HOME + 400.0)])
def test_change_of_altitude_has_a_frame(frame, z):
    ((_, order),) = asked(rig_in(), long(186, 400.0, frame))
    assert order.altitude.altitude == z


@pytest.mark.parametrize(("radius", "speed"), [(120.0, NAN), (-120.0, 22.0), (NAN, NAN)])
def test_an_orbit_has_a_radius_whose_sign_is_its_direction(radius, speed):
    ((name, orbit),) = asked(rig_in(), whole(34, radius, speed, 2.0, z=400.0))
    assert (name, orbit.radius, orbit.speed) == ("orbit", 0.0 if math.isnan(radius) else radius, 0.0 if math.isnan(speed) else speed)
    assert xyz(orbit.centre) == pytest.approx((0.0, 0.0, 100.0), abs=0.02)


def test_an_orbit_without_a_place_is_here_and_then_stays():
    rig = rig_in()
    ((_, orbit),) = asked(rig, long(34, 120.0))
    assert xyz(orbit.centre) == pytest.approx((100.0, 200.0, 80.0), abs=0.01)
    rig.plane.nav.position.x = 500.0
    ((_, other),) = asked(rig, long(34, NAN, 22.0))
    assert (xyz(other.centre), other.radius, other.speed) == (xyz(orbit.centre), 120.0, 22.0)


def test_the_orbit_is_told_while_it_is_flown():
    rig = rig_in()
    assert not of(rig.run(1.0), "ORBIT_EXECUTION_STATUS")
    asked(rig, whole(34, -120.0, z=420.0))
    told = of(rig.run(2.0), "ORBIT_EXECUTION_STATUS", PLANE)
    assert len(told) == 4
    assert (told[0].radius, told[0].frame, told[0].z) == (-120.0, 5, pytest.approx(420.0))
    assert (told[0].x, told[0].y) == pytest.approx((X, Y), abs=2)
    asked(rig, long(176, 1.0, 4.0, 3.0))
    assert not of(rig.run(1.0), "ORBIT_EXECUTION_STATUS")


# speed, landing, home, pictures, beginning anew


@pytest.mark.parametrize(
    ("p", "speed", "over_ground"),
    [((0.0, 28.0, -1.0, 0.0), 28.0, False), ((1.0, 20.0), 20.0, True), ((NAN, 28.0), 28.0, False), ((0.0, -2.0), 0.0, False)],
)
def test_speed_is_through_the_air_or_over_ground(p, speed, over_ground):
    ((_, order),) = asked(rig_in(), long(178, *p))
    assert (order.speed.speed, order.speed.over_ground) == (speed, over_ground)


def test_no_change_of_speed_is_none():
    assert asked(rig_in(), long(178, 0.0, -1.0, 50.0)) == []


def plan(*commands):
    origins = [ORIGIN.pack(3, command, 1, 0, 0, 0, 0, 0, 0, 0) for command in commands]
    kinds = {16: MissionItem.WAYPOINT, 21: MissionItem.LAND, 189: MissionItem.LAND_START}
    return [MissionItem(kind=kinds[c], origin=o, position=Vector3(z=60.0)) for c, o in zip(commands, origins, strict=True)]


@pytest.mark.parametrize(("commands", "index"), [((16, 16, 189, 16, 21), 2), ((16, 16, 21), 2)])
def test_the_landing_sequence_begins_where_the_mission_says(commands, index):
    rig = rig_in()
    rig.plane.mission.items.extend(plan(*commands))
    (first, current), (second, mode) = asked(rig, long(189))
    assert (first, current.index, second, mode.mode) == ("set_current", index, "set_mode", Mode.MODE_MISSION)


def test_an_approach_is_given_up():
    assert [name for name, _ in asked(rig_in(Mode.MODE_LAND), long(191, 50.0))] == ["go_around"]


def test_home_is_set_here_or_at_a_place_and_told_at_once():
    rig = rig_in()
    ((_, order),) = asked(rig, long(179, 1.0))
    assert order.WhichOneof("kind") == "home" and not order.home.HasField("position")
    ((_, order),) = asked(rig, long(179, 0.0, 0.0, 0.0, NAN, 40.77, 14.79, 310.0))
    assert xyz(order.home.position) == pytest.approx((0.0, 0.0, 10.0), abs=1.0)
    ((_, order),) = asked(rig, whole(179, 0.0))
    assert order.home.position.z == HOME
    rig.run(0.5)
    rig.plane.status.home.z = 33.0
    (told,) = of(rig.run(0.1), "HOME_POSITION", PLANE)
    assert told.altitude == pytest.approx(333_000)


def test_home_and_origin_by_message():
    rig = rig_in()
    blank = (0.0, 0.0, 0.0, (1.0, 0.0, 0.0, 0.0), 0.0, 0.0, 0.0)
    rig.say(mav.MAVLink_set_home_position_message(PLANE, X, Y, 310_000, *blank))
    rig.say(mav.MAVLink_set_gps_global_origin_message(PLANE, 1, 2, 3))
    heard = rig.run(0.1)
    ((_, order),) = rig.plane.asked
    assert xyz(order.home.position) == pytest.approx((0.0, 0.0, 10.0), abs=0.02)
    (origin,) = of(heard, "GPS_GLOBAL_ORIGIN")
    assert origin.altitude == pytest.approx(FIELD.altitude * 1e3)
    assert any("stays" in text for text in texts(heard))


def test_pictures_once_and_by_distance():
    rig = rig_in()
    for command in (long(203, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0), long(2000, 0.0, 0.0, 1.0)):
        ((_, order),) = asked(rig, command)
        assert order.WhichOneof("kind") == "picture" and not order.picture.HasField("distance")
    ((_, order),) = asked(rig, long(206, 25.0))
    assert order.picture.distance == 25.0


def test_a_reboot_begins_the_autopilot_anew():
    ((_, order),) = asked(rig_in(), long(246, 1.0))
    assert order.WhichOneof("kind") == "reboot"


@pytest.mark.parametrize(
    ("standard", "mode"),
    [(3, Mode.MODE_POSITION), (4, Mode.MODE_ALTITUDE), (5, Mode.MODE_RETURN), (6, Mode.MODE_MISSION), (8, Mode.MODE_TAKEOFF)],
)
def test_standard_modes(standard, mode):
    ((_, request),) = asked(rig_in(), long(262, float(standard)))
    assert request.mode == mode


# rovers


@pytest.mark.parametrize("number", [22, 34, 186, 191])
def test_what_only_aircraft_do_a_rover_does_not_support(number):
    rig = rig_in()
    assert asked(rig, long(number, 50.0, system=ROVER), rig.rover, UNSUPPORTED) == []


def test_a_rover_is_sent_somewhere_at_a_speed():
    rig = rig_in()
    names = [name for name, _ in asked(rig, whole(192, 0.3, 1.0, system=ROVER), rig.rover)]
    assert names == ["set_mode", "goal", "order"]
    assert rig.rover.asked[-1][1].speed.speed == pytest.approx(0.3)
    assert asked(rig, whole(192, 3.0, 1.0, system=ROVER), rig.rover, DENIED) == []


def test_a_rovers_speed_is_over_ground():
    rig = rig_in()
    ((_, order),) = asked(rig, long(178, 0.0, 0.2, system=ROVER), rig.rover)
    assert order.speed.over_ground


# what is seen of take-offs and landings of a mission


@pytest.mark.parametrize(("item", "state"), [(0, 3), (1, 2), (2, 4)])
def test_take_off_and_landing_of_a_mission_are_told(item, state):
    rig = rig_in(Mode.MODE_MISSION)
    rig.plane.status.armed, rig.plane.status.landed = True, False
    rig.plane.mission.items.extend([MissionItem(kind=MissionItem.TAKEOFF), MissionItem(), MissionItem(kind=MissionItem.LAND)])
    rig.plane.status.waypoint = item
    assert of(rig.run(1.1), "EXTENDED_SYS_STATE", PLANE)[-1].landed_state == state


# guided items


@pytest.mark.parametrize(("frame", "z", "height"), [(6, 50.0, HOME + 50.0), (3, 50.0, HOME + 50.0), (0, 450.0, 150.0)])
def test_a_guided_item_is_gone_to(frame, z, height):
    rig = rig_in(Mode.MODE_MISSION)
    rig.say(mav.MAVLink_mission_item_int_message(PLANE, 1, 0, frame, 16, 2, 1, 0, 0, 0, 0, X, Y, z))
    heard = rig.run()
    assert [m.type for m in of(heard, "MISSION_ACK")] == [0]
    ((_, goal),) = rig.plane.asked
    assert xyz(goal.position) == pytest.approx((0.0, 0.0, height), abs=0.02)


def test_a_guided_item_nowhere_is_refused():
    rig = rig_in()
    for frame, x in ((10, X), (6, 2_000_000_000)):
        rig.say(mav.MAVLink_mission_item_int_message(PLANE, 1, 0, frame, 16, 2, 1, 0, 0, 0, 0, x, Y, 50.0))
        assert [m.type for m in of(rig.run(), "MISSION_ACK")] == [1]
    assert rig.plane.asked == []


# who repeats, who cancels


def test_a_command_int_is_repeated_without_being_executed_again_and_after_a_while_it_is():
    rig = rig_in()
    command = whole(192, -1.0, 1.0, 0.0, z=400.0)
    for _ in range(2):
        rig.say(command)
        assert acks(rig.run(0.5)) == [(192, ACCEPTED)]
    assert len(rig.plane.asked) == 1
    rig.run(1.0)
    assert len(asked(rig, command)) == 1


def test_another_command_between_two_tries_does_not_execute_the_first_again():
    rig = rig_in()
    for command in (long(400, 1.0), long(178, 0.0, 25.0), long(400, 1.0, confirmation=1)):
        rig.say(command)
        assert acks(rig.run()) == [(command.command, ACCEPTED)]
    assert [name for name, _ in rig.plane.asked] == ["arm", "order"]


def test_what_waits_for_the_autopilot_gets_one_final_answer_when_it_is_cancelled():
    rig = Rig()
    rig.run()
    rig.answers = False
    rig.say(long(192, -1.0, 1.0, 0.0))
    rig.say(mav.MAVLink_command_cancel_message(PLANE, 1, 192))
    assert acks(rig.run(3.0)) == [(192, REJECTED)]
    rig.say(mav.MAVLink_command_cancel_message(PLANE, 1, 192))
    assert acks(rig.run()) == [(192, UNSUPPORTED)]
