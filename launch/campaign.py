"""A mission run with several seeds: how often it succeeds, and how far its figures spread."""

import os
import shutil
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path

from scipy.stats import binomtest

from launch.changed_mission import changed_mission
from launch.run import run_lockstep
from launch.scoring.scores import Verdict
from uvf.models.scenario import load_scenario
from uvf.runtime.log.folder import log_name

CONFIDENCE = 0.95


@dataclass(frozen=True)
class SeedRun:
    """One run of a campaign. log: kept where it did not pass."""

    seed: int
    passed: bool
    verdicts: list[Verdict]
    failures: list[str]
    undone: list[str]
    """A line for each task that was not done."""
    simulated: float  # s
    wall: float  # s
    log_hash: str
    log: Path | None

    @property
    def complaints(self) -> Iterator[str]:
        """Why it has not passed, a line each."""
        for verdict in self.verdicts:
            if not verdict.passed:
                what = f"{verdict.subject} {verdict.criterion.measure} {verdict.found.value:.3g}"
                yield f"seed {self.seed}: {what}; {verdict.found.circumstances or 'at the end'}; log {self.log}"
        yield from (f"seed {self.seed}: {line}; log {self.log}" for line in (*self.failures, *([] if self.passed else self.undone)))


def run_seeds(mission: Path, count: int, until: float | None, folder: Path) -> Iterator[SeedRun]:
    """Runs a mission ``count`` times, with its seed and those after it, on all processors; yields the runs as they end. Raises BadInput.

    until [s]: instead of the mission's duration; folder: for the logs.
    """
    first = load_scenario(mission).mission.seed
    with ProcessPoolExecutor(max_workers=min(count, os.cpu_count() or 1), mp_context=get_context("spawn")) as pool:
        jobs = [pool.submit(run_seed, mission, seed, until, folder / f"seed-{seed}") for seed in range(first, first + count)]
        for job in as_completed(jobs):
            yield job.result()


def run_seed(mission: Path, seed: int, until: float | None, folder: Path) -> SeedRun:
    """Runs a mission with another seed; ``folder``: of the changed mission and the log, removed when it passes. Raises BadInput."""
    site = load_scenario(changed_mission(mission, [f"seed={seed}"], folder))
    log = folder / log_name(0)
    result = run_lockstep(site, until if until is not None else site.mission.duration, log)
    if result.passed:
        shutil.rmtree(folder)
    kept = None if result.passed else log
    return SeedRun(
        seed, result.passed, result.verdicts, result.failures, result.undone, result.simulated, result.wall, result.log_hash, kept
    )


def success_interval(passed: int, count: int) -> tuple[float, float]:
    """The 95 % interval of the success rate (E. B. Wilson, Probable inference, the law of succession, and statistical inference, 1927)."""
    interval = binomtest(passed, count).proportion_ci(CONFIDENCE, method="wilson")
    return float(interval.low), float(interval.high)
