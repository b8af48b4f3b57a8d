"""The MAVLink service alone: what three aircraft and two rovers cost, told to three ground stations over UDP.

Every topic that it reads comes at its own rate, encoded, over a bus in this process; all stations send heartbeats and a command a second.
``core %`` is the CPU time of the service's steps, with decoding and sending, in parts of real time. ``messages/s`` is what one aircraft
says to one station. ``bad packets/s``: so many are read and refused in a second of CPU time.
"""

import random
import socket
import tempfile
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from google.protobuf.message import Message

from benchmarks.measuring.timing import stopwatch
from schemas import topics
from schemas.messages import Gnss, Kind, Mode, Targets, Vector3, VehicleStatus
from services.autopilot.mavlink.build import facts_of
from services.autopilot.mavlink.connection.facts import VehicleInfo
from services.autopilot.mavlink.parameters.parameter_store import FileStore
from services.autopilot.mavlink.service import MavlinkService
from uvf.mavlink import dialect as mav
from uvf.mavlink.codec import Codec
from uvf.mavlink.endpoint import UdpLink
from uvf.models.scenario import ROOT, load_scenario
from uvf.runtime.bus.interface import LocalBus, Publisher
from uvf.runtime.contract.declaration import Input
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.contract.service_runner import ServiceRunner
from uvf.runtime.messages.convert import stamp
from uvf.runtime.messages.step_times import NS

SECONDS, WARM_UP = 20.0, 2.0
DT = 0.02
STATIONS = 3
PACKETS = 50_000
FILLED: dict[str, Message] = {
    "status": VehicleStatus(kind=Kind.KIND_FIXED_WING, mode=Mode.MODE_MISSION, armed=True, home=Vector3(z=20.0)),
    "gnss": Gnss(fix=Gnss.FIX_3D, latitude=0.7, longitude=0.2, altitude=400.0, satellites=12),
    "targets": Targets(place=Vector3(x=100.0), altitude=80.0, airspeed=25.0, bank=0.1, pitch=0.1),
}


def five() -> list[VehicleInfo]:
    """Three aircraft and two rovers after the vehicles of the demo."""
    demo = {facts.file.kind: facts for facts in facts_of(load_scenario(ROOT / "missions" / "demo.yaml"))}
    kinds = ("fixed_wing",) * 3 + ("ground",) * 2
    return [replace(demo[kind], name=f"vehicle{n}", system_id=n) for n, kind in enumerate(kinds, 1)]


class World:
    """Publishes what the service reads of its vehicles, each topic at its rate."""

    def __init__(self, bus: LocalBus, fleet: Sequence[VehicleInfo]) -> None:
        read = {name: declared for name, declared in MavlinkService.inputs.items() if isinstance(declared, Input)}
        self._senders: list[tuple[float, Publisher, Message]] = []
        for name, declared in read.items():
            topic = declared.topic
            if topic.hz and declared.each_vehicle:
                self._senders += [(topic.hz, _publisher(bus, topic, one.name), FILLED.get(name, topic.message())) for one in fleet]

    def step(self, n: int) -> None:
        """The ``n``-th step of ``DT``; what comes faster than the steps comes once in each."""
        t = n * DT
        for hz, sender, message in self._senders:
            if n % max(round(1 / (hz * DT)), 1) == 0:
                message.timestamp.CopyFrom(stamp(t))  # type: ignore[attr-defined]
                sender.put(message.SerializeToString(), round(t * NS))


def _publisher(bus: LocalBus, topic: topics.Topic[Any], owner: str) -> Publisher:
    return bus.publisher(topic.at(owner), topic.message.DESCRIPTOR.full_name, topic.qos)


class Station:
    """Counts what it hears of the first vehicle, and asks once a second."""

    def __init__(self) -> None:
        self.sock = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.sock.bind(("127.0.0.1", 0))
        self.sock.setblocking(False)
        self.heard = 0
        self._mav = mav.MAVLink(None, 255, 190)

    def step(self, n: int, to: tuple[str, int]) -> None:
        """Reads what has come; once in 50 ticks sends a heartbeat and a command."""
        while True:
            try:
                self.heard += self.sock.recv(1024)[5] == 1
            except BlockingIOError:
                break
        if n % 50 == 0:
            beat = mav.MAVLink_heartbeat_message(mav.MAV_TYPE_GCS, mav.MAV_AUTOPILOT_INVALID, 0, 0, 0, 3)
            ask = mav.MAVLink_command_long_message(1, 1, mav.MAV_CMD_REQUEST_MESSAGE, 0, 148.0, 0.0, 0.0, 0.0, 0.0, 0.0, float(n))
            for message in (beat, ask):
                self.sock.sendto(message.pack(self._mav), to)


def load(data: Path | None) -> dict[str, dict[str, float]]:
    """CPU time of the service in % of a core, and messages that one station hears of one aircraft in a second."""
    fleet, bus, stations = five(), LocalBus(), [Station() for _ in range(STATIONS)]
    link = UdpLink([station.sock.getsockname() for station in stations])
    nowhere = FileStore(Path(tempfile.gettempdir()) / "uvf-no-settings.json")  # nothing is set, so it is never written
    stores = {facts.name: nowhere for facts in fleet}
    shell = ServiceRunner(ServiceInstance(MavlinkService, lambda: MavlinkService(fleet, link, stores)), bus)
    world, cpu = World(bus, fleet), 0.0
    for n in range(1, round((WARM_UP + SECONDS) / DT) + 1):
        if n == round(WARM_UP / DT):
            cpu = 0.0
            for station in stations:
                station.heard = 0
        world.step(n)
        for station in stations:
            station.step(n, link.addresses[0])
        with stopwatch() as taken:
            shell.advance()
        cpu += taken[0]
    for station in stations:
        station.sock.close()
    link.close()
    return {f"5 vehicles, {STATIONS} stations": {"core %": 100 * cpu / SECONDS, "messages/s": stations[0].heard / SECONDS}}


def rubbish(data: Path | None) -> dict[str, dict[str, float]]:
    """How many broken packets are refused in a second of CPU time."""
    rng, codec = random.Random(1), Codec()
    order = mav.MAVLink_command_long_message(1, 1, 400, 0, 1.0, 0, 0, 0, 0, 0, 0).pack(mav.MAVLink(None, 255, 190))
    packets = [_spoiled(rng, order) for _ in range(PACKETS)]
    with stopwatch() as taken:
        for packet in packets:
            codec.parse(packet)
    return {"broken packets": {"bad packets/s": PACKETS / taken[0]}}


def _spoiled(rng: random.Random, packet: bytes) -> bytes:
    if rng.random() < 0.5:
        return rng.randbytes(rng.randrange(1, 280))
    at = rng.randrange(1, len(packet))
    return packet[:at] + bytes((packet[at] ^ rng.randrange(1, 256),)) + packet[at + 1 :]


CASES = {"load": load, "rubbish": rubbish}
