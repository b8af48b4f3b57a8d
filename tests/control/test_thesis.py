"""The thesis' preset: its gains from stop to stop, its phases, and that it flies."""

import msgspec
import pytest

from tests.services.autopilot.air.point_mass import DT, PARAMS, Point, cruise, fly
from tests.services.autopilot.air.states import cruising
from uvf.control.commands import AltitudeAirspeedSetpoint, AttitudeSetpoint
from uvf.control.cycle import Cycle
from uvf.control.flight_control import FlightControl
from uvf.control.servos import ServoLimits, Servos
from uvf.control.thesis import GAINS, ThesisPath, preset
from uvf.models.vehicle.flight_params import AirParams

SERVOS = Servos(ServoLimits(0.44), ServoLimits(0.52), ServoLimits(0.3))
THESIS = msgspec.structs.replace(PARAMS, **preset(25.0))


def test_its_gains_are_of_surfaces_that_go_from_stop_to_stop():
    surfaces = FlightControl(SERVOS).hold(cruising(p=0.1), AttitudeSetpoint(0.2, 0.05, 0.5), THESIS, DT)
    assert surfaces.aileron == pytest.approx(0.44 * (1.17 * 0.2 - 0.13 * 0.1))
    up, level = (FlightControl(SERVOS).hold(cruising(), AttitudeSetpoint(0.0, pitch, 0.5), THESIS, DT).elevator for pitch in (0.15, 0.05))
    assert up - level == pytest.approx(-0.52 * 1.0 * 0.1)


def test_its_preset_is_made_of_parameters_within_their_limits_and_banks_as_its_course_loop_does():
    assert msgspec.convert(msgspec.to_builtins(THESIS), AirParams) == THESIS
    assert THESIS.course_p * 25.0 / 9.80665 == pytest.approx(GAINS.course_kp)


def test_far_below_it_climbs_with_full_throttle_and_far_above_it_glides():
    for height, throttle in ((140.0, 1.0), (60.0, 0.0)):
        asked = ThesisPath().step(Cycle(cruising(height=100.0), THESIS, DT), AltitudeAirspeedSetpoint(0.0, height, 0.0, 25.0))
        assert asked[1] == throttle


def test_it_holds_height_and_airspeed_and_its_integrals_do_not_wind_up_in_a_climb():
    seen = fly(Point(), cruise(height=160.0), 120.0, THESIS, loops=ThesisPath())
    assert max(now.height for now, _, _ in seen) < 175.0
    assert seen[-1][0].height == pytest.approx(160.0, abs=5.0)
    assert seen[-1][0].airspeed == pytest.approx(25.0, abs=1.5)
