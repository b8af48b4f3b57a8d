"""Flaps: slowly to where a phase wants them, at once where lift is wanting, and what pitch makes of both."""

import msgspec
import pytest

from services.autopilot.air.flight_controller import FlightController
from services.autopilot.air.setpoints import Setpoint
from tests.services.autopilot.air.states import PARAMS, cruising
from uvf.control.commands import AltitudeAirspeedSetpoint
from uvf.control.servos import ServoLimits, Servos

SERVOS = Servos(ServoLimits(0.4), ServoLimits(0.4), ServoLimits(0.4), ServoLimits(0.6))
LIFTING = msgspec.structs.replace(PARAMS, flap_alpha=0.18)
LEVEL = AltitudeAirspeedSetpoint(0.0, None, 0.0, 19.0)
SLOW = cruising(airspeed=19.0, ground_speed=19.0)


def settled(params=LIFTING, flap=0.3, lift=0.0):
    """Surfaces and helm after the flaps have come down, with the last step asking for ``lift``."""
    flight_controller = FlightController(SERVOS)
    for _ in range(200):
        flight_controller.step(SLOW, Setpoint(LEVEL, flap), params, 0.02)
    return flight_controller.step(SLOW, Setpoint(LEVEL, flap, lift=lift), params, 0.02)


def test_lift_that_is_wanting_moves_the_flaps_at_once_by_what_they_make():
    per_flap = LIFTING.flap_alpha * 19.0**2 / LIFTING.alpha_per_load  # m/s^2 per rad
    assert settled(lift=2.0).flap == pytest.approx(0.3 + 2.0 / per_flap, rel=1e-3)
    assert settled(lift=-2.0).flap == pytest.approx(0.3 - 2.0 / per_flap, rel=1e-3)


def test_they_go_no_further_than_their_stops():
    assert (settled(lift=50.0).flap, settled(lift=-50.0).flap) == (0.6, 0.0)


def test_flaps_of_which_no_lift_is_known_stay_where_they_are():
    assert settled(params=PARAMS, lift=2.0).flap == pytest.approx(0.3)


def test_with_flaps_down_the_wing_is_known_to_carry_as_much_at_a_smaller_angle_of_attack():
    """So the elevator balances less of it."""
    assert settled().elevator > settled(params=PARAMS).elevator + 0.05
