"""A car's velocity: the speed as the motor can, the turn as the steering can, and no turn without driving."""

import pytest

from uvf.control.drive_limits import DriveLimits, VelocityRamp
from uvf.control.steered_ramp import SteeredRamp, velocity_ramp
from uvf.maths.kinematics import Twist
from uvf.maths.wheels.steered import AckermannDrive
from uvf.models.scenario import ROOT
from uvf.models.vehicle.file import load_vehicle

LIMITS = DriveLimits(linear=2.0, angular=2.0, linear_acceleration=1.0, angular_acceleration=4.0)
CAR = AckermannDrive(wheel_radius=0.05, track=0.24, wheelbase=0.3, max_steering=0.4)
RATE, DT = 2.0, 0.02


def ramp_after(wanted, steps, ramp=None):
    ramp = ramp or SteeredRamp(LIMITS, CAR, RATE)
    for _ in range(steps):
        ramp.lead(wanted, DT)
    return ramp


def test_speed_and_steering_take_their_time_and_the_turn_follows_from_both():
    ramp = ramp_after(Twist(1.0, 1.0), 5)
    assert ramp.steering == pytest.approx(5 * RATE * DT)
    assert ramp.velocity == pytest.approx((0.1, 0.1 * CAR.curvature(0.2), 0.0))
    ramp = ramp_after(Twist(1.0, 1.0), 60, ramp)
    assert ramp.velocity == pytest.approx((1.0, 1.0, 0.0))


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_it_turns_no_tighter_than_its_steering_goes(way):
    ramp = ramp_after(Twist(way * 0.5, 2.0), 100)
    assert ramp.steering == pytest.approx(way * 0.4)
    assert ramp.velocity == pytest.approx((way * 0.5, 0.5 / CAR.turning_radius, 0.0))


def test_backwards_it_turns_to_the_side_that_is_asked_for():
    ramp = ramp_after(Twist(-0.5, 0.3), 100)
    assert ramp.velocity == pytest.approx((-0.5, 0.3, 0.0))
    assert ramp.steering < 0.0


def test_a_turn_on_the_spot_is_none_and_leaves_the_steering_where_it_is():
    ramp = ramp_after(Twist(1.0, 1.0), 60)
    held = ramp.steering
    ramp = ramp_after(Twist(0.0, -2.0), 100, ramp)
    assert ramp.velocity == (0.0, 0.0, 0.0)
    assert ramp.steering == held


def test_who_is_told_to_stand_stands_at_once():
    ramp = ramp_after(Twist(1.0, 1.0), 60)
    ramp.stand()
    assert ramp.velocity == (0.0, 0.0, 0.0)


def test_a_car_has_this_ramp_and_others_do_not():
    made = {name: velocity_ramp(load_vehicle(ROOT / "vehicles", name).ground) for name in ("minicar", "burger")}
    assert isinstance(made["minicar"], SteeredRamp) and isinstance(made["burger"], VelocityRamp)
    assert made["burger"].steering == 0.0
