"""Two systems in one process: the real autopilot with its MAVLink service in JSBSim or PyBullet, and a bridge on a bus of its own.

Between them real UDP sockets on the loopback; both ends step on simulated time, so that nothing depends on the machine.
"""

import contextlib

from schemas import topics
from schemas.messages import ExternalVehicle
from services.autopilot.mavlink.build import facts_of
from services.autopilot.mavlink.service import MavlinkService
from services.mavlink_bridge.discovery import Discovery, names_from
from services.mavlink_bridge.frame import BridgeOrigin
from services.mavlink_bridge.service import BridgedVehicle
from services.mavlink_bridge.station import Station
from tests.services.autopilot.mavlink.rig import Shelf
from uvf.mavlink.endpoint import UdpLink
from uvf.runtime.bus.interface import LocalBus
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.contract.service_runner import ServiceRunner
from uvf.runtime.time.lockstep import Lockstep

NS = 1_000_000_000


class Sides(contextlib.AbstractContextManager):
    """``ask`` on the bridge's bus, ``run`` until something is so; ``newest`` of a topic there, and the ``truth`` of the far side."""

    def __init__(self, site, hosts, name, origin=None, rate=1.0):
        self.name, self.site = name, site
        (self.system,) = {m.entry.system_id for m in site.members.values()}
        (self.far_name,) = site.members
        near = UdpLink([], ("127.0.0.1", 0))
        self._far_link = UdpLink([near.addresses[1]])
        self.run_far = Lockstep(hosts)
        service = MavlinkService(facts_of(site), self._far_link, {n: Shelf() for n in site.members})
        self._far = ServiceRunner(ServiceInstance(MavlinkService, lambda: service, writes_for=tuple(site.members)), self.run_far.bus)
        self.bus = LocalBus()
        self.station = Station(near)
        self.origin = BridgeOrigin(origin)
        self.said = []
        discovery = Discovery(self.station, names_from([name]), self._found, self.said.append)
        self._near = [ServiceRunner(ServiceInstance(Discovery, lambda: discovery), self.bus)]
        self._seen = {}
        self.events = []
        self.truth = None
        self.speaks = True
        """Whether the far side's MAVLink service runs."""
        self.t = 0.0
        truth = topics.TRUTH
        self.run_far.bus.subscribe(truth.at(self.far_name), truth.qos, self._see)
        for topic in (topics.NAV_STATE, topics.STATUS, topics.MISSION, topics.PROGRESS, topics.EXTERNAL_VEHICLE):
            self.bus.subscribe(topic.at(name), topic.qos, self._keep(topic))
        events = topics.EVENTS.by("mavlink_bridge")
        self.bus.subscribe(events.at(name), events.qos, lambda s: self.events.append(events.message.FromString(s.payload).text))

    def _see(self, sample):
        self.truth = topics.TRUTH.message.FromString(sample.payload)

    def _found(self, name, system):
        make = lambda: BridgedVehicle(name, system, self.station, self.origin, ExternalVehicle(model="x"))  # noqa: E731
        shell = ServiceRunner(ServiceInstance(BridgedVehicle, make, name), self.bus)
        shell.skip_to(round(self.t * NS), count=False)
        self._near.append(shell)

    def _keep(self, topic):
        return lambda sample: self._seen.update({topic.key: topic.message.FromString(sample.payload)})

    def newest(self, topic):
        return self._seen.get(topic.key)

    def run(self, seconds, until=lambda: False, step=0.1):
        """Whether it has become so within that time [s, simulated]."""
        end = self.t + seconds
        while self.t < end - 1e-9:
            self.t = round(self.t + step, 6)
            self.run_far.run(self.t, self._tick)
            if until():
                return True
        return False

    def _tick(self, t):
        while self.speaks and self._far.due_ns <= round(t * NS):
            self._far.sim_ns = self._far.due_ns
            self._far.advance()
        for shell in list(self._near):
            while shell.due_ns <= round(t * NS):
                shell.advance()
        return True

    def ask(self, request, message, seconds=6.0):
        """The reply, once it is there."""
        got = []
        self.bus.call(request.at(self.name), message.SerializeToString(), 0, lambda reply, reason, at: got.append((reply, reason)))
        assert self.run(seconds, lambda: bool(got), 0.02), f"no reply; {self.events[-5:]}"
        reply, reason = got[0]
        assert reply is not None, reason
        return request.reply.FromString(reply)

    def __exit__(self, *_):
        self.run_far.close()
        self._far_link.close()
        self.station.close()
