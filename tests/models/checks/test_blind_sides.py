"""Sides of a vehicle on which its lidars together see nothing."""

import numpy as np
import pytest

from uvf.models.checks.blind_sides import blind_sides
from uvf.models.vehicle.sensors import Lidar, Mount

HULL = np.array(((-0.4, -0.3), (0.4, -0.3), (0.4, 0.3), (-0.4, 0.3)))


def lidar(x, y, yaw, first, last, n=361, roll=0.0):
    step = np.radians(last - first) / (n - 1)
    mount = Mount((x, y, 0.2), (roll, 0.0, np.radians(yaw)))
    return Lidar(mount, hz=10, beams=n, angle_min=float(np.radians(first)), angle_increment=float(step), range_min=0.05, range_max=10.0)


def seen_by(*lidars, hidden=None):
    met = [np.zeros(each.beams, dtype=bool) if hidden is None else hidden for each in lidars]
    return [tuple(np.degrees(side)) for side in blind_sides(HULL, list(zip(lidars, met, strict=True)))]


def test_all_round():
    assert seen_by(lidar(0.0, 0.0, 0.0, -180.0, 179.0, 360)) == []


@pytest.mark.parametrize(("yaw", "roll"), [(0.0, 0.0), (0.0, np.pi)], ids=["upright", "upside down"])
def test_half_round_is_blind_behind(yaw, roll):
    ((first, last),) = seen_by(lidar(0.0, 0.0, yaw, -90.0, 90.0, roll=roll))
    assert (first, last) == pytest.approx((92.0, 268.0), abs=2.1)


def test_turned_to_the_left_it_is_blind_on_the_right():
    ((first, last),) = seen_by(lidar(0.0, 0.0, 90.0, -90.0, 90.0))
    assert (first, last) == pytest.approx((182.0, 358.0), abs=2.1)


def test_two_at_opposite_corners_see_all_about_it_with_270_degrees_and_not_with_170():
    wide = [lidar(x, y, yaw, -135.0, 135.0) for x, y, yaw in ((0.4, 0.3, 45.0), (-0.4, -0.3, -135.0))]
    narrow = [lidar(x, y, yaw, -85.0, 85.0) for x, y, yaw in ((0.4, 0.3, 45.0), (-0.4, -0.3, -135.0))]
    assert seen_by(*wide) == []
    first, second = seen_by(*narrow)
    assert 40.0 < first[0] < 143.0 < first[1] < 200.0
    assert 220.0 < second[0] < 323.0 and second[1] < 20.0


def test_a_mast_before_the_beams_is_a_blind_side_and_a_thin_one_is_not():
    all_round = lidar(0.0, 0.0, 0.0, -180.0, 179.0, 360)
    thick, thin = (np.isin(np.arange(360), np.arange(180 - half, 181 + half)) for half in (15, 3))
    ((first, last),) = seen_by(all_round, hidden=thick)
    assert (first, last) == pytest.approx((346.0, 14.0), abs=2.1)
    assert seen_by(all_round, hidden=thin) == []


def test_what_is_nearer_than_it_measures_is_not_seen():
    far = lidar(0.3, 0.0, 0.0, -180.0, 179.0, 360)
    assert seen_by(far) == []
    ((first, last),) = seen_by(Lidar(**{f: getattr(far, f) for f in far.__struct_fields__} | {"range_min": 0.6}))
    assert first > 180.0 > last
