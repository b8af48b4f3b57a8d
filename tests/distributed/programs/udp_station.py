"""A ground station's end of a UDP link, with what the emulator of QGroundControl wants of a rig."""

import select
import socket
import time

from services.autopilot.mavlink.telemetry.telemetry import STREAMS
from uvf.mavlink import dialect as mav

UNREAD = {number for number, stream in STREAMS.items() if stream.hz} - {mav.MAVLINK_MSG_ID_HEARTBEAT, mav.MAVLINK_MSG_ID_HOME_POSITION}
"""Telemetry that comes by itself and that nobody here waits for."""


class UdpStation:
    """``say`` a message, ``run`` for a while and have what came meanwhile; time is wall time."""

    def __init__(self):
        self._sock = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._sock.bind(("127.0.0.1", 0))
        self.port = self._sock.getsockname()[1]
        self._vehicles = None
        self._mav, self._parser = mav.MAVLink(None), mav.MAVLink(None)

    @property
    def t(self):
        return time.monotonic()

    def say(self, message, system=255, component=190, peer=None):
        self._mav.srcSystem, self._mav.srcComponent = system, component
        if self._vehicles is not None:
            self._sock.sendto(message.pack(self._mav), self._vehicles)

    def run(self, seconds):
        end, came = self.t + seconds, []
        while select.select([self._sock], [], [], max(end - self.t, 0.0))[0]:
            data, self._vehicles = self._sock.recvfrom(65536)
            if int.from_bytes(data[7:10], "little") not in UNREAD:
                came += self._parser.parse_buffer(data) or []
            if self.t >= end:
                break
        return came

    def drain(self):
        """Forgets what has come while nobody ran it."""
        while select.select([self._sock], [], [], 0.0)[0]:
            self._sock.recv(65536)

    def close(self):
        self._sock.close()
