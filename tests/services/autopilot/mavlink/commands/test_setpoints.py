"""Targets of position, velocity and attitude: setpoints of Offboard when they are streamed, a place to go to when one comes alone."""

import math

import pytest

from schemas.messages import Mode, Vector3
from tests.services.autopilot.mavlink.rig import CAR_FACTS, MECANUM_FACTS, OTHER, PLANE, ROVER, Rig, long, of, texts
from uvf.maths.rotations import from_euler
from uvf.mavlink import dialect as mav
from uvf.runtime.messages.convert import quaternion

POSITION, VELOCITY, BOTH, CLIMBING_ONLY = 0b110111111000, 0b110111000111, 0b110111000000, 0b110111000011
LOCAL, BODY, GLOBAL, ABOVE_HOME = 1, 8, 5, 6
NAN = math.nan
X, Y = 407_700_000, 147_900_000  # the world's origin


def local(mask, place=(0.0, 0.0, 0.0), velocity=(0.0, 0.0, 0.0), frame=LOCAL, rate=0.0, system=PLANE):
    return mav.MAVLink_set_position_target_local_ned_message(0, system, 1, frame, mask, *place, *velocity, 0, 0, 0, 0, rate)


def anywhere(mask, altitude, velocity=(0.0, 0.0, 0.0), frame=GLOBAL, system=PLANE, x=X):
    return mav.MAVLink_set_position_target_global_int_message(0, system, 1, frame, mask, x, Y, altitude, *velocity, 0, 0, 0, 0, 0)


def attitude(roll, pitch, thrust, mask=0b111):
    return mav.MAVLink_set_attitude_target_message(0, PLANE, 1, mask, list(from_euler(roll, pitch, 1.0)), 0, 0, 0, thrust)


def rig_in(mode=Mode.MODE_OFFBOARD, **settings):
    rig = Rig(**settings)
    rig.plane.status.mode = rig.rover.status.mode = mode
    rig.plane.nav.wind.CopyFrom(Vector3(x=-5.0))
    rig.run()
    return rig


def said(rig, message, output="setpoint", **sender):
    rig.say(message, **sender)
    rig.run(0.02)
    return next(iter(rig.outputs.get(output, {}).values()), None)


def xyz(v):
    return v.x, v.y, v.z


@pytest.mark.parametrize(
    ("message", "centre"),
    [
        (local(POSITION, (10.0, 20.0, -90.0)), (20.0, 10.0, 90.0)),
        (anywhere(POSITION, 400.0), (0.0, 0.0, 100.0)),
        (anywhere(POSITION, 50.0, frame=ABOVE_HOME), (0.0, 0.0, 70.0)),
        (anywhere(POSITION | 0b100, 0.0), (0.0, 0.0, 80.0)),
    ],
)
def test_a_place_is_circled(message, centre):
    circle = said(rig_in(), message).circle
    assert xyz(circle.centre) == pytest.approx(centre, abs=0.02)
    assert circle.radius == 90.0


def test_a_place_with_a_velocity_is_the_line_through_it():
    line = said(rig_in(), local(BOTH, (10.0, 20.0, -90.0), (0.0, 20.0, -1.0))).line
    assert (xyz(line.origin), xyz(line.direction)) == ((20.0, 10.0, 90.0), (20.0, 0.0, 1.0))
    assert line.airspeed == 25.0  # against 5 m/s of wind


def test_a_velocity_alone_is_the_line_from_where_it_was_asked_for_first():
    rig = rig_in()
    first = said(rig, local(VELOCITY, velocity=(20.0, 0.0, 0.0))).line
    rig.plane.nav.position.x = 130.0
    again = said(rig, local(VELOCITY, velocity=(20.0, 0.0, 0.0))).line
    assert xyz(again.origin) == xyz(first.origin) == (100.0, 200.0, 80.0)
    assert said(rig, local(VELOCITY, velocity=(0.0, 20.0, 0.0))).line.origin.x == 130.0


def test_a_velocity_with_an_altitude_is_flown_there():
    assert said(rig_in(), local(CLIMBING_ONLY, (0.0, 0.0, -95.0), (20.0, 0.0, 0.0))).line.origin.z == 95.0


def test_an_attitude_has_the_signs_of_the_autopilot():
    asked = said(rig_in(), attitude(0.4, 0.1, 0.7)).attitude
    assert (asked.bank, asked.pitch, asked.throttle) == pytest.approx((0.4, 0.1, 0.7), abs=1e-6)


