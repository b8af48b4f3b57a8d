"""A burger on the slopes of the world hills."""

import numpy as np

from schemas import topics
from tests.services.sim_ground.ride import ride, site_with
from uvf.maths.kinematics import Twist
from uvf.models.world.terrain import relief_of

UP_THE_SLOPE = (20.0, -23.5, np.pi / 2)  # towards the strip, which lies 10 m high


def test_it_drives_up_a_slope_on_the_terrain_and_touches_nothing(tmp_path):
    site = site_with(tmp_path, {"burger": UP_THE_SLOPE}, world="hills")
    record = ride(site, 20.0, {"burger": lambda t: Twist(0.2, 0.0)})
    x, y, z = np.array([(s.position.x, s.position.y, s.position.z) for s in record.of(topics.TRUTH)]).T
    heights, slopes = relief_of(site.world.terrain).at(x, y)
    assert y[-1] - y[0] > 3.0
    assert z[-1] - z[0] > 0.15
    assert np.abs(z[20:] - heights[20:]).max() < 0.02
    assert np.degrees(np.arctan(slopes.max())) > 4.0
    assert record.tilts()[50:].max() < 0.15
    assert not any(c.touching for c in record.of(topics.CONTACT))


def test_its_lidar_sees_the_hillside_that_it_looks_at(tmp_path):
    site = site_with(tmp_path, {"burger": (30.0, -45.0, -np.pi / 2)}, world="hills")
    record = ride(site, 1.0, {"burger": lambda t: None})
    ranges = np.array(record.of(topics.SCAN)[-1].ranges)
    assert ranges[ranges > 0].size > 20
