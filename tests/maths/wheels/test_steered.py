"""A car's steering against the geometry of the turn: each wheel stands across the line to the centre."""

from math import atan, inf, pi, tan

import numpy as np
import pytest

from uvf.maths.kinematics import Twist
from uvf.maths.wheels.steered import AckermannDrive, wheel_steering

CAR = AckermannDrive(wheel_radius=0.05, track=0.24, wheelbase=0.325, max_steering=0.42)


@pytest.mark.parametrize("curvature", [0.9, -0.9, 0.05, 0.0])
@pytest.mark.parametrize("place", [(0.325, 0.12), (0.325, -0.12), (0.325, 0.0), (-0.4, 0.1)])
def test_a_wheel_rolls_across_the_line_to_the_centre_of_the_turn(curvature, place):
    angle = wheel_steering(curvature, *place)
    velocity = np.array((1.0 - curvature * place[1], curvature * place[0]))  # of the point where it stands, at 1 m/s
    assert np.array((-np.sin(angle), np.cos(angle))) @ velocity == pytest.approx(0.0, abs=1e-12)
    assert abs(angle) < pi / 2


def test_the_inner_wheel_is_turned_more():
    inner, outer = (wheel_steering(CAR.curvature(0.4), 0.325, y) for y in (0.12, -0.12))
    assert inner > 0.4 > outer
    assert 1 / tan(outer) - 1 / tan(inner) == pytest.approx(0.24 / 0.325)  # Ackermann's condition


def test_the_tightest_circle_is_that_of_the_steering_at_its_stop():
    assert CAR.turning_radius == pytest.approx(0.325 / tan(0.42))
    assert CAR.steering(1 / CAR.turning_radius) == pytest.approx(0.42)
    assert CAR.steering(0.0) == CAR.curvature(0.0) == 0.0
    assert CAR.steering(inf) == pytest.approx(pi / 2)
    assert CAR.curvature(-0.3) == pytest.approx(-tan(0.3) / 0.325)


def test_its_straight_axle_is_a_differential_drive():
    wheels = CAR.wheels(Twist(1.0, 1.0))
    assert wheels == pytest.approx((0.88 / 0.05, 1.12 / 0.05))
    assert CAR.twist(wheels) == pytest.approx((1.0, 1.0, 0.0))
    assert CAR.steering(1.0) == atan(0.325)
