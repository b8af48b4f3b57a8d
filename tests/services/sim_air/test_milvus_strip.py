"""Milvus on its wheels: it stands, rolls, steers, brakes, takes off and lands with a scripted pilot; what is not a landing is a crash."""

import numpy as np
import pytest

from benchmarks.sim.air.milvus.coefficients import BODY
from benchmarks.sim.air.milvus.strip import (
    CALM,
    ROTATION_SPEED,
    Landing,
    Strip,
    flown_landing,
    flown_take_off,
    lifted,
    stopped,
    take_off,
)
from services.sim_air.contact.crash import crash_of
from services.sim_air.engine.states import InitialState
from services.sim_air.engine.trim import TrimAttitude
from services.sim_air.engine.wiring import Controls

G = 9.80665
UP = np.array((0.0, 0.0, 0.1))
FLAT = TrimAttitude(0.0, 0.06, 0.0, (0.0, 0.0, 0.0))
WHEELS = ("nose_wheel", "left_wheel", "right_wheel")


@pytest.fixture(scope="module")
def departure():
    return flown_take_off()


@pytest.fixture(scope="module")
def arrival():
    return flown_landing()


def standing():
    strip = Strip()
    strip.stand()
    return strip


def rolling(speed, controls, seconds):
    """Set on its wheels, pushed to ``speed`` [m/s] by the motor, then held at ``controls``."""
    strip = standing()
    strip.fly(lambda s: Controls(throttle=0.8), 20.0, lambda s: s.airspeed >= speed)
    begin = strip.log[-1].sight
    return begin, strip.fly(lambda s: controls, seconds), strip


def hits(strip):
    """Why this moment is a crash; empty = it is none."""
    assert BODY is not None
    return crash_of(strip.airframe.touches(), strip.airframe.motion(), BODY.max_sink)


def test_it_stands_still_on_its_three_wheels_nose_slightly_up():
    strip = standing()
    sight = strip.fly(lambda s: Controls(), 5.0)
    assert (sight.wheels, sight.structure) == (WHEELS, ())
    assert (sight.along, sight.right, sight.height) == pytest.approx((0.0, 0.0, 0.0), abs=2e-3)
    assert np.degrees(sight.pitch) == pytest.approx(3.5, abs=0.2)


def test_the_brakes_hold_it_against_half_power():
    assert abs(standing().fly(lambda s: Controls(throttle=0.5, brake=1.0), 3.0).along) < 0.05


def test_free_rolling_slows_by_the_rolling_resistance():
    begin, end, _ = rolling(3.0, Controls(), 2.0)
    slowed = (begin.airspeed - end.airspeed) / 2.0
    assert slowed == pytest.approx(0.03 * G, rel=0.25)  # and a little drag


def slowing(friction):
    """m/s^2: friction on the main wheels, whose load the braking itself moves to the nose wheel (moments about its contact)."""
    to_nose, wheel_base, height = 0.444, 0.5, 0.40  # m, at rest
    return friction * G * to_nose / (wheel_base + friction * height)


def test_full_brakes_stop_it_as_friction_on_the_main_wheels_allows():
    begin, end, strip = rolling(8.0, Controls(brake=1.0), 4.0)
    assert stopped(end)
    slowed = (7.0 - 2.0) / (crossing(sights_after(strip, begin), 2.0) - crossing(sights_after(strip, begin), 7.0))
    assert slowed == pytest.approx(slowing(0.7), rel=0.1)
    assert max(abs(m.sight.right) for m in strip.log) < 0.5


def test_rudder_to_the_right_steers_to_the_right_on_the_circle_of_the_nose_wheel():
    begin, end, _ = rolling(3.0, Controls(rudder=-0.22, throttle=0.2), 2.0)
    turned = end.heading - begin.heading
    wheel_base, steer = 0.5, np.radians(10.0) / 2
    expected = 0.5 * (begin.airspeed + end.airspeed) / wheel_base * np.tan(steer) * 2.0
    assert turned == pytest.approx(expected, rel=0.2)


