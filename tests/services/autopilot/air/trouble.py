"""Flights with faults, fences and radio links, for the tests of failsafes."""

import dataclasses

import msgspec

from schemas import topics
from schemas.messages import Link, Mode, ModeRequest, SurfaceCommand
from tests.services.autopilot.air.test_flight import LAPS, Flight, site
from uvf.models.mission.faults import Fault
from uvf.models.mission.fence import FenceFile
from uvf.models.world.wind import Gust, Wind
from uvf.runtime.messages.convert import stamp


def troubled(faults=(), fence=None, wind=(0.0, 0.0, 0.0), job=LAPS, energy=None, params=None, storm=None, altimeter=True):
    """A site whose aircraft meets these; faults: (part, kind, at, until, size); storm: m/s to the north at most, m of air flown in it."""
    made = site(job, wind=wind)
    member = made.members["milvus"]
    file = member.file
    if energy is not None:
        air = msgspec.structs.replace(file.air, battery=msgspec.structs.replace(file.air.battery, energy=energy))
        file = msgspec.structs.replace(file, air=air)
    if not altimeter:
        file = msgspec.structs.replace(file, sensors=msgspec.structs.replace(file.sensors, rangefinders=[]))
    if params:
        file = msgspec.structs.replace(file, params={"autopilot_air": {**file.params["autopilot_air"], **params}})
    entry = msgspec.structs.replace(member.entry, fence=fence or FenceFile())
    listed = [Fault("milvus", part, kind, at, until, size) for part, kind, at, until, size in faults]
    mission = msgspec.structs.replace(made.mission, faults=listed, vehicles={"milvus": entry})
    if storm is not None:
        gust = Gust((0.0, storm[0], 0.0), storm[1], time=1.0)
        made = dataclasses.replace(made, world=msgspec.structs.replace(made.world, wind=Wind(wind, gusts=[gust])))
    return dataclasses.replace(made, mission=mission, members={"milvus": dataclasses.replace(member, entry=entry, file=file)})


class Trouble(Flight):
    """Publishes as a ground station's link and as a hand would, as long as told to."""

    def __init__(self, **trouble):
        flown = troubled(**trouble)
        super().__init__(flown)
        self.events = self._record(topics.EVENTS.by("autopilot"))
        self.crash_events = self._record(topics.EVENTS.by("sim_air"))
        self._link = self._publisher(topics.LINK)
        self._hand = self._publisher(topics.SURFACES.by("client"))
        self.linked = False
        self.hand = None

    def _publisher(self, topic):
        return self.bus.publisher(topic.at("milvus"), topic.message.DESCRIPTOR.full_name, topic.qos)

    def run(self, until):
        self.lockstep.run(until, self._speak)

    def _speak(self, t):
        if self.linked and round(t * 100) % 50 == 0:
            self._link.put(Link(timestamp=stamp(t), stations=1).SerializeToString(), round(t * 1e9))
        if self.hand is not None and round(t * 100) % 5 == 0:
            self._hand.put(SurfaceCommand(timestamp=stamp(t), **self.hand).SerializeToString(), round(t * 1e9))
        return True

    def take(self, mode):
        """Asks for a mode."""
        t = self.status[-1][0]
        self.ask(topics.SET_MODE, ModeRequest(mode=Mode.Value(f"MODE_{mode.upper()}"), source="test"), t)

    @property
    def crashed(self):
        return any(m.text == "crashed" for _, m in self.crash_events)

    def told(self, text):
        """Times [s] at which this was said."""
        return [round(t, 1) for t, m in self.events if m.text.startswith(text)]

    def mode_at(self, t):
        return next(m for at, m in reversed(self.status) if at <= t)