@pytest.mark.parametrize(
    "message",
    [
        local(VELOCITY),
        local(0b110111111111),
        local(POSITION, (math.nan, 0.0, -90.0)),
        local(POSITION, (0.0, 0.0, -90.0), frame=BODY),
        anywhere(POSITION, 400.0, frame=11),
        anywhere(POSITION, 400.0, x=2_000_000_000),
        attitude(0.4, 0.1, 0.7, mask=0b10000000),
        attitude(0.4, 0.1, 0.7, mask=0b01000000),
        attitude(0.4, 0.1, math.nan),
        mav.MAVLink_set_attitude_target_message(0, PLANE, 1, 0b111, [0, 0, 0, 0], 0, 0, 0, 0.5),
    ],
)
def test_what_cannot_be_flown_is_refused_in_words(message):
    rig = rig_in()
    assert said(rig, message) is None
    assert any(text.startswith("Setpoints refused: ") for text in texts(rig.heard()))


ABSURD = [
    (local(VELOCITY, velocity=(1.0, 0.0, math.inf)), "a place or a velocity is not finite"),
    (local(VELOCITY, velocity=(1.0, 0.0, NAN)), "a place or a velocity is not finite"),
    (local(POSITION, (math.inf, 0.0, -90.0)), "a place or a velocity is not finite"),
    (local(VELOCITY, velocity=(1e30, 0.0, 0.0)), "the velocity is beyond 200 m/s"),
    (local(VELOCITY, velocity=(150.0, 150.0, 0.0)), "the velocity is beyond 200 m/s"),
    (local(POSITION, (1e30, 0.0, -80.0)), "the place is more than 200 km away from the field"),
    (local(POSITION, (0.0, 0.0, -1e30)), "the place is more than 100000 m high"),
    (anywhere(POSITION, 400.0, x=0), "that place is 4144 km away from the field"),
    (local(POSITION, frame=7), "frame LOCAL_OFFSET_NED is not supported"),
]


@pytest.mark.parametrize(("message", "why"), ABSURD)
def test_a_stream_that_nobody_can_follow_is_refused_and_told_once(message, why):
    rig, told = rig_in(), []
    for _ in range(100):
        assert said(rig, message) is None
        told += texts(rig.heard())
    (text,) = [text for text in told if "efused" in text]
    assert text.startswith(f"Setpoints refused: {why}")
    rig.plane.status.mode = Mode.MODE_HOLD
    rig.run(2.0)
    assert rig.plane.asked == [], "and no place that has come alone"


@pytest.mark.parametrize(("message", "why"), ABSURD)
def test_what_nobody_can_follow_keeps_no_program_from_steering(message, why):
    rig = rig_in()
    assert said(rig, message, system=254, peer=OTHER) is None
    assert said(rig, attitude(0.4, 0.1, 0.7))


@pytest.mark.parametrize("way", [{"velocity": (1e30, 0.0, 0.0)}, {"rate": 1e30}, {"velocity": (NAN, 0.0, 0.0)}])
def test_a_rover_is_not_driven_by_what_cannot_be(way):
    rig = rig_in()
    assert said(rig, local(0b010111000111, frame=BODY, system=ROVER, **way), "drive") is None
    assert any(text.startswith("Setpoints refused: ") for text in texts(rig.heard()))


def test_setpoints_go_out_before_the_mode_is_asked_for():
    assert said(rig_in(Mode.MODE_HOLD), local(VELOCITY, velocity=(20.0, 0.0, 0.0)))


def test_one_program_steers():
    rig = rig_in()
    assert said(rig, attitude(0.4, 0.1, 0.7))
    assert said(rig, attitude(-0.4, 0.1, 0.7), system=254, peer=OTHER) is None
    assert "Setpoints ignored: station 255 steers" in texts(rig.heard(OTHER))


def test_a_place_that_comes_alone_is_gone_to():
    rig = rig_in(Mode.MODE_HOLD)
    rig.say(anywhere(POSITION, 400.0))
    rig.run(0.9)
    assert rig.plane.asked == []
    rig.run(0.3)
    ((name, goal),) = rig.plane.asked
    assert (name, xyz(goal.position)) == ("goal", pytest.approx((0.0, 0.0, 100.0), abs=0.02))


