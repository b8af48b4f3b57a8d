"""Surfaces by hand: keys move them by steps within the vehicle's limits and they stay; a gamepad's sticks spring back."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from uvf.control.teleop_drive import GamepadState
from uvf.control.teleop_flight import KEYS, PARKED, FlightTeleop, SurfaceLimits, SurfaceSetting

LIMITS = SurfaceLimits(aileron=0.4, elevator=0.5, rudder=0.3, flap=0.6)
LEVEL = SurfaceSetting(elevator=-0.1, throttle=0.5)


@pytest.fixture
def stick():
    stick = FlightTeleop(LIMITS)
    stick.follow(LEVEL)
    return stick


def press(stick, *keys):
    for key in keys:
        stick.key(key)
    return stick.setting


@pytest.mark.parametrize(
    ("key", "what", "step"),
    [
        ("d", "aileron", 0.02),  # rolls right
        ("left", "aileron", -0.02),
        ("w", "elevator", 0.025),  # nose down
        ("down", "elevator", -0.025),
        ("q", "rudder", 0.015),  # yaws left
        ("e", "rudder", -0.015),
        ("r", "throttle", 0.05),
        ("f", "throttle", -0.05),
        ("t", "flap", 0.03),
    ],
)
def test_a_press_moves_one_thing_by_a_twentieth_of_its_way(stick, key, what, step):
    wanted = LEVEL._replace(**{what: getattr(LEVEL, what) + step})
    assert press(stick, key) == pytest.approx(wanted)


def test_surfaces_stay_where_they_are_put(stick):
    moved = press(stick, "d", "d", "s")
    stick.pad(10.0, GamepadState())
    assert stick.setting == moved


@pytest.mark.parametrize("centre", [" ", "c"])
def test_centre_brings_back_the_neutral_elevator_and_leaves_throttle_and_flaps(stick, centre):
    press(stick, "a", "w", "e", "r", "t")
    assert press(stick, centre) == pytest.approx(SurfaceSetting(elevator=-0.1, throttle=0.55, flap=0.03))
    press(stick, "s", "s", "n", "w")
    assert press(stick, centre).elevator == pytest.approx(-0.15)


def test_a_turn_does_not_move_the_neutral_place_that_straight_flight_has_given(stick):
    stick.follow(LEVEL._replace(elevator=-0.25, aileron=0.1), straight=False)
    assert stick.setting.elevator == -0.25
    assert press(stick, "c").elevator == LEVEL.elevator


def test_the_first_time_it_is_taken_as_it_is():
    stick = FlightTeleop(LIMITS)
    stick.follow(LEVEL._replace(elevator=-0.25), straight=False)
    assert press(stick, "c").elevator == -0.25
    stick.follow(LEVEL)
    assert press(stick, "c").elevator == LEVEL.elevator


def test_brakes_are_on_or_off(stick):
    assert [press(stick, "b").brake for _ in range(3)] == [1.0, 0.0, 1.0]


def test_it_begins_parked():
    assert FlightTeleop(LIMITS).setting == PARKED == SurfaceSetting(brake=1.0)


@settings(max_examples=60, deadline=None, derandomize=True)
@given(st.lists(st.sampled_from([*KEYS, " ", "n", "b", "?"]), max_size=120))
def test_nothing_leaves_the_limits_of_the_vehicle(keys):
    s = press(FlightTeleop(LIMITS), *keys)
    assert abs(s.aileron) <= 0.4 and abs(s.elevator) <= 0.5 and abs(s.rudder) <= 0.3
    assert 0 <= s.flap <= 0.6 and 0 <= s.throttle <= 1 and s.brake in (0.0, 1.0)


def test_twenty_presses_are_full_way_and_twenty_back_are_zero_exactly(stick):
    assert press(stick, *["d"] * 25).aileron == 0.4
    assert press(stick, *["a"] * 20).aileron == 0.0


def test_sticks_count_while_the_dead_man_is_held_and_spring_back(stick):
    stick.pad(1.0, GamepadState(left=-1.0, forward=1.0, right_left=-1.0))
    assert stick.setting == LEVEL
    stick.pad(1.05, GamepadState(left=-1.0, forward=1.0, right_left=-1.0, dead_man=True))
    assert stick.setting == pytest.approx(SurfaceSetting(aileron=0.4, elevator=0.4, rudder=-0.3, throttle=0.5))
    stick.pad(1.1, GamepadState())
    assert stick.setting == LEVEL


def test_the_right_stick_moves_the_throttle_at_a_rate(stick):
    for i in range(21):
        stick.pad(1.0 + 0.05 * i, GamepadState(dead_man=True, right_forward=-1.0 if i else 0.0))
    assert stick.setting.throttle == pytest.approx(0.0, abs=1e-6)
    stick.pad(60.0, GamepadState(dead_man=True, right_forward=1.0))
    assert stick.setting.throttle == pytest.approx(0.1), "a reading that comes late counts for 0.2 s"


def test_the_pad_trims_moves_flaps_and_brakes_once_a_press(stick):
    for t in (1.0, 1.05, 1.1):
        stick.pad(t, GamepadState(linear_step=-1, angular_step=1, stop=True))
    assert stick.setting == pytest.approx(SurfaceSetting(elevator=-0.125, throttle=0.5, flap=0.06, brake=1.0))
    stick.pad(1.2, GamepadState())
    assert stick.setting.brake == 0.0
