"""Each sensor that is lost makes the estimate worse, none breaks it; what comes back is taken softly."""

import math

import numpy as np
import pytest

from tests.services.autopilot.air.ekf.flying import DT, PARAMS, Flown, fly
from uvf.estimation.ekf.datasheet import Datasheet


def off(flown, now):
    """m, horizontally."""
    return math.hypot(now.north - flown.position[0], now.east - flown.position[1])


class Seen:
    """Errors and sigmas of each cycle."""

    def __init__(self):
        self.off, self.sigma, self.places, self.known = [], [], [], []

    def __call__(self, flown, now):
        self.off.append(off(flown, now))
        self.sigma.append(now.position_sigma)
        self.places.append((now.north - flown.position[0], now.east - flown.position[1]))
        self.known.append(now.position_known)


@pytest.fixture(scope="module")
def outage():
    """8 s with fixes, 30 s without, 8 s with."""
    flown, seen = Flown(seed=5), Seen()
    estimator = fly(flown, 8.0)
    fly(flown, 30.0, seen, estimator, fix=None)
    back = Seen()
    fly(flown, 8.0, back, estimator)
    return seen, back


def test_thirty_seconds_without_satellites_are_reckoned_within_what_sigma_says(outage):
    seen, _ = outage
    assert all(e < 3.5 * s for e, s in zip(seen.off, seen.sigma, strict=True))
    assert seen.off[-1] < 40.0


def test_sigma_grows_without_satellites(outage):
    seen, _ = outage
    assert all(b > a for a, b in zip(seen.sigma, seen.sigma[50:], strict=False))
    assert not seen.known[-1]


def test_satellites_back_move_the_position_softly_and_soon(outage):
    seen, back = outage
    steps = np.linalg.norm(np.diff(np.array(seen.places[-1:] + back.places), axis=0), axis=1)
    assert steps.max() < 0.05 * seen.off[-1] + 0.2
    assert back.off[-1] < 1.0
    assert back.known[-1]


def test_gyroscopes_with_a_large_bias_are_found_out():
    sheet = Datasheet(gyro_noise=0.0023, accel_noise=0.025, gyro_bias=0.02)
    flown = Flown(seed=2, sheet=sheet)
    flown.gyro_bias = np.array((0.02, -0.02, 0.02))
    estimator = fly(flown, 15.0)
    np.testing.assert_allclose(estimator._aiding.filter.state.x[9:12], flown.gyro_bias, atol=0.002)


@pytest.mark.parametrize("missing", ["magnetometer", "pressures", "both"])
def test_without_magnetometer_or_pressures_it_goes_on(missing):
    flown, errors = Flown(seed=4), []
    if missing != "pressures":
        flown.imu = without_field(flown.imu)
    without = {} if missing == "magnetometer" else {"pressures": None}
    estimator = fly(flown, 20.0, **without)
    fly(flown, 10.0, lambda f, now: errors.append((off(f, now), *f.errors(estimator)[:3])), estimator, **without)
    rms = np.sqrt(np.mean(np.square(errors), axis=0))
    assert rms[0] < 0.7
    assert (rms[1:3] < 0.02).all()
    assert rms[3] < 0.05


def without_field(imu):
    def sample():
        read = imu()
        return type(read)(read.rates, read.force, (0.0, 0.0, 0.0), read.age)

    return sample


def test_with_the_imu_alone_it_stays_upright():
    flown = Flown(seed=6)
    estimator = fly(flown, 8.0)
    fly(flown, 30.0, None, estimator, fix=None, pressures=None)
    assert np.abs(flown.errors(estimator)[:2]).max() < 0.05


def test_a_silent_imu_is_bridged():
    flown = Flown(seed=7)
    estimator = fly(flown, 8.0)
    for _ in range(50):
        flown.sensed()
    estimator.step(flown.sensed(), PARAMS, 51 * DT)
    fly(flown, 8.0, None, estimator)
    assert np.abs(flown.errors(estimator)[:3]).max() < 0.03
    assert np.abs(flown.errors(estimator)[6:8]).max() < 1.0


def test_a_receiver_that_insists_for_long_is_believed():
    flown = Flown(seed=8)
    estimator = fly(flown, 8.0)
    flown.position = flown.position + np.array((500.0, 0.0, 0.0))
    flown._past = [(t, v, p + np.array((500.0, 0.0, 0.0))) for t, v, p in flown._past]
    ratios = []
    fly(flown, 2.0, lambda _, now: ratios.append(now.ratios.position), estimator)
    assert max(ratios) > 1.0
    assert abs(flown.errors(estimator)[6]) > 400.0
    fly(flown, 6.0, None, estimator)
    assert abs(flown.errors(estimator)[6]) < 1.0


def test_satellites_elsewhere_and_then_no_imu_sample_in_time():
    """Where it was is forgotten with the old state; the next pressure asked for it before the next sample had come."""
    flown = Flown(seed=7)
    estimator = fly(flown, 8.0)
    delay = estimator._aiding.delay
    estimator._aiding._begin_at(np.array((5000.0, 0.0, -60.0)), np.array((20.0, 0.0, 0.0)), flown._fix(), estimator._sampled)
    assert len(delay._past) == 1
    estimator.step(flown.sensed(fixed=False, samples=[]), PARAMS, DT)
    assert estimator.started
