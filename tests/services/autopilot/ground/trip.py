"""Drives in lockstep with physics, SLAM and planner, with faults and what stands in the way, for the tests of failsafes."""

import dataclasses
import json

import msgspec
import yaml

from schemas import topics
from schemas.messages import DriveCommand, Link, Mode, ModeRequest, ParamRequest, Reply
from services.autopilot.ground.build import hosts
from services.planner.build import build as planner
from services.sim_ground.build import build as simulator
from services.slam.build import build as slam
from uvf.models.scenario import load_scenario
from uvf.runtime.messages.convert import stamp
from uvf.runtime.time.lockstep import Lockstep

START = {"x": 5.0, "y": 4.4, "yaw": 0.0}
THERE_AND_BACK = {"mission": [{"x": 6.2, "y": 4.4}, {"x": 5.0, "y": 4.4}, {"kind": "jump", "jump_to": 0, "repeat": -1}]}


def site(folder, faults, entry, ground, world=None, sensors=None):
    """entry: more of the vehicle's in the mission; ground, sensors: what is different about the body and what it carries."""
    path = folder / "trip.yaml"
    vehicle = {"model": "burger", "system_id": 1, "start": START, **entry}
    listed = [dict(zip(("part", "kind", "at", "until", "size"), fault, strict=False), vehicle="burger") for fault in faults]
    path.write_text(yaml.safe_dump({"about": "test", "world": "house", "seed": 1, "vehicles": {"burger": vehicle}, "faults": listed}))
    made = load_scenario(path)
    member = made.members["burger"]
    body = msgspec.structs.replace(member.file.ground, **ground)
    carried = msgspec.structs.replace(member.file.sensors, **(sensors or {}))
    member = dataclasses.replace(member, file=msgspec.structs.replace(member.file, ground=body, sensors=carried))
    return dataclasses.replace(made, members={"burger": member}, world=world or made.world)


class Trip:
    """``hand``, ``outside``: (m/s, rad/s) that somebody commands, as long as told to; ``linked``: whether a ground station is heard."""

    def __init__(self, folder, faults=(), entry=None, ground=None, thinks=True, **changed):
        """thinks: with SLAM and planner; changed: world and sensors, as for ``site``."""
        made = site(folder, faults, entry or {}, ground or {}, **changed)
        self.lockstep = Lockstep([*simulator(made), *hosts(made), *(slam(made) + planner(made) if thinks else [])])
        self.bus = self.lockstep.bus
        self.truth, self.status = self._record(topics.TRUTH), self._record(topics.STATUS)
        self.events = self._record(topics.EVENTS.by("autopilot"))
        self._senders = {topic: self._publisher(topic) for topic in (topics.LINK, topics.DRIVE.by("teleop"), topics.DRIVE.by("offboard"))}
        self.linked, self.hand, self.outside = False, None, None
        self.replies = []
        self.t = 0.0

    def _record(self, topic):
        seen = []
        keep = lambda sample: seen.append((sample.stamp_ns * 1e-9, topic.message.FromString(sample.payload)))  # noqa: E731
        self.bus.subscribe(topic.at("burger"), topic.qos, keep)
        return seen

    def _publisher(self, topic):
        return self.bus.publisher(topic.at("burger"), topic.message.DESCRIPTOR.full_name, topic.qos)

    def run(self, until):
        self.lockstep.run(until, self._speak)
        self.t = until

    def _speak(self, t):
        if self.linked and round(t * 100) % 50 == 0:
            self._senders[topics.LINK].put(Link(timestamp=stamp(t), stations=1).SerializeToString(), round(t * 1e9))
        for source, wanted in (("teleop", self.hand), ("offboard", self.outside)):
            if wanted is not None and round(t * 100) % 5 == 0:
                command = DriveCommand(timestamp=stamp(t), linear=wanted[0], angular=wanted[1])
                self._senders[topics.DRIVE.by(source)].put(command.SerializeToString(), round(t * 1e9))
        return True

    def ask(self, request, message, owner="burger"):
        on_reply = lambda reply, reason, _: self.replies.append(Reply.FromString(reply) if reply else Reply(reason=reason))  # noqa: E731
        self.bus.call(request.at(owner), message.SerializeToString(), round(self.t * 1e9), on_reply)

    def set(self, name, value):
        """A parameter of the autopilot."""
        request = ParamRequest(name=name, value=json.dumps(value))
        self.ask(topics.PARAM.by("autopilot_ground"), request)

    def take(self, mode):
        self.ask(topics.SET_MODE, ModeRequest(mode=Mode.Value(f"MODE_{mode.upper()}"), source="test"))

    def told(self, text):
        """Times [s] at which this was said."""
        return [round(t, 1) for t, m in self.events if m.text.startswith(text)]

    @property
    def mode(self):
        return Mode.Name(self.status[-1][1].mode)[5:]

    def way(self, since, until):
        """m, driven between two times [s]."""
        a, b = (min(self.truth, key=lambda row, at=at: abs(row[0] - at))[1].position for at in (since, until))
        return ((a.x - b.x) ** 2 + (a.y - b.y) ** 2) ** 0.5
