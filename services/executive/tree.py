"""The behaviour tree of a mission: py_trees' composites, and nodes that begin, end and fail as tasks say.

py_trees by D. Stonier et al.; behaviour trees: Colledanchise & Ögren 2018.
"""

from collections.abc import Iterator

from py_trees.behaviour import Behaviour
from py_trees.behaviours import Success
from py_trees.common import ParallelPolicy, Status
from py_trees.composites import Composite, Parallel, Selector, Sequence
from py_trees.decorators import Decorator

from schemas.messages import TaskStatus
from services.executive.actions.action import Failed, TaskAction
from services.executive.conditions import unfulfilled
from services.executive.situation import TeamSituation
from uvf.models.mission.tasks import Task

STATES = {Status.RUNNING: TaskStatus.RUNNING, Status.SUCCESS: TaskStatus.DONE, Status.FAILURE: TaskStatus.FAILED}


class ActionNode(Behaviour):
    """A leaf: an action of a vehicle."""

    def __init__(self, action: TaskAction, now: TeamSituation) -> None:
        super().__init__(type(action).__name__)
        self._action, self._now = action, now

    def initialise(self) -> None:
        """Begins the action."""
        self._action.begin(self._now)

    @property
    def refusal(self) -> str:
        """Why what it asks for has been refused until now; empty where it has not, or is over."""
        return self._action.refusal if self.status == Status.RUNNING else ""

    def update(self) -> Status:
        """One step of the action."""
        try:
            done = self._action.step(self._now)
        except Failed as error:
            self.feedback_message = str(error)
            self._action.stop(self._now)
            return Status.FAILURE
        self.feedback_message = self._action.reason
        return Status.SUCCESS if done else Status.RUNNING

    def terminate(self, new_status: Status) -> None:
        """Stops an action that is needed no more."""
        if new_status == Status.INVALID and self.status == Status.RUNNING:
            self._action.stop(self._now)


class TaskNode(Decorator):
    """A task: waits for ``when``, ends with ``until``, fails after ``within``, repeats, and keeps the record of it."""

    def __init__(self, task: Task, child: Behaviour, record: TaskStatus, now: TeamSituation) -> None:
        super().__init__(record.name, child)
        self._task, self._record, self._now = task, record, now
        self._turn = self._begun = 0.0
        self._waits = True
        self._rounds = 0
        self._was: Status | None = None

    def recall(self, status: Status) -> None:
        """It has ended so already, before this instance was made: its next turn is over at once."""
        self._was = status

    def initialise(self) -> None:
        """The turn of the task has come."""
        self._turn, self._waits, self._rounds = self._now.t, True, 0

    def tick(self) -> Iterator[Behaviour]:
        """One step."""
        if self._was is not None:
            was, self._was = self._was, None
            self._tell(was, self._record.reason)
            yield self
            return
        if self.status != Status.RUNNING:
            self.initialise()
        if self._waits and self._task.when is not None:
            missing = unfulfilled(self._task.when, self._now, self._turn)
            if missing:
                self._tell(Status.RUNNING, f"waits until {missing}")
                yield self
                return
        if self._waits:
            self._waits, self._begun = False, self._now.t
        if self._task.until is not None and not unfulfilled(self._task.until, self._now, self._begun):
            self._end_by_until()
        else:
            yield from self.decorated.tick()
            self._judge()
        yield self

    def _judge(self) -> None:
        status, why = self.decorated.status, _feedback(self.decorated)
        late = self._task.within is not None and self._now.t - self._begun >= self._task.within
        if status == Status.SUCCESS and self._rounds + 1 < self._task.repeat:
            self._rounds, status = self._rounds + 1, Status.RUNNING
        if status == Status.RUNNING and late:
            self._end(Status.FAILURE, f"not done within {self._task.within:g} s: {why}")
        elif status == Status.RUNNING:
            self._tell(status, why)
        else:
            self._end(status, why)

    def _end_by_until(self) -> None:
        """It is done, unless a vehicle has refused it all the time."""
        leaves = (node for node in self.decorated.iterate() if isinstance(node, ActionNode))
        refusal = next((leaf.refusal for leaf in leaves if leaf.refusal), "")
        self._end(Status.FAILURE if refusal else Status.SUCCESS, refusal)

    def _end(self, status: Status, why: str) -> None:
        if self.decorated.status == Status.RUNNING:
            self.decorated.stop(Status.INVALID)
        self._tell(status, why)

    def _tell(self, status: Status, why: str) -> None:
        self.status, self.feedback_message = status, why
        state = STATES[status]
        if state == TaskStatus.RUNNING and self._waits:
            state = TaskStatus.WAITING
        if self._record.state != state:
            self._record.state, self._record.since = state, self._now.t
        self._record.reason = "" if status == Status.SUCCESS else why  # what it asked for last says nothing any more

    def stop(self, new_status: Status) -> None:
        """The task is needed no more, or begins anew."""
        if new_status == Status.INVALID and self.status == Status.RUNNING:
            self.decorated.stop(Status.INVALID)
            self._record.state, self._record.since, self._record.reason = TaskStatus.STOPPED, self._now.t, ""
        self.status = new_status

    def update(self) -> Status:
        """As its last step has left it."""
        return self.status


def composite(kind: str, name: str, children: list[Behaviour]) -> Composite:
    """A node of several: ``sequence``, ``parallel`` or ``fallback``."""
    if kind == "parallel":
        return Parallel(name, ParallelPolicy.SuccessOnAll(synchronise=True), children)
    return (Sequence if kind == "sequence" else Selector)(name, True, children)


def nothing(name: str) -> Behaviour:
    """A leaf that has nothing to do."""
    return Success(name)


def _feedback(node: Behaviour) -> str:
    """The first words of those who run or have failed, deepest first."""
    if isinstance(node, TaskNode) or not node.children:
        return str(node.feedback_message)
    wanted = node.status if node.status != Status.SUCCESS else None
    told = (_feedback(child) for child in node.children if child.status == wanted)
    return next((text for text in told if text), "")
