"""The side of a wheel is told by its name as people write it."""

import pytest

from uvf.models.importing.driving.drive_wheels import LEFT, RIGHT


@pytest.mark.parametrize("name", ["wheel_left_link", "left_wheel_joint", "lwheel", "wheelL", "driveL_joint", "wheel_l", "motor-l"])
def test_left(name):
    assert LEFT.search(name)
    assert not RIGHT.search(name)


@pytest.mark.parametrize("name", ["wheel_right_link", "right_wheel_joint", "rwheel", "wheelR", "driveR_joint", "wheel_r", "motor-r"])
def test_right(name):
    assert RIGHT.search(name)
    assert not LEFT.search(name)


@pytest.mark.parametrize("name", ["wheel_1_link", "wheel_front_joint", "castor"])
def test_neither(name):
    assert not LEFT.search(name)
    assert not RIGHT.search(name)
