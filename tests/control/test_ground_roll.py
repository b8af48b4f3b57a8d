"""An aircraft on its wheels: what holds its wings, its tail and its line, by what it has."""

from dataclasses import replace

import msgspec
import numpy as np
import pytest

from tests.services.autopilot.air.states import PARAMS, cruising
from uvf.control.ground_roll import BACK, Gyros, rolling, rudder_along

TAIL = msgspec.structs.replace(PARAMS, gear="tail_wheel", rest_pitch=0.2)
CASTER = msgspec.structs.replace(PARAMS, brake_steering=2.5)
SLOW, FAST = 0.2 * PARAMS.min_airspeed, 1.1 * PARAMS.min_airspeed


def rolls(params, airspeed=SLOW, pitch=0.0, rudder=0.0, brake=0.0, **now):
    return rolling(cruising(airspeed=airspeed, ground_speed=airspeed, pitch=pitch, **now), params, rudder, 0.0, brake)


def test_a_tail_is_kept_down_slow_and_is_let_up_fast():
    assert rolls(TAIL, SLOW, pitch=0.2).elevator == pytest.approx(-BACK)
    assert rolls(TAIL, FAST, pitch=0.2).elevator > 0.0


def test_a_nose_wheel_is_pressed_down_less_the_higher_the_nose():
    assert rolls(PARAMS, pitch=0.0).elevator > rolls(PARAMS, pitch=0.1).elevator


@pytest.mark.parametrize(("pitch", "most"), [(0.05, 0.0), (0.2, 1.0), (0.35, 0.0)])
def test_a_tail_dragger_brakes_only_with_its_tail_on_the_ground(pitch, most):
    assert rolls(TAIL, pitch=pitch, brake=1.0).brake == pytest.approx(most)


def test_brakes_come_on_as_the_wheels_carry():
    assert rolls(PARAMS, FAST, brake=0.6).brake == 0.0
    assert rolls(PARAMS, SLOW, brake=0.6).brake == pytest.approx(0.6)


def test_where_no_wheel_steers_the_brakes_do_until_the_rudder_does():
    assert rolls(PARAMS, rudder=0.3).brake_difference == 0.0
    left = rolls(CASTER, rudder=0.3, brake=0.6)
    assert left.brake_difference > 0.5
    assert left.brake < 0.3, "it has to be steered first"
    assert rolls(CASTER, rudder=-0.3).brake_difference == -left.brake_difference
    assert rolls(CASTER, FAST, rudder=0.3).brake_difference == 0.0


def test_a_wing_that_is_low_is_raised_by_more_aileron_the_slower_it_is():
    slow, fast = (rolls(PARAMS, airspeed, roll=0.1).aileron for airspeed in (10.0, PARAMS.trim_airspeed))
    assert slow < fast < 0.0


def test_the_rudder_steers_back_to_the_line():
    assert rudder_along(cruising(yaw=0.1, ground_speed=10.0), 0.0, 0.0) > 0.0
    assert rudder_along(cruising(yaw=0.0, ground_speed=10.0), 0.0, -1.0) < 0.0


def test_the_gyroscopes_keep_the_attitude_while_it_turns_banked():
    """About the vertical, banked: p, q, r of it are those of a turn, and neither bank nor pitch changes."""
    bank, pitch, rate = 0.3, 0.1, 1.0
    p, q, r = rate * np.array((-np.sin(pitch), np.sin(bank) * np.cos(pitch), np.cos(bank) * np.cos(pitch)))
    now = replace(cruising(), roll=bank, pitch=pitch, p=float(p), q=float(q), r=float(r))
    gyros = Gyros(now)
    for _ in range(200):
        level = gyros.step(now, 0.01)
    assert (level.roll, level.pitch) == (pytest.approx(bank, abs=1e-6), pytest.approx(pitch, abs=1e-6))
    assert level.yaw - now.yaw == pytest.approx(2.0)
