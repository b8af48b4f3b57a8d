"""Mode Offboard: setpoints from outside, by topic."""

import math

import pytest

from schemas.convert import stamp
from schemas.messages import AttitudeSetpoint, CircleSetpoint, CourseSetpoint, FlightSetpoint, LineSetpoint, Mode, ModeRequest
from services.autopilot.air.offboard import Offboard, fresh
from services.autopilot.air.wishes import Senses
from tests.services.autopilot.air.sensing import Bench
from tests.services.autopilot.air.states import PARAMS, cruising

OFFBOARD = [ModeRequest(mode=Mode.MODE_OFFBOARD, source="test")]


def attitude(t=1.0, bank=0.2):
    return FlightSetpoint(timestamp=stamp(t), attitude=AttitudeSetpoint(bank=bank, pitch=0.1, throttle=0.7))


def asked(message, **now):
    return Offboard(Senses(setpoint=message)).step(cruising(**now), PARAMS, 0.02).asked


def test_an_attitude_is_held_within_the_limits():
    held = asked(attitude(bank=3.0))
    assert (held.bank, held.pitch, held.throttle) == (PARAMS.bank_limit, 0.1, 0.7)


def test_a_course_is_held_with_altitude_and_airspeed():
    held = asked(FlightSetpoint(course=CourseSetpoint(course=1.0, altitude=90.0)))
    assert (held.aim.course, held.height, held.airspeed) == (1.0, 90.0, PARAMS.trim_airspeed)


def test_a_line_is_followed_with_its_slope():
    line = LineSetpoint(airspeed=22.0)
    line.origin.z, line.direction.y, line.direction.z = 50.0, 2.0, 0.2
    held = asked(FlightSetpoint(line=line), north=100.0, east=7.0)
    assert (held.aim.error, held.aim.course, held.height, held.climb) == pytest.approx((7.0, 0.0, 60.0, 2.5))


def test_a_circle_is_followed():
    circle = CircleSetpoint(radius=-100.0)
    circle.centre.z = 80.0
    held = asked(FlightSetpoint(circle=circle), north=110.0)
    assert (held.aim.error, held.height) == pytest.approx((10.0, 80.0))
    assert held.aim.course == pytest.approx(-math.pi / 2)


@pytest.mark.parametrize(("age", "counts"), [(0.0, True), (0.5, True), (0.53, False), (-0.1, False)])
def test_only_what_is_fresh_counts(age, counts):
    assert (fresh(1.0, attitude(1.0 - age)) is not None) is counts


def test_what_is_no_setpoint_does_not_count():
    assert fresh(1.0, FlightSetpoint(timestamp=stamp(1.0))) is None
    assert fresh(1.0, attitude(bank=math.nan)) is None
    assert fresh(1.0, FlightSetpoint(timestamp=stamp(1.0), line=LineSetpoint())) is None
    assert fresh(1.0, FlightSetpoint(timestamp=stamp(1.0), circle=CircleSetpoint())) is None


def test_without_a_setpoint_the_mode_is_refused_and_left():
    bench = Bench()
    bench.run(cycles=10)
    assert "no setpoint" in bench.run(mode=OFFBOARD)["mode"][0].reason
    bench.run(setpoint=attitude(bench.n * 0.02))
    assert bench.run(setpoint=attitude(bench.n * 0.02), mode=OFFBOARD)["mode"][0].accepted
    last = attitude(bench.n * 0.02)
    bench.run(cycles=24, setpoint=last)
    assert bench.status.mode == Mode.MODE_OFFBOARD
    bench.run(cycles=4, setpoint=last)
    assert (bench.status.mode, bench.status.reason) == (Mode.MODE_HOLD, "no setpoint for 0.5 s")
