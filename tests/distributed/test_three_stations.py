"""Three ground stations at once over UDP: each hears the vehicles without a gap, and the answers to its own questions alone."""

import itertools
import socket
import time
from contextlib import ExitStack

import pytest

from tests.distributed.mavlink_vehicles import LiveVehicles
from tests.services.autopilot.mavlink.rig import PLANE, ROVER, long
from uvf.mavlink import dialect as mav

SECONDS = 5.0
WARM_UP = 1.0
LONGEST_GAP = 1.5  # s


class Station:
    """A program that asks its own question again and again, as QGroundControl, MAVProxy or MAVSDK would."""

    def __init__(self, system, component, command):
        self.sock = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.sock.bind(("127.0.0.1", 0))
        self.sock.setblocking(False)
        self.who = (system, component)
        self.command = command
        self.asked = 0
        self.acks, self.beats = [], {PLANE: [], ROVER: []}
        self._mav = mav.MAVLink(None, system, component)
        self._vehicles = None
        self._beat_at = self._ask_at = 0.0

    @property
    def address(self):
        return self.sock.getsockname()

    def call(self, address):
        """Speaks first, to where the vehicles listen."""
        self._vehicles = address

    def step(self, now):
        while True:
            try:
                data, self._vehicles = self.sock.recvfrom(2048)
            except BlockingIOError:
                break
            for message in self._mav.parse_buffer(data) or ():
                self._take(now, message)
        if self._vehicles is None:
            return
        if now >= self._beat_at:
            self._beat_at = now + 1.0
            self._say(mav.MAVLink_heartbeat_message(mav.MAV_TYPE_GCS, mav.MAV_AUTOPILOT_INVALID, 0, 0, 0, 3))
        if now >= self._ask_at:
            self._ask_at = now + 0.2
            self.asked += 1
            self._say(long(self.command, 148.0, system=PLANE if self.asked % 2 else ROVER))

    def _say(self, message):
        self.sock.sendto(message.pack(self._mav), self._vehicles)

    def _take(self, now, message):
        if message.get_type() == "HEARTBEAT":
            self.beats[message.get_srcSystem()].append(now)
        elif message.get_type() == "COMMAND_ACK":
            self.acks.append((message.command, (message.target_system, message.target_component)))


@pytest.fixture(scope="module")
def stations():
    """QGroundControl and MAVSDK where they are expected, MAVProxy as a caller at the listening port."""
    with ExitStack() as stack:
        three = [Station(255, 190, 512), Station(245, 190, 520), Station(255, 230, 519)]
        for station in three:
            stack.enter_context(station.sock)
        vehicles = stack.enter_context(LiveVehicles([station.address for station in three[:2]], ("127.0.0.1", 0)))
        three[2].call(vehicles.link.addresses[1])
        end = time.monotonic() + WARM_UP + SECONDS
        while (now := time.monotonic()) < end:
            for station in three:
                station.step(now)
            time.sleep(0.005)
        yield three


@pytest.mark.parametrize("n", range(3))
def test_each_gets_the_answers_to_its_own_questions_alone(stations, n):
    station = stations[n]
    assert set(station.acks) == {(station.command, station.who)}
    assert station.asked - 2 <= len(station.acks) <= station.asked and station.asked > 20


@pytest.mark.parametrize("n", range(3))
@pytest.mark.parametrize("system", [PLANE, ROVER])
def test_each_hears_each_vehicle_without_a_gap(stations, n, system):
    beats = stations[n].beats[system]
    assert len(beats) >= SECONDS - 1
    assert max(b - a for a, b in itertools.pairwise(beats)) <= LONGEST_GAP
