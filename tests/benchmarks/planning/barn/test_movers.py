"""Moving discs: at their keys, between them, and after their period."""

import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline

from benchmarks.planning.barn.movers import NO_MOVERS, Track, movers_of

OPEN = np.array([(0.0, 0.0, 0.0), (2.0, 4.0, 1.0), (3.0, 5.0, -2.0), (7.0, 1.0, 0.5)])
CLOSED = np.array([(0.0, 1.0, 1.0), (1.0, 2.0, 1.0), (2.5, 2.0, 3.0), (4.0, 1.0, 1.0)])


@pytest.mark.parametrize("how", ["catmull-rom", "linear"])
@pytest.mark.parametrize("turns", [0, 1, 5])
def test_a_disc_is_at_its_keys_and_there_again_a_period_later(how, turns):
    movers = movers_of([Track(0.5, 8.0, OPEN), Track(0.25, 4.0, CLOSED)], how)
    for t, x, y in OPEN.tolist():
        assert movers.at(t + 8.0 * turns)[0] == pytest.approx((x, y, 0.5), abs=1e-9)
    for t, x, y in CLOSED[:-1].tolist():
        assert movers.at(t + 4.0 * turns)[1] == pytest.approx((x, y, 0.25), abs=1e-9)


def test_between_two_keys_a_linear_disc_is_on_the_line():
    movers = movers_of([Track(0.5, 8.0, OPEN)], "linear")
    for t in np.linspace(0.0, 6.99, 50):
        x, y, _ = movers.at(t)[0]
        assert (x, y) == pytest.approx([np.interp(t, OPEN[:, 0], OPEN[:, k]) for k in (1, 2)])


def test_between_two_keys_a_disc_is_on_the_spline_that_gazebo_draws():
    """Tangents by hand, per leg: half the way between the neighbours; at an open end half the way to the neighbour."""
    p = OPEN[:, 1:]
    tangents = np.array([(p[1] - p[0]) / 2, (p[2] - p[0]) / 2, (p[3] - p[1]) / 2, (p[3] - p[2]) / 2])
    spline = CubicHermiteSpline(np.arange(4.0), p, tangents)
    movers = movers_of([Track(0.5, 8.0, OPEN)])
    for t in np.linspace(0.0, 6.99, 50):
        assert movers.at(t)[0, :2] == pytest.approx(spline(np.interp(t, OPEN[:, 0], np.arange(4.0))))


def test_a_closed_spline_goes_on_without_a_corner():
    movers = movers_of([Track(0.5, 4.0, CLOSED)])
    before, at, after = movers.at(4.0 - 1.5e-4)[0, :2], movers.at(0.0)[0, :2], movers.at(1e-4)[0, :2]
    assert after - at == pytest.approx(at - before, abs=1e-7)  # legs of 1.5 s and 1 s, so this far on either side
    assert after[1] - at[1] == pytest.approx(-1e-4, rel=0.01)


def test_after_its_last_key_a_disc_waits_for_the_period():
    movers = movers_of([Track(0.5, 8.0, OPEN)])
    assert movers.at(7.5)[0] == pytest.approx((1.0, 0.5, 0.5))
    assert movers.at(-0.5)[0] == pytest.approx(movers.at(7.5)[0])


def test_no_discs_are_nowhere():
    assert NO_MOVERS.at(3.0).shape == (0, 3) and len(NO_MOVERS) == 0


@pytest.mark.parametrize(
    ("track", "fault"),
    [
        (Track(0.5, 8.0, OPEN[:1]), "two or more rows"),
        (Track(0.5, 8.0, OPEN[::-1]), "rise from 0 s"),
        (Track(0.5, 8.0, OPEN + np.array((1.0, 0.0, 0.0))), "rise from 0 s"),
        (Track(0.5, 8.0, np.where(OPEN == 4.0, np.nan, OPEN)), "finite"),
        (Track(0.0, 8.0, OPEN), "radius is 0.0"),
        (Track(0.5, 6.0, OPEN), "period is 6.0"),
        (Track(0.5, np.inf, OPEN), "period is inf"),
    ],
)
def test_what_is_no_motion_is_refused_by_its_number(track, fault):
    with pytest.raises(ValueError, match=f"obstacle 1: .*{fault}"):
        movers_of([Track(0.5, 8.0, OPEN), track])
