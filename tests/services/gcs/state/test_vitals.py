"""A process's load, lateness and silence follow from its reports."""

import pytest

from schemas.messages import Health
from services.gcs.state.vitals import OVER, SILENT_AFTER, Vitals


def heard(*reports):
    vitals = Vitals()
    for t, report in reports:
        vitals.hear(t, report)
    return vitals


def test_load_is_processor_time_by_wall_time_over_the_last_seconds():
    busy_then_idle = [(0.5 * i, Health(pid=1, cpu_time=min(0.5 * i, 10.0))) for i in range(2 * 20)]
    assert heard(*busy_then_idle[:21]).load == pytest.approx(1.0)
    assert heard(*busy_then_idle).load == pytest.approx(0.0)
    assert heard(*busy_then_idle[: 20 + round(OVER)]).load == pytest.approx(0.6, abs=0.01)


def test_one_report_makes_no_load_and_a_new_process_counts_from_zero():
    assert heard((0.0, Health(pid=1, cpu_time=50.0))).load is None
    assert heard((0.0, Health(pid=1, cpu_time=50.0)), (2.0, Health(pid=2, cpu_time=0.5))).load is None


def test_late_steps_are_a_share_of_all_and_gaps_a_sum_over_keys():
    vitals = heard((0.0, Health(steps=200, late=3, gaps={"a": 2, "b": 5})))
    assert (vitals.late, vitals.gaps) == (0.015, 7)
    assert heard((0.0, Health())).late == 0.0


def test_silence_counts_only_when_it_is_not_normal():
    vitals = heard((10.0, Health()))
    assert vitals.silence(10.0 + SILENT_AFTER) == 0.0
    assert vitals.silence(14.0) == 4.0
