"""The beams of a scan by the moments at which they were measured."""

import numpy as np
import pytest

from uvf.sensors.sweeping import AT_ONCE, SPACING, Sweeping


def measured_at(sweeping, n=361):
    """Of each beam, by its part."""
    found = {}
    for part in sweeping.parts(n, 3.0):
        found |= dict.fromkeys(range(n)[part.beams], part.at)
    return [found[k] for k in range(n)]


def test_beams_taken_at_once_are_of_the_stamp():
    assert AT_ONCE.parts(361, 3.0) == [(3.0, slice(0, 361))]
    assert AT_ONCE.end(3.0) == 3.0


def test_every_beam_is_of_a_moment_near_its_own():
    times = measured_at(Sweeping(0.2))
    assert times == pytest.approx([3.0 + 0.2 * k / 360 for k in range(361)], abs=0.55 * SPACING)
    assert Sweeping(0.2).end(3.0) == pytest.approx(3.2)


def test_clockwise_the_last_beam_is_the_first_to_be_measured():
    times = measured_at(Sweeping(0.2, clockwise=True))
    assert times == pytest.approx([3.2 - 0.2 * k / 360 for k in range(361)], abs=0.55 * SPACING)
    assert Sweeping(0.2, clockwise=True).in_order(np.arange(4.0)).tolist() == [3.0, 2.0, 1.0, 0.0]
    assert Sweeping(0.2).in_order(np.arange(4.0)).tolist() == [0.0, 1.0, 2.0, 3.0]


@pytest.mark.parametrize("clockwise", [False, True])
@pytest.mark.parametrize("n", [0, 1, 2, 3])
def test_a_few_beams_have_few_parts(n, clockwise):
    parts = Sweeping(1.0, clockwise).parts(n, 3.0)
    assert len(parts) == max(n, 1)
    assert len(measured_at(Sweeping(1.0, clockwise), n)) == n
    assert all(3.0 <= part.at <= 4.0 for part in parts)
