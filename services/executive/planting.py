"""From the tasks of a mission file to its behaviour tree."""

from collections.abc import Mapping, Sequence

from py_trees.behaviour import Behaviour

from schemas.messages import Mode, TaskStatus
from services.executive.actions.action import ArmAction, ChangeModeAction, TaskAction
from services.executive.actions.charging import ChargeAction, Chargers
from services.executive.actions.driving import FlyToAction, FollowAction, GoalAction, RouteAction
from services.executive.actions.found_markers import VisitFoundAction
from services.executive.actions.joystick import DriveAction, DriveTrack
from services.executive.actions.maps import SaveMapAction, ShareMapAction
from services.executive.actions.missions import ExploreAction, MissionAction
from services.executive.actions.visiting import VisitAction
from services.executive.situation import TeamSituation
from services.executive.tree import ActionNode, TaskNode, composite, nothing
from uvf.models.mission.fixtures import ChargerFile
from uvf.models.mission.tasks import COMPOSITES, FollowTask, GoalTask, Task, parts_of, title_of, verb_of


class Planter:
    """Makes the tree of a mission, and the records of its tasks, each before its parts."""

    def __init__(self, now: TeamSituation, tracks: Mapping[str, DriveTrack], chargers: Sequence[ChargerFile]) -> None:
        """tracks: recorded drives by their paths in the mission file."""
        self._now, self._tracks = now, tracks
        self._chargers = Chargers(chargers)
        self.records: list[TaskStatus] = []
        self.nodes: list[TaskNode] = []
        """Of the records, in their order."""

    def tree(self, tasks: Sequence[Task]) -> Behaviour:
        """The whole tree: the tasks one after the other."""
        return composite("sequence", "tasks", [self._node(task, 0) for task in tasks])

    def _node(self, task: Task, depth: int) -> Behaviour:
        verb = verb_of(task)
        record = TaskStatus(name=title_of(task), depth=depth, kind=verb)
        place = len(self.records)
        self.records.append(record)
        if task.name:
            self._now.records[task.name] = record
        if verb in COMPOSITES:
            child: Behaviour = composite(verb, record.name, [self._node(part, depth + 1) for part in parts_of(task)])
        else:
            actions = self._actions(task)
            leaves: list[Behaviour] = [ActionNode(action, self._now) for action in actions]
            child = nothing(record.name) if not leaves else leaves[0] if len(leaves) == 1 else composite("parallel", record.name, leaves)
        node = TaskNode(task, child, record, self._now)
        self.nodes.insert(place, node)
        return node

    def _actions(self, task: Task) -> list[TaskAction]:
        """What a task does, side by side; each vehicle by itself where they do not depend on each other."""
        who = self._now.vehicles
        if task.arm is not None or task.disarm is not None:
            return [ArmAction(name, task.arm is not None) for name in who(task.arm or task.disarm or [])]
        if task.mode is not None:
            return [ChangeModeAction(name, Mode.Value(f"MODE_{task.mode.mode.upper()}")) for name in who(task.mode.vehicle)]
        if task.mission is not None:
            return [MissionAction(name) for name in who(task.mission)]
        if task.explore is not None:
            return [ExploreAction(name) for name in who(task.explore)]
        if task.charge is not None:
            return [ChargeAction(name, task.charge, self._chargers) for name in who(task.charge.vehicle)]
        if task.drive is not None:
            return [DriveAction(who(task.drive.vehicle), self._tracks[task.drive.track])]
        if task.save_map is not None:
            wanted, names = task.save_map, who(task.save_map.vehicle)
            return [SaveMapAction(name, wanted.name if len(names) == 1 else f"{wanted.name}_{name}", wanted.layer) for name in names]
        if task.share_map is not None:
            return [ShareMapAction(task.share_map, who(task.share_map.to))]
        return self._drives(task)

    def _drives(self, task: Task) -> list[TaskAction]:
        who = self._now.vehicles
        if task.goal is not None:
            return [self._goal(name, task.goal) for name in who(task.goal.vehicle)]
        if task.route is not None:
            return [RouteAction(name, task.route.places, task.route.kind) for name in who(task.route.vehicle)]
        if task.visit is not None:
            visit, vehicles = task.visit, who(task.visit.vehicle)
            if visit.found is not None:
                return [VisitFoundAction(vehicles, who(visit.found.by), visit.found.count, visit.found.near)]
            return [VisitAction(vehicles, visit.places)]
        if task.follow is not None:
            return self._column(task.follow)
        return []

    def _goal(self, name: str, goal: GoalTask) -> TaskAction:
        return FlyToAction(name, (goal.x, goal.y, goal.z)) if self._now.flies(name) else GoalAction(name, (goal.x, goal.y), goal.yaw)

    def _column(self, follow: FollowTask) -> list[TaskAction]:
        """Each behind the one before."""
        names = self._now.vehicles(follow.vehicle)
        leaders = [follow.leader, *names[:-1]]
        return [FollowAction(name, leader, follow.distance) for name, leader in zip(names, leaders, strict=True)]
