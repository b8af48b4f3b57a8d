"""The executive of a mission: does its tasks in order, by asking the vehicles for what they are to do."""

from collections.abc import Mapping, Sequence

from py_trees.common import Status

from schemas import topics
from schemas.messages import Event, Tasks, TaskStatus
from services.executive import interface
from services.executive.actions.joystick import DriveTrack
from services.executive.interface import SOURCE
from services.executive.planting import Planter
from services.executive.situation import TeamSituation
from services.executive.tree import STATES
from uvf.models.mission.fixtures import ChargerFile
from uvf.models.mission.tasks import Task
from uvf.models.scenario import MissionVehicle
from uvf.runtime.contract.declaration import Reads, topic
from uvf.runtime.contract.service import Service
from uvf.runtime.messages.convert import stamp

TOLD_EVERY = 10
"""Steps between two messages while nothing begins or ends: 1 s."""
SEVERITY = {TaskStatus.FAILED: Event.WARNING}
WORDS = {TaskStatus.RUNNING: "begins", TaskStatus.DONE: "is done", TaskStatus.FAILED: "has failed", TaskStatus.STOPPED: "is stopped"}


class Executive(Service):
    """One for the mission. It commands nobody: an operator's mode or goal is accepted by the vehicle as ever, and the task fails by it."""

    name = "executive"
    hz = 10.0
    scope = "world"
    given_up = "vehicles go on with what they were told last"

    Inputs = interface.Inputs
    Outputs = interface.Outputs

    class Recalls(Reads):
        """What an instance before this one has told."""

        tasks: Tasks | None = topic(topics.TASKS)

    def __init__(
        self,
        tasks: Sequence[Task],
        members: Mapping[str, MissionVehicle],
        roles: Mapping[str, list[str]],
        tracks: Mapping[str, DriveTrack],
        chargers: Sequence[ChargerFile] = (),
    ) -> None:
        """tracks: recorded drives by their paths in the mission file."""
        self._now = TeamSituation(members, roles)
        planter = Planter(self._now, tracks, chargers)
        self._tree = planter.tree(tasks)
        self._records, self._nodes = planter.records, planter.nodes
        self._told: list[TaskStatus.State] = [TaskStatus.WAITING] * len(self._records)
        self._state: TaskStatus.State = TaskStatus.RUNNING
        self._steps = 0

    def step(self, t: float, now: interface.Inputs) -> interface.Outputs:
        """One cycle at ``t`` [s, simulation]: answers, the tree, and what is to be asked."""
        situation = self._now
        situation.begin(t, now)
        situation.desk.hear(t, {name: getattr(now, name) for name in self.calls})
        if self._state == TaskStatus.RUNNING:
            self._tree.tick_once()
            self._state = STATES.get(self._tree.status, TaskStatus.RUNNING)
        out = self.Outputs(drive=situation.drive or None, shared=situation.shared or None, events=self._events(t))
        if out.events or self._steps % TOLD_EVERY == 0:
            out.tasks = Tasks(timestamp=stamp(t), state=self._state, tasks=self._records)
        self._steps += 1
        out.update(situation.desk.due(t))
        return out

    def recall(self, left: Recalls) -> None:
        """Goes on behind the tasks that were over; one that was under way begins anew."""
        if left.tasks is None or [each.name for each in left.tasks.tasks] != [each.name for each in self._records]:
            return
        ended = {state: status for status, state in STATES.items() if status != Status.RUNNING}
        for k, (node, was) in enumerate(zip(self._nodes, left.tasks.tasks, strict=True)):
            if was.state in ended:
                self._records[k].CopyFrom(was)
                self._told[k] = was.state
                node.recall(ended[was.state])

    def close(self) -> None:
        """Lets go of the tree."""
        self._tree.stop(Status.INVALID)

    def _events(self, t: float) -> list[Event]:
        """One for each task that has begun or ended since the step before."""
        events = []
        for k, record in enumerate(self._records):
            if record.state != self._told[k]:
                self._told[k] = record.state
                if record.state in WORDS:
                    events.append(self._event(t, record))
        return events

    def _event(self, t: float, record: TaskStatus) -> Event:
        failed = record.state == TaskStatus.FAILED
        return Event(
            timestamp=stamp(t),
            severity=Event.WARNING if failed else Event.NOTICE,
            text=f"task {record.name} {WORDS[record.state]}",
            cause=record.reason if failed else "",
            source=SOURCE,
        )
