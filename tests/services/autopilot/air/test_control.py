"""Signs, limits and integrators of the loops."""

import math

import pytest

from services.autopilot.air.control import SURFACE_LIMIT, Control, Wanted
from tests.services.autopilot.air.states import PARAMS, cruising

LEVEL = Wanted(bank=0.0, height=60.0, climb=0.0, airspeed=25.0)


def once(now, wanted=LEVEL, control=None):
    return (control or Control()).step(now, wanted, PARAMS, 0.02)


def test_a_bank_to_the_right_takes_positive_aileron():
    assert once(cruising(), Wanted(0.5, 60.0, 0.0, 25.0)).aileron > 0.02


def test_rolling_too_fast_is_damped():
    assert once(cruising(p=0.5)).aileron < once(cruising()).aileron


def test_a_bank_beyond_the_limit_is_not_asked_for():
    at_limit = Wanted(PARAMS.bank_limit, 60.0, 0.0, 25.0)
    assert once(cruising(), Wanted(3.0, 60.0, 0.0, 25.0)) == once(cruising(), at_limit)


def test_too_low_takes_elevator_up_and_throttle():
    level, low = once(cruising()), once(cruising(height=50.0))
    assert low.elevator < level.elevator
    assert low.throttle > level.throttle


def test_a_climb_is_not_steeper_than_allowed():
    assert once(cruising(height=20.0)).throttle == pytest.approx(once(cruising(height=-500.0)).throttle)


def test_a_turn_takes_elevator_up_and_throttle_for_its_load():
    level, banked = once(cruising()), once(cruising(roll=0.8, pitch=0.07, q=0.28, r=0.27))
    assert banked.elevator < level.elevator - 0.02
    assert banked.throttle > level.throttle


def test_too_slow_takes_throttle_and_the_speed_asked_for_has_limits():
    assert once(cruising(airspeed=22.0)).throttle > once(cruising()).throttle
    slowest, below = Wanted(0.0, 60.0, 0.0, PARAMS.min_airspeed), Wanted(0.0, 60.0, 0.0, 3.0)
    assert once(cruising(), below).throttle == once(cruising(), slowest).throttle


def test_surfaces_move_less_the_faster_the_air():
    bank = Wanted(0.2, 60.0, 0.0, 25.0)
    assert 0 < once(cruising(airspeed=32.0), bank).aileron < once(cruising(airspeed=20.0), bank).aileron


def test_yaw_is_damped_only_beyond_the_turn():
    turn = 9.80665 / 25 * math.sin(0.6) * math.cos(0.05)
    assert once(cruising(roll=0.6, r=turn)).rudder == pytest.approx(0.0, abs=1e-9)
    assert once(cruising(roll=0.6, r=turn + 0.2)).rudder > 0.01


def test_slip_to_the_right_is_steered_out_by_the_rudder():
    control = Control()
    for _ in range(100):
        surfaces = once(cruising(side_force=-1.0), control=control)  # wind from the right pushes left
    assert surfaces.rudder < -0.01


def test_surfaces_stay_within_their_stops():
    surfaces = once(cruising(airspeed=12.0, p=-3.0, q=-2.0, r=3.0), Wanted(1.0, 500.0, 5.0, 30.0))
    assert max(abs(surfaces.aileron), abs(surfaces.elevator), abs(surfaces.rudder)) <= SURFACE_LIMIT
    assert 0 <= surfaces.throttle <= 1


def test_the_throttle_does_not_wind_up_at_its_stop():
    control = Control()
    for _ in range(3000):
        assert once(cruising(airspeed=15.0), control=control).throttle == 1.0
    assert once(cruising(airspeed=30.0), control=control).throttle < 0.6


def test_a_standing_error_of_airspeed_is_integrated_away():
    control = Control()
    first = once(cruising(airspeed=24.8), control=control).throttle
    for _ in range(500):
        last = once(cruising(airspeed=24.8), control=control).throttle
    assert last == pytest.approx(first + 500 * 0.02 * PARAMS.airspeed_i * 0.2, abs=1e-3)