def test_a_wheel_does_not_shake_itself_up_at_this_physics_rate():
    """Dropped from 10 cm it comes to rest within two seconds."""
    strip = standing()
    at_rest = strip.airframe.motion().position
    strip.airframe._place(InitialState(at_rest + UP, 0.0, 0.0, CALM), FLAT)
    strip.airframe.command(Controls())
    heights = [strip.airframe.motion().position[2] - at_rest[2] for _ in range(500) if strip.airframe.step() is None]
    assert min(heights) > -0.05
    assert np.abs(heights[-100:]).max() < 2e-3


def test_the_take_off_roll_is_that_of_thrust_and_mass(departure):
    """Thrust at 0.7 of the speed at which it lifts, less drag and rolling resistance there: Raymer 17.8.1's one-point estimate."""
    lift = next(m.sight for m in departure.log if lifted(m.sight))
    net = 63.0 - 0.5 * 1.19 * 0.55 * 0.054 * (0.7 * lift.airspeed) ** 2 - 0.03 * 11.0 * G
    by_hand = 11.0 * lift.airspeed**2 / (2 * net) + 1.5  # m, during the second in which the throttle opens
    assert lift.along == pytest.approx(by_hand, rel=0.15)
    assert lift.airspeed == pytest.approx(18.5, abs=0.7)


def test_it_rotates_on_the_main_wheels_before_it_lifts_and_strikes_nothing(departure):
    rotated = next(m.sight for m in departure.log if m.sight.airspeed > 10 and "nose_wheel" not in m.sight.wheels)
    assert rotated.airspeed >= ROTATION_SPEED
    assert rotated.wheels == WHEELS[1:]
    assert not any(m.sight.structure for m in departure.log)


def test_it_climbs_away_along_the_strip(departure):
    end = departure.log[-1].sight
    assert end.height > 25.0
    assert max(abs(m.sight.right) for m in departure.log) < 3.0


def test_it_lands_on_the_main_wheels_softly_and_stops(arrival):
    touch = next(m.sight for m in arrival.log if m.sight.wheels)
    assert "nose_wheel" not in touch.wheels
    assert touch.sink < 1.0
    assert arrival.log[-1].sight.airspeed < 0.1
    assert not any(m.sight.structure for m in arrival.log)


def test_it_does_not_bounce(arrival):
    first = next(i for i, m in enumerate(arrival.log) if m.sight.wheels)
    assert max(m.sight.height for m in arrival.log[first:]) < 0.1


def test_the_landing_roll_is_that_of_the_brakes(arrival):
    """Brakes at 0.6 are 0.6 of the friction 0.7 and 0.4 of the rolling resistance 0.03."""
    braking = [m.sight for m in arrival.log if m.controls.brake > 0.5]
    slowed = (6.0 - 2.0) / (crossing(braking, 2.0) - crossing(braking, 6.0))
    assert slowed == pytest.approx(slowing(0.6 * 0.7 + 0.4 * 0.03), rel=0.1)


def sights_after(strip, begin):
    return [m.sight for m in strip.log[strip.log.index(next(m for m in strip.log if m.sight is begin)) + 1 :]]


def crossing(sights, speed):
    return next(s.t for s in sights if s.airspeed < speed)


def test_flights_repeat_bit_by_bit(departure):
    assert flown_take_off().log == departure.log


def crashed(pilot, strip):
    """Flies until something is a crash; its reason."""
    strip.fly(pilot, 30.0, lambda s: bool(hits(strip)))
    return hits(strip)


def test_no_moment_of_a_good_flight_is_a_crash():
    strip = standing()
    strip.fly(take_off, 6.0, lambda s: bool(hits(strip)))
    assert strip.log[-1].sight.height > 0.5
    strip = Strip()
    strip.approach(-60.0, 6.0)
    strip.fly(Landing(-60.0, 6.0), 60.0, lambda s: bool(hits(strip)) or stopped(s))
    assert not hits(strip)


def test_landing_without_a_flare_or_with_a_wing_low_is_a_crash():
    strip = Strip()
    strip.approach(-40.0, 4.0)
    assert crashed(lambda s: Controls(elevator=0.0, throttle=0.2), strip)
    strip = Strip()
    strip.approach(-100.0, 8.0)
    assert "right" in crashed(lambda s: Controls(aileron=0.04, elevator=-0.2, throttle=0.3), strip)
