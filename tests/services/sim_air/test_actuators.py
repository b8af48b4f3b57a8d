"""Servos: lag, rate, limits."""

import math
from pathlib import Path

import msgspec
import pytest

from services.sim_air.actuators import Actuators, Servo
from services.sim_air.airframe import Controls
from uvf.runtime.site import ROOT
from uvf.runtime.vehicle_file import load_vehicle

BODY = load_vehicle(Path(ROOT) / "vehicles", "milvus").air


def test_a_small_step_is_followed_with_the_lag():
    servo = Servo(0.0, 0.4, BODY)
    for _ in range(10):
        servo.step(0.01, BODY.servo_lag / 10)
    assert servo.position == pytest.approx(0.01 * (1 - math.exp(-1)))


def test_a_large_step_is_followed_at_the_servos_rate():
    servo = Servo(-0.4, 0.4, BODY)
    servo.step(0.4, 0.005)
    assert servo.position == pytest.approx(-0.4 + BODY.servo_rate * 0.005)


def test_a_command_beyond_the_stop_ends_at_the_stop():
    servo = Servo(0.0, 0.4, BODY)
    for _ in range(400):
        servo.step(9.0, 0.005)
    assert servo.position == pytest.approx(0.4)


def test_a_servo_without_lag_is_there_at_once():
    body = msgspec.structs.replace(BODY, servo_lag=0.0, servo_rate=1e9)
    assert Servo(0.0, 0.4, body).step(0.1, 0.005) == pytest.approx(0.1)


def test_each_surface_has_its_own_servo_and_the_throttle_none():
    actuators = Actuators(Controls(0.1, -0.1, 0.05, 0.6), BODY)
    for _ in range(400):
        position = actuators.step(Controls(-0.2, 0.3, 0.1, 1.4), 0.005)
    assert (position.aileron, position.elevator, position.rudder) == pytest.approx((-0.2, 0.3, 0.1))
    assert position.throttle == 1.0