def test_a_stream_of_places_moves_nothing_but_offboard():
    rig = rig_in(Mode.MODE_HOLD)
    for _ in range(10):
        rig.say(anywhere(POSITION, 400.0))
        rig.run(0.5)
    rig.run(2.0)
    assert rig.plane.asked == []


def test_in_a_mission_a_place_that_comes_alone_is_refused_in_words():
    rig = rig_in(Mode.MODE_MISSION)
    rig.say(anywhere(POSITION, 400.0))
    assert any("needs mode Hold" in text for text in texts(rig.run(1.2)))
    assert rig.plane.asked == []


def test_a_refused_goal_is_told():
    rig = rig_in(Mode.MODE_HOLD)
    rig.plane.refuse["goal"] = "outside of the fence"
    rig.say(anywhere(POSITION, 400.0))
    assert "Go to refused: outside of the fence" in texts(rig.run(1.2))


def test_a_rover_goes_to_a_place_that_comes_alone():
    rig = rig_in(Mode.MODE_HOLD)
    rig.say(anywhere(POSITION, 300.0, system=ROVER))
    rig.run(1.3)
    assert [name for name, _ in rig.rover.asked] == ["set_mode", "goal"]


def test_a_rover_drives_by_velocities_of_its_body_or_over_ground():
    rig = rig_in()
    rig.rover.nav.orientation.CopyFrom(quaternion(from_euler(0.0, 0.0, 0.0)))  # looks east
    command = said(rig, local(0b010111000111, velocity=(0.3, 0.0, 0.0), frame=BODY, rate=0.5, system=ROVER), "drive")
    assert (command.linear, command.angular) == pytest.approx((0.3, -0.5))
    east = said(rig, local(VELOCITY, velocity=(0.0, 0.3, 0.0), system=ROVER), "drive")
    assert (east.linear, east.angular) == pytest.approx((0.3, 0.0), abs=1e-6)
    north = said(rig, local(VELOCITY, velocity=(0.3, 0.0, 0.0), system=ROVER), "drive")
    assert north.linear == pytest.approx(0.0, abs=1e-6) and north.angular > 1.0


def test_a_rover_that_goes_sideways_does_so():
    rig = rig_in(rover=MECANUM_FACTS)
    rig.rover.nav.orientation.CopyFrom(quaternion(from_euler(0.0, 0.0, 0.0)))  # looks east
    right = said(rig, local(0b010111000111, velocity=(0.3, 0.2, 0.0), frame=BODY, rate=0.5, system=ROVER), "drive")
    assert (right.linear, right.angular, right.lateral) == pytest.approx((0.3, -0.5, -0.2))
    north = said(rig, local(VELOCITY, velocity=(0.3, 0.0, 0.0), system=ROVER), "drive")
    assert (north.linear, north.angular, north.lateral) == pytest.approx((0.0, 0.0, 0.3), abs=1e-6)
    assert said(rig, local(0b010111000111, velocity=(0.0, NAN, 0.0), frame=BODY, system=ROVER), "drive") is None


def test_a_car_drives_on_while_it_turns_to_a_velocity_over_ground():
    rig = rig_in(rover=CAR_FACTS)
    rig.rover.nav.orientation.CopyFrom(quaternion(from_euler(0.0, 0.0, 0.0)))  # looks east
    west = said(rig, local(VELOCITY, velocity=(0.0, -0.3, 0.0), system=ROVER), "drive")
    assert west.linear == pytest.approx(0.09) and abs(west.angular) > 1.0
    east = said(rig, local(VELOCITY, velocity=(0.0, 0.3, 0.0), system=ROVER), "drive")
    assert (east.linear, east.angular) == pytest.approx((0.3, 0.0), abs=1e-6)


@pytest.mark.parametrize("mode", [Mode.MODE_MANUAL, Mode.MODE_HOLD, Mode.MODE_MISSION])
def test_outside_of_offboard_a_rover_does_not_listen_to_velocities(mode):
    assert said(rig_in(mode), local(VELOCITY, velocity=(0.3, 0.0, 0.0), frame=BODY, system=ROVER), "drive") is None


def test_what_each_vehicle_says_it_can_do():
    rig = rig_in()
    rig.say(long(512, 148.0))
    rig.say(long(512, 148.0, system=ROVER))
    heard = rig.run()
    plane, rover = (of(heard, "AUTOPILOT_VERSION", system)[0].capabilities for system in (PLANE, ROVER))
    assert plane & (64 | 128 | 256) == 64 | 128 | 256
    assert rover & (64 | 128 | 256) == 128 | 256
