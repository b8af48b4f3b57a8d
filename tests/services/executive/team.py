"""A team of vehicles that do what the executive asks of them, in a step or two, without a bus."""

from math import dist
from pathlib import Path

from schemas.messages import (
    Detection,
    Detections,
    Event,
    Grid,
    MapReply,
    MissionProgress,
    Mode,
    NavStatus,
    PoseInFrame,
    PreviewReply,
    Reply,
    TaskStatus,
    Vector3,
    VehicleStatus,
)
from services.executive.interface import Inputs
from services.executive.service import Executive
from uvf.maths.se2 import IDENTITY
from uvf.models.mission.file import MissionFile
from uvf.models.scenario import ROOT, load_scenario
from uvf.models.yaml_data import parse_yaml
from uvf.runtime.contract.service import Answer
from uvf.runtime.messages.convert import planar_frame, planar_pose

MISSION = """about: Two rovers and an aircraft.
world: house
duration: 10
vehicles:
  anne: {model: my3bot, system_id: 1, start: {x: 2.2, y: 1.3}, job: {explore: true, armed: false}, params: {detector: {}}}
  bert: {model: burger, system_id: 2, start: {x: 8.0, y: 4.4}}
  carl: {model: milvus, system_id: 3, start: {x: 0.0, y: -200.0, z: 60.0}, params: {detector: {}}}
roles: {team: [anne, bert]}
"""
DT = 0.1


class Team:
    """``asked``: every request as (name, vehicle, message); ``refusals``: by (name, vehicle) why it is refused.

    ``durations``: what a vehicle's previews say instead of 1 s for each metre.
    """

    def __init__(self, tasks: str, folder: Path, tracks=None) -> None:
        path = folder / "team.yaml"
        path.write_text(MISSION + "tasks:\n" + tasks)
        self.site = load_scenario(path, ROOT)
        self.mission: MissionFile = self.site.mission
        assert parse_yaml(tasks, "tasks")
        self.tracks = tracks or {}
        self.service = self.made()
        self.t = 0.0
        self.asked, self.events, self.drives = [], [], []
        self.refusals: dict[tuple[str, str], str] = {}
        self.places = {"anne": (2.2, 1.3), "bert": (8.0, 4.4), "carl": (0.0, -200.0)}
        self.heights = dict.fromkeys(self.places, 0.0)
        self.status = {name: VehicleStatus(mode=Mode.MODE_HOLD, battery_remaining=0.8) for name in self.places}
        self.nav: dict[str, NavStatus] = {}
        self.progress: dict[str, MissionProgress] = {}
        self.told: dict[str, list[Event]] = {}
        self.tasks = None
        self.detections: dict[str, Detections] = {}
        self.map_place = {name: planar_frame(0.0, f"{name}/map", f"{name}/map", IDENTITY) for name in ("anne", "bert")}
        self.durations: dict[str, float] = {}
        self.map, self.shared = Grid(frame_id="world"), {}
        self._answers: dict[str, list[Answer]] = {}

    def made(self) -> Executive:
        return Executive(self.mission.tasks, self.site.members, self.mission.roles, self.tracks, self.mission.chargers)

    def step(self, n: int = 1) -> None:
        for _ in range(n):
            self.t = round(self.t + DT, 6)
            pose = {name: PoseInFrame(pose=planar_pose(x, y, 0.0, self.heights[name])) for name, (x, y) in self.places.items()}
            heard = {"pose": pose, "status": self.status, "nav": self.nav, "progress": self.progress, "map_place": self.map_place}
            now = Inputs(told=self.told, detections=self.detections, **heard, **self._answers)
            self.told, self._answers = {}, {}
            out = self.service.step(self.t, now)
            self.tasks = out.tasks or self.tasks
            self.events += [event.text for event in out.events or ()]
            self.drives.append({name: (c.linear, c.angular) for name, c in (out.drive or {}).items()})
            self.shared.update(out.shared or {})
            for name in self.service.calls:
                for vehicle, messages in (getattr(out, name) or {}).items():
                    for message in messages:
                        self._asked(name, vehicle, message)

    def _asked(self, name, vehicle, message) -> None:
        self.asked.append((name, vehicle, message))
        why = self.refusals.get((name, vehicle), "")
        reply = Reply(accepted=not why, reason=why)
        if name == "preview":
            begin = (message.start.x, message.start.y) if message.HasField("start") else self.places[vehicle]
            duration = self.durations.get(vehicle, dist(begin, (message.position.x, message.position.y)))
            reply = PreviewReply(accepted=not why, reason=why, duration=duration)
        elif name == "get_map":
            reply = MapReply(accepted=not why, reason=why, grid=self.map)
        self._answers.setdefault(name, []).append(Answer(vehicle, message, reply))
        if why:
            return
        if name == "arm":
            self.status[vehicle].armed = message.arm
        elif name == "mode":
            self.status[vehicle].mode = message.mode
        elif name == "goal":
            self.nav[vehicle] = NavStatus(job="goal", state=NavStatus.DRIVING, goal=message.position)
        elif name == "route":
            self.nav[vehicle] = NavStatus(job="waypoints", state=NavStatus.DRIVING, route=message)
        elif name == "follow":
            self.nav[vehicle] = NavStatus(job="follow", state=NavStatus.DRIVING, follow=message)

    def find(self, vehicle: str, *places) -> None:
        """The markers that the vehicle has found."""
        told = [Detection(id=k, position=Vector3(x=x, y=y), sigma=0.2) for k, (x, y) in enumerate(places)]
        self.detections[vehicle] = Detections(detections=told)

    def arrive(self, vehicle: str) -> None:
        self.nav[vehicle].state = NavStatus.REACHED

    def give_up(self, vehicle: str, cause: str) -> None:
        self.nav[vehicle] = NavStatus(job="idle")
        self.told[vehicle] = [Event(text="goal: goal given up", cause=cause)]

    def states(self) -> list[str]:
        return [TaskStatus.State.Name(task.state) for task in self.tasks.tasks]

    def requests(self) -> list[str]:
        return [f"{name} {vehicle}" for name, vehicle, _ in self.asked]
