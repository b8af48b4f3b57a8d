"""Readings are taken at their rate, lost as told, and arrive late, in order, on the grid of the steps."""

from itertools import groupby

import numpy as np
import pytest

from uvf.sensors.sampling import DelayLine, Dropout, Due

STEPS = 100.0


def times(seconds, first=1):
    return [n / STEPS for n in range(first, round(seconds * STEPS) + 1)]


def arrivals(line, seconds):
    """(arrival, taken) of each reading; a reading is the time at which it was taken."""
    return [(t, taken) for t in times(seconds) if (taken := line.step(t, lambda t=t: t)) is not None]


@pytest.mark.parametrize("hz", [1.0, 3.0, 5.0, 7.0, 12.5, 30.0, 40.0, 99.0, 100.0])
def test_any_rate_up_to_that_of_the_steps_is_kept_for_an_hour(hz):
    due = Due(hz)
    assert sum(due.at(t) for t in times(3600.0)) == round(3600 * hz)


def test_a_rate_that_does_not_divide_takes_the_first_step_from_the_due_time_on():
    due = Due(40.0)
    assert [t for t in times(0.2) if due.at(t)] == [0.03, 0.05, 0.08, 0.1, 0.13, 0.15, 0.18, 0.2]


def test_who_joins_late_does_not_make_up_for_what_was_due_before():
    due = Due(10.0)
    assert [t for t in times(50.35, first=5001) if due.at(t)] == [50.01, 50.1, 50.2, 50.3]


def test_a_skipped_step_delays_a_reading_but_does_not_lose_it():
    due = Due(10.0)
    assert [t for t in (0.08, 0.09, 0.11, 0.12, 0.2) if due.at(t)] == [0.11, 0.2]


def test_without_latency_a_reading_arrives_at_once():
    assert arrivals(DelayLine(10.0), 1.0) == [(k / 10, k / 10) for k in range(1, 11)]


@pytest.mark.parametrize(("latency", "late"), [(0.01, 1), (0.035, 4), (0.25, 25)])
def test_readings_arrive_in_order_at_the_first_step_after_their_latency(latency, late):
    came = arrivals(DelayLine(40.0, latency), 5.0)
    assert [round((arrival - taken) * STEPS) for arrival, taken in came] == [late] * len(came)
    assert [taken for _, taken in came] == [taken for _, taken in arrivals(DelayLine(40.0), 5.0)][: len(came)]


@pytest.mark.parametrize(("probability", "burst"), [(0.1, 1), (0.05, 4), (0.5, 3), (1.0, 1), (0.0, 5)])
def test_the_lost_share_is_the_stated_one(probability, burst):
    dropout = Dropout(probability, burst, np.random.default_rng(3))
    share = np.mean([dropout.lost() for _ in range(40_000)])
    assert share == pytest.approx(probability * burst / (probability * burst + 1 - probability), abs=0.01)


def test_bursts_last_as_told():
    dropout = Dropout(0.01, 7, np.random.default_rng(3))
    runs = [len(list(run)) for lost, run in groupby(dropout.lost() for _ in range(20_000)) if lost]
    assert len(runs) > 50
    assert all(length % 7 == 0 for length in runs[:-1])


def test_what_is_lost_does_not_change_what_arrives():
    def noisy(dropout):
        line, rng = DelayLine(50.0, 0.02, dropout), np.random.default_rng(1)
        return [r for t in times(4.0) if (r := line.step(t, lambda t=t: (t, rng.standard_normal()))) is not None]

    whole, some = noisy(None), noisy(Dropout(0.3, 2, np.random.default_rng(2)))
    assert 0 < len(some) < len(whole)
    assert set(some) < set(whole)
