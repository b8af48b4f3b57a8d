"""A mission with several seeds: each run by itself, and what is told of all together."""

import pytest

from launch.campaign import run_seeds, success_interval
from launch.settings import mission_path


def test_each_seed_is_a_run_of_its_own_and_the_logs_of_those_that_failed_are_kept(tmp_path):
    runs = sorted(run_seeds(mission_path("circuit"), 2, 1.0, tmp_path), key=lambda run: run.seed)
    assert [run.seed for run in runs] == [1, 2]
    assert runs[0].log_hash != runs[1].log_hash
    assert [run.passed for run in runs] == [False, False]
    assert all(run.log == tmp_path / f"seed-{run.seed}" / "log-000.mcap" and run.log.is_file() for run in runs)
    again = next(iter(run_seeds(mission_path("circuit"), 1, 1.0, tmp_path / "again")))
    assert again.log_hash == runs[0].log_hash


@pytest.mark.parametrize(("passed", "low", "high"), [(20, 0.839, 1.0), (18, 0.699, 0.972), (0, 0.0, 0.161)])
def test_the_interval_of_the_success_rate_is_wilsons(passed, low, high):
    assert success_interval(passed, 20) == (pytest.approx(low, abs=1e-3), pytest.approx(high, abs=1e-3))
