"""Messages become the numbers that they mean."""

import numpy as np
import pytest

from schemas.messages import LaserScan, Mode
from uvf.runtime.messages.convert import mode_name, scan_points, scan_rays


def scan(*ranges):
    """Beams at 0, 90, 180 ... degrees."""
    return LaserScan(start_angle=0.0, end_angle=np.pi / 2 * (len(ranges) - 1), ranges=ranges)


def test_the_points_of_a_scan_lie_where_its_beams_point_in_order():
    assert scan_points(scan(1.0, 2.0, 3.0)) == pytest.approx(np.array(((1.0, 0.0), (0.0, 2.0), (-3.0, 0.0))))


@pytest.mark.parametrize("nothing", [0.0, np.nan, np.inf, -np.inf])
def test_a_beam_without_a_return_is_no_point_but_keeps_its_direction(nothing):
    seen = scan(1.0, nothing, 3.0)
    assert scan_points(seen) == pytest.approx(np.array(((1.0, 0.0), (-3.0, 0.0))))
    ranges, rays = scan_rays(seen)
    assert ranges.tolist() == [1.0, 0.0, 3.0]
    assert rays[1] == pytest.approx((0.0, 1.0))


def test_a_scan_of_nothing_has_no_points():
    assert scan_points(LaserScan()).shape == scan_points(scan(0.0, 0.0)).shape == (0, 2)


def test_modes_are_named_without_their_prefix_and_unknown_ones_by_number():
    assert mode_name(Mode.MODE_MISSION) == "MISSION"
    assert mode_name(99) == "99"
