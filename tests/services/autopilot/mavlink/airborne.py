"""A ground station on a link in memory, the MAVLink service, the real autopilot and JSBSim, in lockstep at a field 300 m high."""

import msgspec

from schemas import topics
from services.autopilot.air.build import hosts
from services.autopilot.mavlink.build import facts_of
from services.autopilot.mavlink.service import MavlinkService
from services.sim_air.build import build as build_sim
from tests.services.autopilot.mavlink.rig import GCS, MemoryLink, Shelf
from uvf.mavlink import dialect as mav
from uvf.models.mission.file import JobFile
from uvf.models.scenario import ROOT, MissionVehicle, load_scenario
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.contract.service_runner import ServiceRunner
from uvf.runtime.time.lockstep import Lockstep

NS = 1_000_000_000
STEP = 0.1  # s, between two looks


def field(job=None):
    """Milvus on the strip of the airfield, without a job."""
    site = load_scenario(ROOT / "missions" / "circuit.yaml")
    member = site.members["milvus"]
    entry = msgspec.structs.replace(member.entry, job=job or JobFile())
    site.members["milvus"] = MissionVehicle(member.name, entry, member.file, member.folder)
    return site


class Airborne:
    """``say`` a message, ``fly`` until something is so; what was heard stays in ``heard``, and the true motion in ``truth``."""

    def __init__(self, site=None):
        site = site or field()
        self.link = MemoryLink()
        self.run = Lockstep([*build_sim(site), *hosts(site)])
        service = MavlinkService(facts_of(site), self.link, {name: Shelf() for name in site.members})
        self.service = service
        self._shell = ServiceRunner(ServiceInstance(MavlinkService, lambda: service, writes_for=tuple(site.members)), self.run.bus)
        self.heard = []
        """(t, message) to the ground station."""
        self.truth = []
        self.t = 0.0
        self._mav, self._client = mav.MAVLink(None, 255, 190), mav.MAVLink(None)
        self.run.bus.subscribe(topics.TRUTH.at("milvus"), topics.TRUTH.qos, self._see)

    def _see(self, sample):
        self.truth.append((sample.stamp_ns * 1e-9, topics.TRUTH.message.FromString(sample.payload)))

    @property
    def now(self):
        """True position and velocity (east, north, up), airspeed."""
        m = self.truth[-1][1]
        return (m.position.x, m.position.y, m.position.z), (m.velocity.x, m.velocity.y, m.velocity.z), m.airspeed

    def say(self, message):
        self.link.incoming.append((message.pack(self._mav), GCS))

    def ask(self, message, seconds=1.0):
        """The result of a command, and how long it took [s]."""
        begun = self.t
        self.say(message)
        at, ack = self.hears("COMMAND_ACK", seconds, lambda m: m.command == message.command)
        return ack.result, at - begun

    def hears(self, kind, seconds, fits=lambda m: True):
        """The next message of a kind, with its time."""
        seen = len(self.heard)
        found = []

        def came():
            found.extend((t, m) for t, m in self.heard[seen:] if m.get_type() == kind and fits(m))
            return bool(found)

        assert self.fly(seconds, came, 0.02), f"no {kind} within {seconds} s; {self.texts()[-5:]}"
        return found[0]

    def texts(self):
        return [m.text for _, m in self.heard if m.get_type() == "STATUSTEXT"]

    def fly(self, seconds, until=lambda: False, step=STEP):
        """Whether it has become so within that time."""
        end = self.t + seconds
        while self.t < end - 1e-9:
            self.t = round(self.t + step, 6)
            self.run.run(self.t, self._tick)
            if until():
                return True
        return False

    def _tick(self, t):
        """The link runs on simulated time here."""
        while self._shell.due_ns <= round(t * NS):
            self._shell.sim_ns = self._shell.due_ns
            self._shell.advance()
        self._hear(t)
        self.link.outgoing.clear()
        return True

    def _hear(self, t):
        for data, to in self.link.outgoing:
            if to == GCS:
                self.heard += [(t, m) for m in self._client.parse_buffer(data) or ()]
