"""Measures of tasks: whether and when each was done."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from math import inf

from launch.scoring.finding import Finding
from schemas.messages import Tasks, TaskStatus
from uvf.models.mission.tasks import COMPOSITES
from uvf.runtime.messages.enum_names import enum_name


@dataclass
class RecordedTask:
    """What a run recorded about one task; times [s, simulation]."""

    begun: float | None = None
    ended: float | None = None
    state: int = TaskStatus.WAITING
    reason: str = ""

    def heard(self, told: TaskStatus) -> None:
        """Stores what is told of the task."""
        if told.state == TaskStatus.RUNNING and self.begun is None:
            self.begun = told.since
        if told.state in (TaskStatus.DONE, TaskStatus.FAILED, TaskStatus.STOPPED) and told.state != self.state:
            self.begun = told.since if self.begun is None else self.begun
            self.ended = told.since
        self.state, self.reason = told.state, told.reason


@dataclass
class RecordedTasks:
    """All tasks of a run that have names of their own."""

    tasks: dict[str, RecordedTask]
    state: int = TaskStatus.RUNNING
    """Of all together."""
    ended: float | None = None
    last: Sequence[TaskStatus] = ()
    """What was told of each of them at last, each before its parts."""

    def heard(self, t: float, message: Tasks) -> None:
        """Stores what is told at ``t`` [s]."""
        self.last = message.tasks
        for told in message.tasks:
            if told.name in self.tasks:
                self.tasks[told.name].heard(told)
        if message.state != TaskStatus.RUNNING and self.ended is None:
            self.state, self.ended = message.state, t

    @property
    def undone(self) -> Iterator[str]:
        """Of each single task that was not done, a line that says why not."""
        for told in self.last if self.state != TaskStatus.DONE else ():
            if told.kind not in COMPOSITES and told.state in (TaskStatus.WAITING, TaskStatus.RUNNING, TaskStatus.FAILED):
                state = "not begun" if told.state == TaskStatus.WAITING else enum_name(TaskStatus.State, told.state)
                yield f"task {told.name}: {state}" + (f": {told.reason}" if told.reason else "")


def done(task: RecordedTask) -> Finding:
    """Whether the task was done [0 or 1].

    Counts at the end of the run.
    """
    return Finding(float(task.state == TaskStatus.DONE), task.ended, note=_note(task))


def time_taken(task: RecordedTask) -> Finding:
    """Time from when the task began until it was done [s].

    Counts over the whole run. Infinite when it was not done.
    """
    if task.state != TaskStatus.DONE or task.begun is None or task.ended is None:
        return Finding(inf, task.ended, note=_note(task))
    return Finding(task.ended - task.begun, task.ended)


def _note(task: RecordedTask) -> str:
    if task.state == TaskStatus.DONE:
        return ""
    if task.begun is None:
        return f"not begun: {task.reason}" if task.reason else "not begun"
    return task.reason or TaskStatus.State.Name(task.state).lower()


TASK_MEASURES: dict[str, Callable[[RecordedTask], Finding]] = {f.__name__: f for f in (done, time_taken)}
