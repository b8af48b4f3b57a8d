"""One flight of JSBSim by setpoints from outside: attitude, course, line and circle in turn, each held; their loss means Hold."""

import math

import numpy as np
import pytest

from schemas import topics
from schemas.messages import (
    AttitudeSetpoint,
    CircleSetpoint,
    CourseSetpoint,
    FlightSetpoint,
    LineSetpoint,
    Mode,
    ModeRequest,
    Vector3,
)
from tests.services.autopilot.air.test_flight import Flight, site
from uvf.maths.rotations import enu_flu_from_ned_frd, to_euler
from uvf.runtime.messages.convert import stamp, wxyz

WIND = (-4.0, 3.0, 0.0)
BANKED = AttitudeSetpoint(bank=0.5, pitch=0.06, throttle=0.85)
COURSE = CourseSetpoint(course=1.0, altitude=85.0, airspeed=22.0)
LINE = LineSetpoint(origin=Vector3(x=300.0, z=90.0), direction=Vector3(y=2.0, z=0.1), airspeed=24.0)
CIRCLE = CircleSetpoint(centre=Vector3(x=400.0, y=1200.0, z=130.0), radius=-120.0)
PLAN = [
    (1.0, FlightSetpoint(attitude=BANKED)),
    (12.0, FlightSetpoint(course=COURSE)),
    (40.0, FlightSetpoint(line=LINE)),
    (80.0, FlightSetpoint(circle=CIRCLE)),
]
SILENT, AGAIN, END = 125.0, 130.0, 132.0
"""s, when nobody says anything any more, when somebody does again, and when it is over."""


@pytest.fixture(scope="module")
def flown():
    flight = Flight(site(wind=WIND))
    publisher = flight.bus.publisher(topics.SETPOINT.by("client").at("milvus"), "uvf.v1.FlightSetpoint", topics.SETPOINT.qos)

    def speak(t):
        begun = [message for begin, message in PLAN if begin <= t]
        if begun and not SILENT <= t < AGAIN and round(t * 100) % 5 == 0:
            begun[-1].timestamp.CopyFrom(stamp(t))
            publisher.put(begun[-1].SerializeToString(), round(t * 1e9))
        return True

    offboard = ModeRequest(mode=Mode.MODE_OFFBOARD, source="client")
    for t in (0.9, 1.1):
        flight.lockstep.run(t, speak)
        flight.ask(topics.SET_MODE, offboard, t)
    flight.lockstep.run(END, speak)
    return flight


def truth(flown, begin, end):
    return [m for t, m in flown.truth if begin < t <= end]


def mode_at(flown, t):
    return next(m.mode for at, m in reversed(flown.status) if at <= t)


def test_it_is_refused_before_anybody_sends_setpoints_and_flown_afterwards(flown):
    refused, accepted = flown.replies
    assert "no program sends setpoints" in refused.reason
    assert accepted.accepted
    assert {m.mode for t, m in flown.status if 2.0 < t <= SILENT} == {Mode.MODE_OFFBOARD}


def test_an_attitude_is_held_with_its_throttle(flown):
    angles = np.array([to_euler(enu_flu_from_ned_frd(wxyz(m.orientation)))[:2] for m in truth(flown, 6.0, 12.0)])
    assert np.abs(angles - (BANKED.bank, BANKED.pitch)).max() < 0.03
    assert {round(m.throttle, 6) for t, m in flown.surfaces if 6.0 < t <= 12.0} == {BANKED.throttle}


def test_a_course_over_ground_is_held_with_altitude_and_airspeed(flown):
    held = truth(flown, 30.0, 40.0)
    courses = [math.remainder(math.atan2(m.velocity.x, m.velocity.y) - COURSE.course, math.tau) for m in held]
    assert np.abs(courses).max() < 0.02
    assert max(abs(m.position.z - COURSE.altitude) for m in held) < 1.5
    assert max(abs(m.airspeed - COURSE.airspeed) for m in held) < 0.5


def test_a_line_is_followed_up_its_slope(flown):
    held = truth(flown, 65.0, 80.0)
    assert max(abs(m.position.x - LINE.origin.x) for m in held) < 1.5
    assert max(abs(m.position.z - (LINE.origin.z + 0.05 * m.position.y)) for m in held) < 2.0
    assert max(abs(m.airspeed - LINE.airspeed) for m in held) < 0.7


def test_a_circle_is_followed_to_the_left(flown):
    held = truth(flown, 110.0, SILENT)
    away = np.array([(m.position.x - CIRCLE.centre.x, m.position.y - CIRCLE.centre.y) for m in held])
    assert np.hypot(*away.T) == pytest.approx(np.full(len(held), 120.0), abs=2.0)
    assert (np.diff(np.unwrap(np.arctan2(away[:, 1], away[:, 0]))) > 0).all()
    assert max(abs(m.position.z - CIRCLE.centre.z) for m in held) < 2.0


def test_when_setpoints_end_it_holds_and_their_return_does_not_take_it_back(flown):
    assert mode_at(flown, SILENT + 0.4) == Mode.MODE_OFFBOARD
    assert mode_at(flown, SILENT + 0.7) == Mode.MODE_HOLD
    assert next(m.reason for t, m in flown.status if t > SILENT + 0.7) == "no setpoint for 0.5 s"
    assert {m.mode for t, m in flown.status if t > SILENT + 0.7} == {Mode.MODE_HOLD}
    assert max(abs(m.position.z - CIRCLE.centre.z) for m in truth(flown, SILENT, END)) < 3.0
