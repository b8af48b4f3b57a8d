"""When an aircraft has touched the ground, by its true track."""

import numpy as np
import pytest

from launch.scoring.touchdown import sink, touchdown

DT = 0.02


def landing(*parts, stands=2.0):
    """(n, 4) of a track with parts (s, sink m/s), 20 m/s forward, that stands at its end."""
    climbs = np.concatenate([np.full(round(seconds / DT), -rate) for seconds, rate in parts])
    still = round(stands / DT)
    height = np.concatenate([np.cumsum(climbs) * DT, np.full(still, np.sum(climbs) * DT)])
    t = DT * np.arange(len(height))
    x = 20.0 * np.minimum(t, t[len(climbs) - 1])
    return np.column_stack([t, x, np.zeros(len(t)), height])


def test_it_touches_where_the_ground_takes_its_sink():
    track = landing((10.0, 2.0), (3.0, 0.6), (5.0, 0.0))
    assert track[touchdown(track), 0] == pytest.approx(13.0, abs=0.25)
    assert sink(track) == pytest.approx(0.6, abs=0.05)


def test_a_tail_dragger_that_rolls_with_its_tail_up_has_touched():
    track = landing((10.0, 2.0), (2.0, 0.5), (20.0, 0.0), (2.0, 0.1))
    assert track[touchdown(track), 0] == pytest.approx(12.0, abs=0.25)


def test_a_flare_that_eases_the_sink_is_no_touch():
    track = landing((10.0, 2.0), *((0.2, 2.0 - 0.2 * k) for k in range(5)), (1.0, 1.2), (5.0, 0.0))
    assert track[touchdown(track), 0] == pytest.approx(12.0, abs=0.25)
    assert sink(track) == pytest.approx(1.2, abs=0.1)


def test_a_touch_like_a_feather_counts_where_it_begins_to_roll():
    track = landing((10.0, 2.0), (10.0, 0.1), (10.0, 0.0))
    assert track[touchdown(track), 0] == pytest.approx(20.0, abs=0.7)


def test_what_has_not_flown_or_does_not_stand_has_not_landed():
    assert touchdown(landing((3.0, 0.5), (5.0, 0.0))) is None
    assert touchdown(landing((10.0, 2.0), stands=0.2)) is None
