"""The height of the wheels over a strip: the estimate, corrected by what a range finder sees."""

import numpy as np
import pytest

from tests.services.autopilot.air.states import PARAMS, cruising
from uvf.estimation.wheel_height import WheelHeight

GROUND, DT = 5.0, 0.02


def approach(off=0.0, drift=0.0, noise=0.0, distance=100.0, seconds=10.0):
    """Sinks at 1.4 m/s from 14 m; the estimate is ``off`` [m] too high at the start and sinks ``drift`` [m/s] slower than the wheels."""
    rng, wheels = np.random.default_rng(3), WheelHeight(GROUND)
    for k in range(round(seconds / DT)):
        true = 14.0 - 1.4 * k * DT
        height = true + off + drift * k * DT + GROUND + PARAMS.gear_height
        now = cruising(height=height, climb=-1.4 + drift)
        wheels.step(now, true + noise * rng.standard_normal(), distance, PARAMS, DT)
    return wheels, true


def test_height_and_sink_are_those_that_are_seen_whatever_the_estimate_says():
    wheels, true = approach(off=1.2, drift=0.15)
    assert wheels.height == pytest.approx(true, abs=0.01)
    assert wheels.climb == pytest.approx(-1.4, abs=0.01)


def test_the_noise_of_the_range_finder_hardly_shows():
    wheels, true = approach(noise=0.03)
    assert wheels.height == pytest.approx(true, abs=0.02)
    assert wheels.climb == pytest.approx(-1.4, abs=0.05)


def test_far_from_the_strip_what_is_seen_is_not_its_level():
    wheels, true = approach(off=1.2, distance=400.0)
    assert (wheels.height, wheels.climb) == pytest.approx((true + 1.2, -1.4))
