"""Take-off, circuit and landing in gusty wind on every kind of landing gear, without a range finder where there is a tail wheel or none."""

from concurrent.futures import ProcessPoolExecutor

import pytest

from benchmarks.autopilot.landings import CRAFTS, HOP, Row, _bounces, fly

ALONG, FROM_THE_SIDE = 4, 5  # seeds: of wind along the strip, of wind 45 degrees aside


def _landed(case):
    name, seed = case
    return fly(CRAFTS[name], seed)[0]


@pytest.fixture(scope="module")
def flights():
    cases = [(name, seed) for name in CRAFTS for seed in (ALONG, FROM_THE_SIDE)]
    with ProcessPoolExecutor() as pool:
        return dict(zip(cases, pool.map(_landed, cases), strict=True))


@pytest.mark.parametrize("name", CRAFTS)
def test_it_takes_off_and_lands_intact_where_it_is_meant_to(flights, name):
    for seed in (ALONG, FROM_THE_SIDE):
        landed = flights[name, seed]
        assert landed.complete, landed.why
        assert abs(landed.along) < 15.0
        assert landed.sink < 1.5
        assert landed.off_middle < 6.0


def test_what_is_thrown_flies_at_once(flights):
    assert flights["stick25 without wheels, thrown", ALONG].take_off < 10.0


def test_a_bounce_is_counted_once_however_long_it_lasts():
    heights = (0.0, HOP / 2, 2 * HOP, 3 * HOP, 0.0, 2 * HOP, 0.0)
    assert _bounces([Row(0.0, (0.0, 0.0, h), h, 0.0, 15.0, 0.0, 0.0, 0.0, 0, "") for h in heights]) == 2
