"""What an instrument adds to the truth, and what it repeats."""

import numpy as np
import pytest

from uvf.maths.geodesy import LocalTangent
from uvf.sensors.errors import Errors
from uvf.sensors.instruments import InertialUnit, Receiver

NONE = Errors()
RATE, FORCE, FIELD = np.array((0.1, 0.2, 0.3)), np.array((0.0, 0.0, 9.8)), np.array((0.0, 2e-5, -4e-5))
TANGENT = LocalTangent.from_degrees(40.77, 14.79, 300.0)


def readings(gyro=NONE, mag=NONE, mag_hz=100.0, count=100, seed=1):
    unit = InertialUnit(gyro, NONE, mag, mag_hz, np.random.default_rng(seed))
    return [unit.read(n / 100, RATE, FORCE, FIELD) for n in range(1, count + 1)]


def test_without_errors_it_tells_the_truth():
    assert [list(part) for part in readings()[0][1:]] == [list(RATE), list(FORCE), list(FIELD)]


def test_a_slower_magnetometer_repeats_its_last_field():
    fields = [tuple(r.magnetic_field) for r in readings(mag=Errors(noise=1e-7), mag_hz=25.0)]
    assert len(set(fields[3:])) == 25
    assert all(len(set(fields[k : k + 4])) == 1 for k in range(3, 96, 4))


def test_the_magnetometers_rate_does_not_change_the_gyroscopes_stream():
    slow, fast = (readings(Errors(noise=0.1), Errors(noise=1e-7), mag_hz) for mag_hz in (10.0, 100.0))
    assert all((a.angular_velocity == b.angular_velocity).all() for a, b in zip(slow, fast, strict=True))


def test_a_receiver_gives_the_place_in_degrees_of_the_globe():
    fix = Receiver(NONE, NONE, TANGENT, np.random.default_rng(0)).read(1.0, np.array((30.0, -40.0, 5.0)), np.array((1.0, 2.0, 3.0)))
    assert TANGENT.enu(fix.latitude, fix.longitude, fix.altitude) == pytest.approx((30.0, -40.0, 5.0), abs=1e-6)
    assert list(fix.velocity) == [1.0, 2.0, 3.0]
