"""The whole estimator on exact sensors of a steady level turn through a wind."""

import functools
import math

import numpy as np
import pytest

from uvf.estimation.beard_mclain import BookEstimator
from uvf.estimation.sensor_inputs import GnssFix, InertialSample, Pressures, Sensed
from uvf.maths import atmosphere
from uvf.models.vehicle.flight_params import AirParams

G = 9.80665
SPEED = 25.0
WIND = (2.0, -1.0)  # north, east
STATIC = atmosphere.pressure(360.0)
RHO = atmosphere.density(STATIC, 285.8)
PRESSURES = Pressures(STATIC, 0.5 * RHO * SPEED**2, 285.8)
ALPHA_ZERO, ALPHA_LOAD = -0.044, 6.2
PARAMS = AirParams(alpha_zero_lift=ALPHA_ZERO, alpha_per_load=ALPHA_LOAD)
FIELD_NED = np.array((24e-6, 0.0, 40e-6))
DT = 0.02


class Turn:
    """A coordinated level turn: roll, the alpha that carries its load, the pitch that keeps it level."""

    def __init__(self, roll):
        self.roll = roll
        eas2 = SPEED**2 * RHO / atmosphere.RHO0
        self.alpha = ALPHA_ZERO + ALPHA_LOAD * G / math.cos(roll) / eas2
        self.pitch = math.atan(math.cos(roll) * math.tan(self.alpha))
        self.rate = G * math.tan(roll) / SPEED
        self.field = FIELD_NED

    def body_from_ned(self, yaw):
        sr, cr, sp, cp = math.sin(self.roll), math.cos(self.roll), math.sin(self.pitch), math.cos(self.pitch)
        about_x = np.array(((1, 0, 0), (0, cr, sr), (0, -sr, cr)))
        about_y = np.array(((cp, 0, -sp), (0, 1, 0), (sp, 0, cp)))
        about_z = np.array(((math.cos(yaw), math.sin(yaw), 0), (-math.sin(yaw), math.cos(yaw), 0), (0, 0, 1)))
        return about_x @ about_y @ about_z

    def yaw(self, t):
        """The nose, when the flight through the air started northwards."""
        along = self.body_from_ned(0.0).T @ (math.cos(self.alpha), 0.0, math.sin(self.alpha))
        return self.rate * t - math.atan2(along[1], along[0])

    def sample(self, t):
        body = self.body_from_ned(self.yaw(t))
        turning = body @ (0.0, 0.0, self.rate)
        force = np.cross(turning, SPEED * np.array((math.cos(self.alpha), 0.0, math.sin(self.alpha)))) - body @ (0.0, 0.0, G)
        return InertialSample(tuple(turning), tuple(force), tuple(body @ self.field))

    def _on_circle(self, azimuth):
        return SPEED / self.rate * math.sin(azimuth), SPEED / self.rate * (1 - math.cos(azimuth))

    def fix(self, t):
        azimuth = self.rate * t
        through = np.array(self._on_circle(azimuth) if self.rate else (SPEED * t, 0.0))
        north, east = through + np.array(WIND) * t
        return GnssFix(north, east, 60.0, SPEED * math.cos(azimuth) + WIND[0], SPEED * math.sin(azimuth) + WIND[1], 0.0, 0.0, 0.8, 1.5, 0.1)


@functools.cache
def flown(roll, seconds=200.0):
    """The last estimate, the turn and the time; it begins in the turn, knowing nothing of it."""
    turn, estimator = Turn(roll), BookEstimator(declination=0.0)
    for k in range(1, round(seconds / DT) + 1):
        t = k * DT
        now = estimator.step(Sensed([turn.sample(t)], PRESSURES, turn.fix(t) if k % 10 == 1 else None), PARAMS, DT)
    return now, turn, t


@pytest.mark.parametrize("roll", [0.0, 0.5, -0.8])
def test_attitude_is_exact_in_a_steady_turn(roll):
    now, turn, t = flown(roll)
    assert (now.roll, now.pitch) == pytest.approx((roll, turn.pitch), abs=0.01)
    assert math.remainder(now.yaw - turn.yaw(t), math.tau) == pytest.approx(0.0, abs=0.02)


@pytest.mark.parametrize("roll", [0.5, -0.8])
def test_the_wind_is_found_in_a_turn(roll):
    now, _, _ = flown(roll)
    assert (now.wind_north, now.wind_east) == pytest.approx(WIND, abs=0.1)


def test_position_and_ground_velocity_are_those_of_the_fixes():
    now, turn, t = flown(0.5)
    fix = turn.fix(t)
    assert (now.north, now.east, now.height) == pytest.approx((fix.north, fix.east, 60.0), abs=0.2)
    assert now.ground_speed == pytest.approx(math.hypot(fix.v_north, fix.v_east), abs=0.1)
    assert now.climb == pytest.approx(0.0, abs=0.05)


def test_a_compass_is_read_with_its_declination():
    east = 0.1
    turn, estimator = Turn(0.0), BookEstimator(east)
    turn.field = np.array((24e-6 * math.cos(east), 24e-6 * math.sin(east), 40e-6))
    for k in range(1, 1001):
        now = estimator.step(Sensed([turn.sample(k * DT)], PRESSURES, turn.fix(k * DT) if k % 10 == 1 else None), PARAMS, DT)
    assert now.yaw == pytest.approx(0.0, abs=0.01)


def test_airspeed_is_true_airspeed():
    now, _, _ = flown(0.0, seconds=2.0)
    assert now.airspeed == pytest.approx(SPEED)


def test_it_starts_with_the_first_fix():
    estimator = BookEstimator(declination=0.0)
    assert not estimator.started
    now = estimator.step(Sensed([Turn(0.3).sample(0.0)], PRESSURES, Turn(0.3).fix(0.0)), PARAMS, DT)
    assert estimator.started
    assert (now.north, now.east, now.height) == pytest.approx((0.0, 0.0, 60.0), abs=1.0)
