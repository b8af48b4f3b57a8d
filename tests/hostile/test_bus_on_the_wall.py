"""The page and the MAVLink link live through whatever is within the limits of the schema, however senseless."""

import os

import pytest

from schemas import topics
from schemas.messages import MissionItem, MissionProgress
from services.autopilot.mavlink.missions.reached import ReachedItems
from services.autopilot.mavlink.service import MavlinkService
from tests.hostile.bus_client import Stranger
from tests.services.autopilot.mavlink.rig import GCS, PLANE_FACTS, ROVER_FACTS, MemoryLink, shelves
from tests.services.gcs.fakes import Station
from uvf.mavlink import dialect as mav
from uvf.runtime.bus.interface import LocalBus
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.contract.service_runner import ServiceRunner

ROUNDS = int(os.environ.get("UVF_HOSTILE_EXAMPLES", "40"))
A_ROUND = 25
LARGEST = 1e11


def beset(shell, stranger, rounds, step):
    """Messages on everything that a service reads, some sound and senseless, some not sound."""
    read = [declared.topic for _, declared, _ in shell.reads()]
    for n in range(rounds):
        for _ in range(A_ROUND):
            topic = stranger.random.choice(read)
            if stranger.random.random() < 0.3:
                sample = stranger.sample(topic, n)
            else:
                sample = stranger._made("senseless", topic, stranger.sound(topic.message), n)
            for name, declared in shell.type.declared_inputs().items():
                if declared.topic == topic and name in shell._boxes:
                    shell._boxes[name].push(sample)
        step()


@pytest.mark.parametrize("seed", [1, 2])
def test_the_page_lives(seed):
    station = Station()
    stranger = Stranger(seed, ("burger", "milvus"), LARGEST)
    beset(station.shell, stranger, ROUNDS, lambda: station.run(0.05, silent=True))
    before = len(station.page.pictures)
    station.run(0.5)
    assert len(station.page.pictures) > before
    assert station.shell.refusals.count > 10


class Link:
    """The MAVLink service, and a station that asks for all that the bus may have told it."""

    def __init__(self):
        self.link = MemoryLink()
        self.shell = ServiceRunner(ServiceInstance(MavlinkService, self._made), LocalBus())
        self.heartbeats = 0
        self._station = mav.MAVLink(None, 255, 190)

    def _made(self):
        return MavlinkService([PLANE_FACTS, ROVER_FACTS], self.link, shelves())

    def step(self):
        self._say(mav.MAVLink_heartbeat_message(mav.MAV_TYPE_GCS, mav.MAV_AUTOPILOT_INVALID, 0, 0, 0, 3))
        for system in (PLANE_FACTS.system_id, ROVER_FACTS.system_id):
            for kind in (mav.MAV_MISSION_TYPE_MISSION, mav.MAV_MISSION_TYPE_FENCE, mav.MAV_MISSION_TYPE_RALLY):
                self._say(mav.MAVLink_mission_request_list_message(system, 1, kind))
                for item in range(3):
                    self._say(mav.MAVLink_mission_request_int_message(system, 1, item, kind))
            self._say(mav.MAVLink_param_request_list_message(system, 1))
        for _ in range(3):
            self.shell.sim_ns += 20_000_000
            self.shell.advance()
        client = mav.MAVLink(None)
        heard = [m for data, to in self.link.outgoing if to == GCS for m in client.parse_buffer(data)]
        self.heartbeats += sum(m.get_type() == "HEARTBEAT" for m in heard)
        self.link.outgoing.clear()

    def _say(self, message):
        self.link.incoming.append((message.pack(self._station), GCS))


@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.timeout(60)
def test_the_link_lives(seed):
    link = Link()
    beset(link.shell, Stranger(seed, ("plane", "rover"), LARGEST), ROUNDS, link.step)
    assert link.heartbeats >= 2 * int(ROUNDS * 3 / MavlinkService.hz)
    assert link.shell.refusals.count > 10


@pytest.mark.timeout(10)
def test_items_that_the_plan_has_not_are_not_reached():
    """An index of two thousand million once kept the link of all vehicles busy for hours."""
    reached, items = ReachedItems(), [MissionItem()] * 3
    reached.look(MissionProgress(state=MissionProgress.ACTIVE, reached=0), items)
    assert list(reached.look(MissionProgress(state=MissionProgress.ACTIVE, reached=2**31 - 1), items)) == [0, 1, 2]


def test_every_topic_of_the_table_is_spoken_to():
    stranger = Stranger(1, ("burger",))
    for topic in topics.TOPICS.values():
        for _ in range(20):
            assert stranger.sample(topic, 0).key.startswith("uvf/")
