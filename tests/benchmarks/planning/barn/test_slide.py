"""The odometry corrected by sideslip follows a Jackal through fast curves better than without."""

import numpy as np

from benchmarks.planning.barn.jackal import Drive
from benchmarks.planning.barn.stack import SIDESLIP, Slide
from uvf.maths.kinematics import Twist
from uvf.maths.se2 import Pose2

DT = 0.005  # s


def drive(seconds):
    """True place (2,) [m] after a fast curve, and those that wheels and gyroscope without any error tell, corrected or not."""
    vehicle, slide, plain = Drive((0.0, 0.0, 0.0), DT), Slide(SIDESLIP), np.zeros(2)
    corrected = Pose2(0.0, 0.0, 0.0)
    for k in range(round(seconds / DT)):
        t = k * DT
        yaw = float(vehicle.pose[2])
        plain = plain + DT * vehicle.twist.linear * np.array((np.cos(yaw), np.sin(yaw)))
        if k % 10 == 0:
            corrected = slide.corrected(t, Pose2(float(plain[0]), float(plain[1]), yaw), vehicle.twist)
        vehicle.step(Twist(1.5, 2.0))
    return vehicle.pose[:2].copy(), np.array(corrected[:2]), plain


def test_the_slide_out_of_a_curve_is_told():
    true, corrected, plain = drive(1.5)
    assert np.hypot(*(plain - true)) > 0.25
    assert np.hypot(*(corrected - true)) < 0.2 * np.hypot(*(plain - true))


def test_without_a_turn_nothing_slides():
    slide = Slide(SIDESLIP)
    for t in np.arange(0.0, 1.0, 0.05):
        pose = Pose2(1.5 * float(t), 0.0, 0.0)
        assert slide.corrected(float(t), pose, Twist(1.5, 0.0)) == pose
