"""In the air or on the ground, by speeds through the air and over ground."""

import pytest

from tests.services.autopilot.air.states import PARAMS, cruising
from uvf.estimation.landed import LandDetector


def after(seconds, airborne, **now):
    detector = LandDetector(airborne)
    for _ in range(round(seconds * 50)):
        detector.step(cruising(**now), PARAMS, 0.02)
    return detector.airborne


@pytest.mark.parametrize("wind", [0.0, 5.0, 10.0, 18.0])
def test_standing_in_a_wind_is_not_flying(wind):
    assert not after(5.0, False, airspeed=wind, ground_speed=0.1)


def test_rolling_on_the_strip_slowly_is_not_flying():
    assert not after(5.0, False, airspeed=8.0, ground_speed=8.0)


@pytest.mark.parametrize(("airspeed", "ground_speed"), [(18.0, 18.0), (20.0, 8.0)])
def test_the_roll_of_a_take_off_is_flying(airspeed, ground_speed):
    assert after(0.1, False, airspeed=airspeed, ground_speed=ground_speed)


def test_hovering_in_a_headwind_is_flying():
    assert after(5.0, True, airspeed=22.0, ground_speed=0.5)


def test_sinking_without_speed_is_flying():
    assert after(5.0, True, airspeed=5.0, ground_speed=1.0, climb=-5.0)


def test_a_second_at_rest_is_landed_and_less_is_not():
    assert after(0.9, True, airspeed=3.0, ground_speed=0.5)
    assert not after(1.2, True, airspeed=3.0, ground_speed=0.5)
