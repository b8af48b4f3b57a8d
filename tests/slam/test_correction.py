"""The published correction goes to the matched one in small steps."""

import numpy as np
import pytest

from uvf.maths.se2 import IDENTITY
from uvf.slam.correction import toward


def test_a_correction_arrives_without_a_step_longer_than_allowed():
    pose, target = IDENTITY, (0.1, 0.0, 0.02)
    steps = 0
    while pose != pytest.approx(target):
        last, pose = pose, toward(pose, target, 0.01, 0.01)
        assert np.hypot(pose[0] - last[0], pose[1] - last[1]) <= 0.01 + 1e-12
        steps += 1
    assert steps == 10


def test_a_heading_goes_the_shorter_way_round():
    turned = toward((0.0, 0.0, 3.1), (0.0, 0.0, -3.1), 1.0, 0.02)
    assert turned[2] == pytest.approx(3.12)
