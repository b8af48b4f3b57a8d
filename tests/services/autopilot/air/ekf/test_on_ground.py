"""It begins on the ground: attitude by gravity and compass, biases while it stands, a catapult's launch."""

import math

import numpy as np
import pytest

from tests.services.autopilot.air.ekf.flying import DT, EARTH, PARAMS, SHEET, G
from uvf.estimation.ekf.alignment import attitude
from uvf.estimation.ekf.estimator import FullEstimator
from uvf.estimation.mount import ImuMount
from uvf.estimation.sensor_inputs import GnssFix, InertialSample, Pressures, Sensed

ROLL, PITCH, YAW = 0.02, 0.1, 2.5
STATIC = 97_000.0


class Standing:
    """Sensors of an aircraft that stands, then is thrown along its nose by ``launch`` [m/s^2]."""

    def __init__(self, wind=0.0, seed=0):
        self.rng = np.random.default_rng(seed)
        self.rotation = attitude(ROLL, PITCH, YAW).matrix()
        self.wind, self.speed, self.place = wind, 0.0, np.zeros(3)
        self.k = 0
        self.estimator = FullEstimator(EARTH, SHEET)
        self.gyro_bias = np.array((0.004, -0.003, 0.005))

    def run(self, seconds, launch=0.0, fixed=True):
        for _ in range(round(seconds / DT)):
            samples = [self._sample(launch, age) for age in (0.01, 0.0)]
            self.k += 1
            fix = self._fix() if fixed and self.k % 10 == 1 else None
            rho, flow = 1.16, max(self.speed + self.wind, 0.0)
            pressures = Pressures(STATIC - 11.4 * -self.place[2], 0.5 * rho * flow**2, STATIC / (287.05 * rho))
            if fix is not None or self.estimator.started:
                now = self.estimator.step(Sensed(samples, pressures, fix), PARAMS, DT)
        return now

    def _sample(self, launch, age):
        nose = self.rotation[:, 0]
        self.place = self.place + 0.01 * self.speed * nose + 0.5e-4 * launch * nose
        self.speed += 0.01 * launch
        n = self.rng.standard_normal
        force = self.rotation.T @ (launch * nose - G)
        return InertialSample(
            tuple(self.gyro_bias + 0.0023 * n(3)), tuple(force + 0.025 * n(3)), tuple(self.rotation.T @ EARTH + 5e-7 * n(3)), age
        )

    def _fix(self):
        n = self.rng.standard_normal
        (north, east, down), (vn, ve, vd) = self.place + 0.5 * n(3), self.speed * self.rotation[:, 0] + 0.1 * n(3)
        return GnssFix(north, east, -down, vn, ve, -vd, 0.0, 0.5, 0.5, 0.1)


def test_it_is_aligned_within_two_seconds():
    now = Standing().run(2.0)
    assert (now.roll, now.pitch) == pytest.approx((ROLL, PITCH), abs=0.005)
    assert math.remainder(now.yaw - YAW, math.tau) == pytest.approx(0.0, abs=0.02)


def test_standing_tells_the_gyroscopes_biases():
    standing = Standing()
    standing.run(5.0)
    np.testing.assert_allclose(standing.estimator._aiding.filter.state.x[9:12], standing.gyro_bias, atol=5e-4)


def test_standing_holds_without_satellites():
    standing = Standing()
    standing.run(5.0)
    before = standing.run(0.02)
    now = standing.run(60.0, fixed=False)
    assert math.hypot(now.north - before.north, now.east - before.east) < 0.5
    assert now.ground_speed < 0.1


def test_in_a_gale_it_stands_without_a_wind_of_its_own():
    now = Standing(wind=15.0).run(5.0)
    assert now.ground_speed < 0.2
    assert (now.roll, now.pitch) == pytest.approx((ROLL, PITCH), abs=0.01)


def test_a_launch_at_three_g_is_followed():
    standing = Standing()
    standing.run(5.0)
    now = standing.run(0.8, launch=3 * 9.81)
    assert now.ground_speed == pytest.approx(standing.speed * math.cos(PITCH), abs=0.5)
    assert (now.roll, now.pitch) == pytest.approx((ROLL, PITCH), abs=0.02)
    assert now.airspeed == pytest.approx(standing.speed, abs=3.0)


def test_a_mount_askew_and_ahead_is_read_as_if_it_were_not():
    """Half a metre ahead of an aircraft that spins at 1 rad/s the IMU is drawn inwards by 0.5 m/s^2; its own left is backwards."""
    mount, straight = ImuMount((0.5, 0.0, 0.0), (0.0, 0.0, math.pi / 2)), (0.0, 0.0, 1.0)
    spun = mount.at_centre(InertialSample(straight, (0.0, -0.5, -9.8), (0.0, 0.0, 0.0)), 0.01)
    assert spun.rates == pytest.approx(straight)
    assert spun.force == pytest.approx((0.0, 0.0, -9.8), abs=1e-9)
