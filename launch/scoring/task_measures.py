"""Measures of tasks: whether and when each was done."""

from collections.abc import Callable
from dataclasses import dataclass
from math import inf

from launch.scoring.finding import Finding
from schemas.messages import Tasks, TaskStatus


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

    def heard(self, t: float, message: Tasks) -> None:
        """Stores what is told at ``t`` [s]."""
        for told in message.tasks:
            if told.name in self.tasks:
                self.tasks[told.name].heard(told)
        if message.state != TaskStatus.RUNNING and self.ended is None:
            self.state, self.ended = message.state, t


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
    return "not begun" if task.begun is None else task.reason or TaskStatus.State.Name(task.state).lower()


TASK_MEASURES: dict[str, Callable[[RecordedTask], Finding]] = {f.__name__: f for f in (done, time_taken)}
