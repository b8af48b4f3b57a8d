"""Curves with fewer points keep their spikes and their breaks; ticks are round."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from uvf.maths.decimation import min_max, round_ticks


def test_a_spike_of_one_sample_survives():
    t = np.arange(60_000) * 0.01
    values = np.sin(t)
    values[31_234] = 9.0
    seen_t, seen = min_max(t, values, 600)
    assert len(seen) <= 602 and seen.max() == 9.0 and seen_t[seen.argmax()] == t[31_234]
    assert seen.min() == pytest.approx(-1.0, abs=1e-3) and (np.diff(seen_t) > 0).all()


def test_a_break_stays_a_break():
    values = np.ones(1000)
    values[500] = np.nan
    assert np.isnan(min_max(np.arange(1000.0), values, 50)[1]).sum() == 1


def test_few_points_stay_as_they_are():
    t = np.arange(5.0)
    assert min_max(t, t, 10)[0] is t


@given(st.floats(-1e6, 1e6), st.floats(1e-3, 1e6), st.integers(3, 8))
def test_ticks_are_round_within_and_few(low, span, most):
    ticks = round_ticks(low, low + span, most)
    assert len(ticks) <= most + 1
    assert all(low - span * 1e-6 <= tick <= low + span * (1 + 1e-6) for tick in ticks)


def test_ticks_of_a_common_range():
    assert round_ticks(0.0, 100.0, 5) == [0.0, 20.0, 40.0, 60.0, 80.0, 100.0]
    assert round_ticks(3.0, 3.0, 5) == [3.0]
