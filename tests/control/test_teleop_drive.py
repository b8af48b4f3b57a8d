"""What is sent for which keys and sticks, second by second."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from uvf.control.teleop_drive import STILL, DriveTeleop, GamepadState
from uvf.maths.kinematics import Twist

MOST = Twist(0.8, 2.0)


def hand_of(*vehicles, most=MOST):
    return DriveTeleop(vehicles or ("one",), most)


def sent(hand, times):
    """(time, command) of what goes to vehicle one."""
    return [(t, hand.commands(t)["one"]) for t in times if hand.commands(t)]


def every(period, until, begin=0.0):
    return [begin + period * i for i in range(round((until - begin) / period) + 1)]


@pytest.mark.parametrize(
    ("key", "command"),
    [("A", (0.0, 0.0, 0.5)), ("E", (0.5, 0.0, -0.5)), ("Z", (-0.5, 0.0, 0.5)), ("W", (0.5, 0.0, 0.0)), ("a", (0.0, 0.5, 0.0))],
)
def test_a_letter_with_shift_moves_sideways_what_can(key, command):
    hand = hand_of(most=Twist(0.8, 2.0, 0.8))
    hand.key(0.0, key)
    assert hand.wanted(0.1) == command


@pytest.mark.parametrize(("key", "command"), [("A", (0.0, 0.5, 0.0)), ("E", (0.5, -0.5, 0.0)), ("W", (0.5, 0.0, 0.0))])
def test_a_letter_with_shift_or_caps_lock_is_that_letter_for_others(key, command):
    hand = hand_of()
    hand.key(0.0, key)
    assert hand.wanted(0.1) == command


def test_the_right_stick_moves_to_the_side_as_fast_as_the_linear_scale():
    hand = hand_of(most=Twist(0.8, 2.0, 0.8))
    hand.key(0.0, "r")
    hand.pad(1.0, GamepadState(right_left=-1.0, dead_man=True))
    assert hand.wanted(1.1) == pytest.approx((0.0, 0.0, -hand.scale.linear))
    hand.pad(2.0, GamepadState(forward=1.0, right_left=1.0, dead_man=True))
    assert hand.wanted(2.1) == pytest.approx((hand.scale.linear, 0.0, hand.scale.linear))


def test_nothing_is_sent_before_a_key():
    assert sent(hand_of(), every(0.05, 2.0)) == []


def test_one_press_drives_half_a_second_then_stands_half_a_second_then_is_silent():
    hand = hand_of()
    hand.key(0.0, "w")
    out = sent(hand, every(0.05, 3.0))
    assert max(t for t, command in out if command == Twist(0.5, 0.0)) == pytest.approx(0.45)
    zeros = [t for t, command in out if command == STILL]
    assert (min(zeros), max(zeros)) == pytest.approx((0.5, 0.9))


@pytest.mark.parametrize(("delay", "gap"), [(0.25, 0.03), (0.5, 0.033), (0.45, 0.1)])
def test_a_held_key_drives_on_and_its_release_is_seen_within_a_fifth_of_a_second(delay, gap):
    hand = hand_of()
    presses = [0.0, *every(gap, 3.0, delay)]
    driving = []
    for t in every(0.01, 4.0):
        while presses and presses[0] <= t + 1e-9:
            released = presses.pop(0)
            hand.key(released, "w")
        driving.append((t, hand.wanted(t) != STILL))
    stops = [t for t, moves in driving if not moves]
    assert min(stops) == pytest.approx(released + 0.2, abs=0.02)


def test_a_keyboard_that_repeats_late_makes_a_short_stop_and_goes_on():
    hand = hand_of()
    hand.key(0.0, "w")
    assert hand.wanted(0.55) == STILL
    hand.key(0.66, "w")
    assert hand.wanted(0.7) == Twist(0.5, 0.0)


@pytest.mark.parametrize(
    ("keys", "signs"),
    [
        (("w", "up"), (1, 0)),
        (("s", "down"), (-1, 0)),
        (("a", "left"), (0, 1)),
        (("d", "right"), (0, -1)),
        (("q",), (1, 1)),
        (("e",), (1, -1)),
        (("z",), (-1, -1)),
        (("c",), (-1, 1)),
    ],
)
def test_each_key_has_its_direction_left_being_positive(keys, signs):
    for key in keys:
        hand = hand_of()
        hand.key(0.0, key)
        assert hand.wanted(0.1) == (signs[0] * 0.5, signs[1] * 0.5, 0.0)


def test_space_stops_at_once_and_says_so_also_while_nothing_moves():
    hand = hand_of()
    hand.key(0.0, "w")
    hand.key(0.1, " ")
    assert hand.commands(0.1) == {"one": STILL}
    standing = hand_of()
    standing.key(5.0, " ")
    assert sent(standing, every(0.1, 7.0, 5.0))[-1][0] == pytest.approx(5.4)


def test_the_scales_begin_at_a_half_or_what_the_slowest_can_do():
    assert hand_of().scale == Twist(0.5, 0.5)
    assert hand_of(most=Twist(0.2, 0.3)).scale == Twist(0.2, 0.3)


def test_the_scales_change_while_driving():
    hand = hand_of()
    hand.key(0.0, "w")
    hand.key(0.1, "r")
    hand.key(0.1, "g")
    assert hand.wanted(0.2) == pytest.approx((0.55, 0.0, 0.0))
    assert hand.scale.angular == pytest.approx(0.5 / 1.1)


@settings(max_examples=60, deadline=None, derandomize=True)
@given(st.lists(st.sampled_from("rftgwasdqezcAQ "), max_size=60))
def test_nothing_asks_for_more_than_the_vehicles_can(keys):
    hand = hand_of()
    for i, key in enumerate(keys):
        hand.key(0.05 * i, key)
        command = hand.wanted(0.05 * i)
        assert abs(command.linear) <= MOST.linear and abs(command.angular) <= MOST.angular and command.lateral == 0
    assert min(hand.scale.linear, hand.scale.angular) > 0


@settings(deadline=None, derandomize=True)
@given(st.text(max_size=3))
def test_other_keys_do_nothing(name):
    hand = hand_of()
    if name.lower() not in ("up", *"wasdqezc rftg1"):
        hand.key(0.0, name)
        assert hand.commands(0.0) == {} and hand.active == {"one"}


def test_several_vehicles_get_the_same_and_one_that_is_switched_off_stands():
    hand = hand_of("one", "two")
    hand.key(0.0, "w")
    assert hand.commands(0.0) == {"one": Twist(0.5, 0.0), "two": Twist(0.5, 0.0)}
    hand.key(0.1, "2")
    assert hand.commands(0.1) == {"one": Twist(0.5, 0.0), "two": STILL}
    hand.key(0.5, "w")
    assert set(hand.commands(0.7)) == {"one"}
    hand.key(0.8, "2")
    hand.key(0.8, "w")
    assert hand.commands(0.8)["two"] == Twist(0.5, 0.0)
    hand.key(0.8, "3")
    assert hand.active == {"one", "two"}


def test_a_stick_drives_only_while_the_dead_man_is_held():
    hand = hand_of()
    hand.pad(0.0, GamepadState(forward=1.0))
    assert hand.commands(0.0) == {}
    hand.pad(0.1, GamepadState(forward=1.0, left=-1.0, dead_man=True))
    assert hand.commands(0.1) == {"one": Twist(0.5, -0.5)}
    hand.pad(0.15, GamepadState(forward=1.0, left=-1.0))
    assert hand.commands(0.15) == {"one": STILL}


def test_a_gamepad_that_is_unplugged_stops_it():
    hand = hand_of()
    hand.pad(0.0, GamepadState(forward=1.0, dead_man=True))
    hand.pad(0.05, GamepadState())
    assert hand.commands(0.05) == {"one": STILL}


def test_a_held_dead_man_with_the_stick_at_rest_keeps_the_vehicle():
    hand = hand_of()
    for t in every(0.05, 3.0):
        hand.pad(t, GamepadState(forward=0.05, dead_man=True))
        assert hand.commands(t) == {"one": STILL}


@pytest.mark.parametrize(("way", "part"), [(0.0, 0.0), (0.09, 0.0), (-0.1, 0.0), (0.55, 0.5), (1.0, 1.0), (-1.0, -1.0)])
def test_the_stick_has_a_dead_zone_and_rises_evenly_beyond_it(way, part):
    hand = hand_of()
    hand.pad(0.0, GamepadState(forward=way, dead_man=True))
    assert hand.wanted(0.0).linear == pytest.approx(0.5 * part)


def test_the_button_stops_though_the_dead_man_is_held():
    hand = hand_of()
    hand.pad(0.0, GamepadState(forward=1.0, dead_man=True))
    hand.pad(0.05, GamepadState(forward=1.0, dead_man=True, stop=True))
    assert hand.commands(0.05) == {"one": STILL}


def test_one_press_of_the_d_pad_is_one_step():
    hand = hand_of()
    for t in (0.0, 0.05, 0.1):
        hand.pad(t, GamepadState(linear_step=1, angular_step=-1))
    hand.pad(0.15, GamepadState())
    assert hand.scale == pytest.approx((0.55, 0.5 / 1.1, 0.0))
