"""Wheels with rollers: forward against inverse kinematics, the textbook's signs, and drives that lack a way to go."""

from math import pi

import pytest
from hypothesis import given
from hypothesis import strategies as st

from uvf.maths.kinematics import Twist
from uvf.maths.wheels.omnidirectional import OmnidirectionalDrive, RollerWheel, mecanum_wheels

MECANUM = OmnidirectionalDrive(0.05, mecanum_wheels(track=0.4, wheelbase=0.3))
KIWI = OmnidirectionalDrive(0.04, tuple(RollerWheel(0.0, 0.0, heading) for heading in (0.0, 2 * pi / 3, -2 * pi / 3)))
ROUND = OmnidirectionalDrive(
    0.04, tuple(RollerWheel(*place, heading) for place, heading in (((0.0, -0.2), 0.0), ((0.17, 0.1), 2.1), ((-0.17, 0.1), -2.1)))
)
twists = st.builds(Twist, st.floats(-1, 1), st.floats(-3, 3), st.floats(-1, 1))


@pytest.mark.parametrize("drive", [MECANUM, ROUND])
@given(twist=twists)
def test_the_wheels_for_a_motion_make_it(drive, twist):
    assert tuple(drive.twist(drive.wheels(twist))) == pytest.approx(tuple(twist), abs=1e-9)


def test_mecanum_wheels_turn_as_the_textbook_has_it():
    """Front left, rear left, front right, rear right: r w = v_x -+ v_y -+ (l_x + l_y) omega."""
    assert MECANUM.wheels(Twist(0.5, 0.0)) == pytest.approx((10.0,) * 4)
    assert MECANUM.wheels(Twist(0.0, 0.0, 0.5)) == pytest.approx((-10.0, 10.0, 10.0, -10.0))
    assert MECANUM.wheels(Twist(0.0, 1.0)) == pytest.approx((-7.0, -7.0, 7.0, 7.0))
    assert MECANUM.track == pytest.approx(0.7)


@given(twists)
def test_what_they_have_rolled_is_told_as_of_two_wheels_and_sideways(twist):
    ways = MECANUM.travel(MECANUM.wheels(twist))
    assert (ways.left + ways.right) / 2 == pytest.approx(twist.linear, abs=1e-9)
    assert (ways.right - ways.left) / MECANUM.track == pytest.approx(twist.angular, abs=1e-9)
    assert ways.aside == pytest.approx(twist.lateral, abs=1e-9)


def test_a_drive_that_cannot_go_every_way_is_found():
    assert MECANUM.is_complete and ROUND.is_complete
    assert not KIWI.is_complete  # all in one place: it does not turn
    assert not OmnidirectionalDrive(0.05, tuple(RollerWheel(0.1, y) for y in (0.2, 0.0, -0.2))).is_complete
    assert not OmnidirectionalDrive(0.05, mecanum_wheels(0.4, 0.3)[:2]).is_complete
