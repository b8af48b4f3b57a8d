"""``uvf run MISSION``: the whole mission in one process, as fast as it goes, scored at the end."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from launch import catalogue
from launch.attachments import attachments
from launch.checks import refuse_problems
from launch.scoring.last_words import LastWords
from launch.scoring.scores import Scorer, Verdict
from schemas.messages import TaskStatus
from uvf.models.scenario import Scenario
from uvf.runtime.log.recording import Recorder
from uvf.runtime.log.versions import versions
from uvf.runtime.time.lockstep import Lockstep

AFTERWARDS = 1.0  # s after the last task, in which vehicles come to rest


@dataclass(frozen=True)
class Result:
    """What a lockstep run yields: verdicts, log hash, times and failures."""

    verdicts: list[Verdict]
    log_hash: str
    simulated: float  # s
    wall: float  # s, without building the services
    messages: int
    recording_error: str
    failures: list[str]
    """Instances that have failed: what was measured of them says nothing."""
    told: LastWords
    """What the vehicles said of themselves."""
    tasks_done: bool
    undone: list[str]
    """A line for each task that was not done."""

    @property
    def factor(self) -> float:
        """Real-time factor [-]: simulated over wall time."""
        return self.simulated / self.wall

    @property
    def passed(self) -> bool:
        """Whether every criterion holds, or, without any, all tasks are done; and no instance has failed."""
        return not self.failures and (all(v.passed for v in self.verdicts) if self.verdicts else self.tasks_done)


def run_lockstep(
    site: Scenario,
    until: float,
    log: Path,
    watch: Callable[[float], bool] = lambda t: True,
    warn: Callable[[str], None] = lambda line: None,
    afterwards: float = AFTERWARDS,
) -> Result:
    """Runs every sim-clock service of the mission up to ``until`` [s], or ``afterwards`` [s] beyond the end of its tasks, and records it.

    Raises BadInput.
    """
    scorer, told = Scorer(site), LastWords()
    hosts = catalogue.hosts(site, [k for k in catalogue.needed(site) if k.clock == "sim"])
    refuse_problems(site, hosts)
    reached = 0.0

    def goes_on(t: float) -> bool:
        nonlocal reached
        reached = t
        return scorer.tasks.ended is None or t < scorer.tasks.ended + afterwards

    with Recorder(log, attachments(site), made_with=versions()) as recorder:
        lockstep = Lockstep(hosts, warn=warn, contains=True)
        try:
            recorder.follow(lockstep.bus)
            scorer.follow(lockstep.bus)
            told.follow(lockstep.bus)
            begun = time.perf_counter()
            lockstep.run(until, lambda t: watch(t) and goes_on(t))
            wall = time.perf_counter() - begun
        finally:
            lockstep.close()
    return Result(
        scorer.judge(),
        recorder.hash.hexdigest(),
        min(reached, until),
        wall,
        recorder.written,
        recorder.error,
        lockstep.failures(),
        told,
        not site.mission.tasks or scorer.tasks.state == TaskStatus.DONE,
        list(scorer.tasks.undone),
    )
