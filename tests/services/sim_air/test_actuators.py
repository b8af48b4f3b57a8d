"""Servos: lag, rate, limits."""

import math
from pathlib import Path

import msgspec
import pytest

from services.sim_air.actuators import Actuators, Servo
from services.sim_air.engine.wiring import Controls
from uvf.models.scenario import ROOT
from uvf.models.vehicle.air import Lever, Surface
from uvf.models.vehicle.file import load_vehicle

BODY = load_vehicle(Path(ROOT) / "vehicles", "milvus").air
STOPS = (-0.4, 0.4)


def test_a_small_step_is_followed_with_the_lag():
    servo = Servo(0.0, STOPS, BODY.servo_rate, BODY.servo_lag)
    for _ in range(10):
        servo.step(0.01, BODY.servo_lag / 10)
    assert servo.position == pytest.approx(0.01 * (1 - math.exp(-1)))


def test_a_large_step_is_followed_at_the_servos_rate():
    servo = Servo(-0.4, STOPS, BODY.servo_rate, BODY.servo_lag)
    servo.step(0.4, 0.005)
    assert servo.position == pytest.approx(-0.4 + BODY.servo_rate * 0.005)


def test_a_command_beyond_the_stop_ends_at_the_stop():
    servo = Servo(0.0, STOPS, BODY.servo_rate, BODY.servo_lag)
    for _ in range(400):
        servo.step(9.0, 0.005)
    assert servo.position == pytest.approx(0.4)


def test_a_servo_without_lag_is_there_at_once():
    assert Servo(0.0, STOPS, 1e9, 0.0).step(0.1, 0.005) == pytest.approx(0.1)


def test_each_surface_has_its_own_servo_and_the_throttle_none():
    actuators = Actuators(Controls(0.1, -0.1, 0.05, 0.6), BODY)
    for _ in range(400):
        position = actuators.step(Controls(-0.2, 0.3, 0.1, 1.4), 0.005)
    assert (position.aileron, position.elevator, position.rudder) == pytest.approx((-0.2, 0.3, 0.1))
    assert position.throttle == 1.0


def after(body, command, seconds):
    actuators = Actuators(Controls(), body)
    for _ in range(round(seconds / 0.005)):
        position = actuators.step(command, 0.005)
    return position


def test_flaps_go_down_only_and_as_far_as_they_go():
    assert after(BODY, Controls(flap=-0.3), 1.0).flap == 0.0
    assert after(BODY, Controls(flap=9.0), 1.0).flap == pytest.approx(BODY.controls.flap.limit)


def test_an_elevator_goes_as_far_as_it_goes_each_way():
    unequal = msgspec.structs.replace(BODY.controls, elevator=Surface(limit=0.1, negative_limit=0.3))
    body = msgspec.structs.replace(BODY, controls=unequal)
    assert after(body, Controls(elevator=9.0), 1.0).elevator == pytest.approx(0.1)
    assert after(body, Controls(elevator=-9.0), 1.0).elevator == pytest.approx(-0.3)


def test_brakes_hold_at_once_and_no_more_than_wholly():
    assert after(BODY, Controls(brake=3.0), 0.005).brake == 1.0


def test_a_surface_with_a_slow_servo_of_its_own_is_later_than_the_others():
    slow = msgspec.structs.replace(BODY.controls, flap=Surface(limit=0.6, rate=0.1))
    position = after(msgspec.structs.replace(BODY, controls=slow), Controls(elevator=0.3, flap=0.3), 1.0)
    assert position.elevator == pytest.approx(0.3, abs=1e-3)
    assert position.flap == pytest.approx(0.1)


def test_a_motor_with_a_lag_comes_up_as_a_first_order_lag_does():
    lagging = msgspec.structs.replace(BODY.controls, throttle=Lever(lag=0.5))
    assert after(msgspec.structs.replace(BODY, controls=lagging), Controls(throttle=1.0), 0.5).throttle == pytest.approx(1 - math.exp(-1))
