"""Modes flown by hand: what the stick asks for in each."""

import pytest

from services.autopilot.air.modes.stick_modes import STEEPEST, AltitudeMode, ManualMode, PositionMode, StabilizedMode
from services.autopilot.air.setpoints import FlightContext, ManualCommand, PathSetpoint
from tests.services.autopilot.air.states import PARAMS, cruising
from uvf.control.commands import AltitudeAirspeedSetpoint, AttitudeSetpoint, Surfaces
from uvf.control.cycle import Cycle
from uvf.control.servos import ServoLimits, Servos

SERVOS = Servos(ServoLimits(0.4), ServoLimits(0.5), ServoLimits(0.3))
NOW = cruising()


def stick(roll=0.0, pitch=0.0, yaw=0.0, throttle=0.5):
    surfaces = Surfaces(roll * 0.4, -pitch * 0.5, -yaw * 0.3, throttle, flap=0.1, brake=0.2)
    return FlightContext(hand=ManualCommand("teleop", surfaces), servos=SERVOS)


def asked(mode, context, now=NOW):
    return mode(context).step(now, PARAMS, 0.02)


def test_manual_passes_the_surfaces_on():
    context = stick(0.3, 0.2, -0.1)
    assert asked(ManualMode, context).asked == context.hand.surfaces


@pytest.mark.parametrize("part", [-1.0, -0.4, 0.0, 0.7, 1.0])
def test_stabilized_turns_the_stick_into_bank_and_pitch(part):
    wish = asked(StabilizedMode, stick(part, part))
    level = Cycle(NOW, PARAMS, 0.02).alpha
    assert isinstance(wish.asked, AttitudeSetpoint)
    assert wish.asked.bank == pytest.approx(part * PARAMS.turn_bank)
    assert wish.asked.pitch == pytest.approx(level + part * STEEPEST)
    assert (wish.asked.throttle, wish.flap, wish.brake) == (0.5, 0.1, 0.2)


def test_stabilized_leaves_the_rudder_to_the_pedals_when_they_are_used():
    assert asked(StabilizedMode, stick()).asked.rudder is None
    assert asked(StabilizedMode, stick(yaw=0.5)).asked.rudder == pytest.approx(-0.15)


def test_a_stick_beyond_its_stop_asks_for_no_more():
    assert asked(StabilizedMode, stick(roll=3.0)).asked.bank == pytest.approx(PARAMS.turn_bank)


def test_altitude_turns_the_stick_into_climb_and_the_throttle_into_airspeed():
    up, down = asked(AltitudeMode, stick(pitch=1.0, throttle=1.0)).asked, asked(AltitudeMode, stick(pitch=-0.5, throttle=0.0)).asked
    assert isinstance(up, AltitudeAirspeedSetpoint)
    assert (up.height, up.climb, up.airspeed) == (None, PARAMS.climb_max, PARAMS.max_airspeed)
    assert (down.height, down.climb, down.airspeed) == (None, -0.5 * PARAMS.sink_max, PARAMS.min_airspeed)


def test_altitude_holds_the_height_at_which_the_stick_was_centred():
    context = stick(pitch=0.8)
    mode = AltitudeMode(context)
    mode.step(cruising(height=60.0), PARAMS, 0.02)
    context.update(stick())
    mode.step(cruising(height=72.0), PARAMS, 0.02)
    assert mode.step(cruising(height=75.0), PARAMS, 0.02).asked.height == 72.0


def test_position_holds_the_line_over_ground_along_which_the_stick_was_centred():
    context = stick()
    mode = PositionMode(context)
    mode.step(cruising(course=0.0, east=5.0), PARAMS, 0.02)
    later = mode.step(cruising(course=0.1, north=100.0, east=9.0), PARAMS, 0.02).asked
    assert isinstance(later, PathSetpoint)
    assert (later.aim.error, later.aim.course) == pytest.approx((4.0, 0.0))


def test_position_leaves_the_line_when_the_stick_is_moved_and_waits_for_level_wings():
    context = stick()
    mode = PositionMode(context)
    mode.step(NOW, PARAMS, 0.02)
    context.update(stick(roll=0.5))
    assert mode.step(NOW, PARAMS, 0.02).asked.bank == pytest.approx(0.5 * PARAMS.turn_bank)
    context.update(stick())
    assert isinstance(mode.step(cruising(roll=0.4), PARAMS, 0.02).asked, AltitudeAirspeedSetpoint)
    assert isinstance(mode.step(cruising(roll=0.02), PARAMS, 0.02).asked, PathSetpoint)
