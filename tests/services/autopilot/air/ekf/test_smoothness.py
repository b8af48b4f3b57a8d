"""The airspeed that control is told is smooth: the noise of the pressures does not go into the surfaces."""

import numpy as np
import pytest

from tests.services.autopilot.air.ekf.flying import DT, SPEED
from uvf.estimation.ekf.air import AirData
from uvf.estimation.sensor_inputs import Pressures
from uvf.maths import atmosphere

STILL, GUSTY = 0.05, 1.0  # m/s/sqrt(s), of the wind's walk
STATIC = 100_000.0  # Pa


def pressures(speed, noise=0.0):
    return Pressures(STATIC, 0.5 * atmosphere.density(STATIC, 288.0) * speed**2 + noise, 288.0)


def smoothed(speeds, gained, walk, noise, seed=1):
    air, rng, found = AirData(4.0), np.random.default_rng(seed), []
    for k, (speed, gain) in enumerate(zip(speeds, gained, strict=True)):
        air.take(pressures(speed, noise * rng.standard_normal()), k * DT, DT)
        found.append(air.smooth(0.0, gain, walk, DT))
    return np.array(found)


def test_noise_of_the_pressures_is_kept_out_of_the_airspeed_in_calm_air():
    flat = np.full(1000, SPEED)
    calm, gusty = (smoothed(flat, 0 * flat, walk, 4.0)[200:] for walk in (STILL, GUSTY))
    assert np.abs(np.diff(calm)).mean() < 0.15 * np.abs(np.diff(gusty)).mean()
    assert calm.mean() == pytest.approx(SPEED, abs=0.02)


def test_what_it_gains_itself_is_told_at_once_and_a_gust_as_soon_as_gusts_are_known():
    t = np.arange(1000) * DT
    ramp = SPEED + np.clip(t - 10.0, 0.0, 3.0)
    gained = np.where((t >= 10.0) & (t < 13.0), 1.0, 0.0)
    assert np.abs(smoothed(ramp, gained, STILL, 0.0) - ramp).max() < 0.1
    step = np.where(t < 10.0, SPEED, SPEED + 2.0)
    arrives = {walk: np.flatnonzero(smoothed(step, 0 * t, walk, 0.0) > SPEED + 1.0)[0] * DT - 10.0 for walk in (STILL, GUSTY)}
    assert arrives[GUSTY] < 0.15 < arrives[STILL] < 1.0
