"""Limits keep the curvature; the ramp keeps the accelerations."""

import pytest

from uvf.control.drive_limits import DriveLimits, VelocityRamp, within_limits
from uvf.maths.kinematics import Twist

LIMITS = DriveLimits(linear=0.5, angular=2.0, linear_acceleration=0.8, angular_acceleration=4.0)


@pytest.mark.parametrize("asked", [(2.0, 1.0), (0.3, 5.0), (-1.0, -3.0), (0.2, 0.1)])
def test_what_is_too_fast_is_slowed_on_the_same_arc(asked):
    linear, angular, _ = within_limits(Twist(*asked), LIMITS, LIMITS.linear)
    assert abs(linear) <= LIMITS.linear + 1e-12
    assert abs(angular) <= LIMITS.angular + 1e-12
    assert linear * asked[1] == pytest.approx(angular * asked[0])


def test_a_mission_may_ask_for_less_but_not_for_more():
    assert within_limits(Twist(0.5, 0.0), LIMITS, 0.2) == (0.2, 0.0, 0.0)
    assert within_limits(Twist(0.9, 0.0), LIMITS, 3.0) == (0.5, 0.0, 0.0)


def test_the_ramp_reaches_the_speed_after_the_time_it_takes():
    ramp = VelocityRamp(LIMITS)
    speeds = [ramp.lead(Twist(0.4, 2.0), 0.02) for _ in range(30)]
    assert speeds[0] == pytest.approx((0.016, 0.08, 0.0))
    assert speeds[24] == pytest.approx((0.4, 2.0, 0.0))
    assert speeds[23][0] < 0.4
    assert speeds[29] == pytest.approx((0.4, 2.0, 0.0))


def test_the_ramp_slows_down_too():
    ramp = VelocityRamp(LIMITS)
    ramp.velocity = Twist(0.4, 0.0)
    assert ramp.lead(Twist(0.0, 0.0), 0.02)[0] == pytest.approx(0.384)


def test_sideways_counts_like_ahead():
    assert within_limits(Twist(0.3, 0.0, 0.4), LIMITS, 0.25) == pytest.approx((0.15, 0.0, 0.2))
    ramp = VelocityRamp(LIMITS)
    assert ramp.lead(Twist(0.0, 0.0, -1.0), 0.02) == pytest.approx((0.0, 0.0, -0.016))
    ramp.stand()
    assert ramp.velocity == (0.0, 0.0, 0.0)
