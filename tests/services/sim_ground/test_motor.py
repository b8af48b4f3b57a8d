"""A wheel's motor: the torque-speed line, the lag, and what it does to a wheel in the engine."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from services.sim_ground.motor import WheelMotor
from uvf.models.vehicle.file import Motor

DT = 0.005
MOTOR = Motor(stall_torque=0.4, no_load_speed=20.0, lag=0.05)


@pytest.mark.parametrize(("speed", "torque"), [(0.0, 0.4), (5.0, 0.3), (10.0, 0.2), (20.0, 0.0), (25.0, 0.0), (-5.0, 0.4)])
def test_the_torque_falls_in_a_straight_line_to_the_no_load_speed(speed, torque):
    assert WheelMotor(MOTOR, DT).torque(speed, error=1.0) == pytest.approx(torque)
    assert WheelMotor(MOTOR, DT).torque(-speed, error=-1.0) == pytest.approx(torque)


def test_the_reference_follows_a_step_as_a_first_order_lag_does():
    motor = WheelMotor(MOTOR, DT)
    for n in range(1, 41):
        motor.step(10.0, 0.0)
        assert motor.reference == pytest.approx(10.0 * (1 - np.exp(-n * DT / MOTOR.lag)))


@given(st.floats(allow_nan=False, allow_infinity=False), st.floats(-1e6, 1e6))
def test_no_command_asks_for_more_than_the_motor_has(command, speed):
    motor = WheelMotor(MOTOR, DT)
    assert 0.0 <= motor.step(command, speed) <= MOTOR.stall_torque
    assert abs(motor.reference) <= MOTOR.no_load_speed


def test_without_a_lag_the_reference_is_the_command():
    motor = WheelMotor(Motor(stall_torque=0.4, no_load_speed=20.0), DT)
    motor.step(7.0, 0.0)
    assert motor.reference == 7.0
