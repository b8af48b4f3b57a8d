"""Everything that a report needs of a run, read from its logs in one go."""

import contextlib
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from launch.reports.history import History
from launch.reports.traffic import Traffic
from launch.scoring.last_words import LastWords
from launch.scoring.scores import FAILED, PASSED, Scorer, Verdict
from schemas import topics
from schemas.messages import Event, Tasks, TaskStatus
from schemas.topics import SYSTEM
from uvf.models.names import VEHICLE
from uvf.models.scenario import Scenario
from uvf.models.yaml_data import BadInput
from uvf.runtime.bus.interface import Sample
from uvf.runtime.bus.wire import Malformed, decode_sample
from uvf.runtime.contract.bulkhead import GIVEN_UP, STARTED_AFRESH
from uvf.runtime.log.folder import logs_of
from uvf.runtime.log.reading import log_metadata
from uvf.runtime.log.replay import logged_site
from uvf.runtime.log.run_samples import run_samples
from uvf.runtime.messages.step_times import NS
from uvf.runtime.messages.topic_lookup import topic_of

ENDING = 1.0  # s before the mission's duration, within which a run is over


@dataclass(frozen=True)
class ReportedEvent:
    """An event: when [s, simulation], whose ('system' or a vehicle), and the event."""

    t: float
    owner: str
    event: Event


@dataclass
class RecordedRun:
    """What was recorded of one run."""

    path: Path
    site: Scenario | None
    """None where no mission that could be read is attached to the log."""
    note: str = ""
    """Why there is no site."""
    metadata: dict[str, str] = field(default_factory=dict)
    vehicles: dict[str, History] = field(default_factory=dict)
    events: list[ReportedEvent] = field(default_factory=list)
    tasks: list[TaskStatus] = field(default_factory=list)
    """At the end, each before its parts."""
    begun: dict[int, float] = field(default_factory=dict)
    """When [s] each of them began to run, by its place in ``tasks``."""
    traffic: Traffic = field(default_factory=Traffic)
    told: LastWords = field(default_factory=LastWords)
    verdicts: list[Verdict] = field(default_factory=list)
    tasks_ended: bool = False
    end: float = 0.0  # s

    @property
    def failures(self) -> list[str]:
        """What was told of services that have failed, whose figures say nothing."""
        return [each.event.text for each in self.events if STARTED_AFRESH in each.event.text or GIVEN_UP in each.event.text]

    @property
    def stopped_at(self) -> str:
        """When it was stopped before its end; empty where it was not."""
        if self.site is None or self.tasks_ended or self.end >= self.site.mission.duration - ENDING:
            return ""
        return f"stopped at {self.end:.1f} s of {self.site.mission.duration:g} s"

    @property
    def verdict(self) -> str:
        """``passed`` where every criterion holds and no service has failed, so far where it was stopped; empty without criteria."""
        if self.failures or not all(verdict.passed for verdict in self.verdicts):
            return FAILED
        return "" if not self.verdicts else f"{PASSED} so far" if self.stopped_at else PASSED

    @property
    def title(self) -> str:
        """The mission's name, or the log's."""
        return self.site.mission_path.stem if self.site is not None else self.path.stem

    def take(self, sample: Sample, scorer: Scorer | None) -> None:
        """Stores a message. Raises Malformed."""
        self.traffic.heard(sample)
        self.end = max(self.end, sample.stamp_ns / NS)
        _, owner, name = [*sample.key.split("/", 2), "", ""][:3]
        if topic_of(sample.key) is None or not re.fullmatch(VEHICLE, owner):
            return
        if owner != SYSTEM:
            history = self.vehicles.get(owner) or History(owner)
            history.heard(name, sample)
            self.vehicles[owner] = history
            if name in _TOLD or name.startswith("state/events/"):
                self.told.heard(sample)
        elif sample.key == topics.TASKS.at(SYSTEM):
            self.tasks = list(decode_sample(sample, Tasks).tasks)
            for i, task in enumerate(self.tasks):
                if task.state == TaskStatus.RUNNING:
                    self.begun.setdefault(i, task.since)
        if name.startswith("state/events/"):
            event = ReportedEvent(sample.stamp_ns / NS, "system" if owner == SYSTEM else owner, decode_sample(sample, Event))
            self.events.append(event)
        if scorer is not None:
            scorer.heard(sample)


_TOLD = ("nav/status", "state/vehicle")


@contextlib.contextmanager
def recorded_run(path: Path) -> Iterator[RecordedRun]:
    """A run, read from the log or the folder of its logs; its mission's files exist as long as the context. Raises BadInput."""
    log = logs_of(path)[0]
    with contextlib.ExitStack() as stack:
        run = RecordedRun(path, None)
        try:
            run.site = stack.enter_context(logged_site(log))
        except BadInput as error:
            run.note = str(error)
        scorer = Scorer(run.site) if run.site is not None else None
        for sample in run_samples(path):
            # What is broken or of another type was refused by every service, too.
            with contextlib.suppress(Malformed):
                run.take(sample, scorer)
        with contextlib.suppress(BadInput):  # of a log that was cut off
            run.metadata = log_metadata(log)
        run.vehicles = dict(sorted(run.vehicles.items()))
        if scorer is not None:
            run.verdicts, run.tasks_ended = scorer.judge(), scorer.tasks.ended is not None
        yield run
