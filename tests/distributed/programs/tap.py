"""A wire tap between the vehicles and one program: what goes each way is passed on at once and kept with its time."""

import selectors
import socket
import threading
import time

from uvf.mavlink import dialect as mav

WANTED = {
    mav.MAVLINK_MSG_ID_HEARTBEAT,
    mav.MAVLINK_MSG_ID_STATUSTEXT,
    mav.MAVLINK_MSG_ID_COMMAND_LONG,
    mav.MAVLINK_MSG_ID_COMMAND_INT,
    mav.MAVLINK_MSG_ID_COMMAND_ACK,
    mav.MAVLINK_MSG_ID_MISSION_REQUEST_INT,
    mav.MAVLINK_MSG_ID_MISSION_ITEM_INT,
    mav.MAVLINK_MSG_ID_MISSION_ACK,
    mav.MAVLINK_MSG_ID_PARAM_REQUEST_LIST,
    mav.MAVLINK_MSG_ID_PARAM_VALUE,
    mav.MAVLINK_MSG_ID_SYSTEM_TIME,
}
"""Messages that are kept; the rest of the telemetry is only passed on."""


class Tap:
    """The vehicles send to ``port``; the program listens at ``program``, a port. Messages ``swapped`` of the program go out in pairs,
    the second of which overtakes the first.
    """

    def __init__(self, program, swapped=None):
        self._outer, self._inner = _socket(), _socket()
        self._swapped, self._overtaken = swapped, None
        self.port = self._outer.getsockname()[1]
        self._program, self._vehicles = ("127.0.0.1", program), None
        self._kept = []
        """(t, from the vehicles, packet)"""
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._pass_on, name=f"tap {self.port}")

    def __enter__(self):
        self._thread.start()
        return self

    def _pass_on(self):
        with selectors.DefaultSelector() as selector:
            for sock in (self._outer, self._inner):
                selector.register(sock, selectors.EVENT_READ)
            while not self._stop.is_set():
                for key, _ in selector.select(0.2):
                    self._take(key.fileobj)

    def _take(self, sock):
        try:
            data, sender = sock.recvfrom(65536)
        except OSError:
            return  # nobody listens yet
        number = int.from_bytes(data[7:10], "little") if data[0] == mav.PROTOCOL_MARKER_V2 else None
        if number is None or number in WANTED:
            self._kept.append((time.monotonic(), sock is self._outer, data))
        if sock is self._outer:
            self._vehicles = sender
            self._inner.sendto(data, self._program)
        elif self._vehicles is not None:
            self._send(number, data)

    def _send(self, number, data):
        if number == self._swapped and number is not None and self._overtaken is None:
            self._overtaken = data
            return
        self._outer.sendto(data, self._vehicles)
        if self._overtaken is not None:
            self._outer.sendto(self._overtaken, self._vehicles)
            self._overtaken = None

    def heard(self):
        """(t, message) of the vehicles to the program."""
        return self._messages(True)

    def said(self):
        """(t, message) of the program to the vehicles."""
        return self._messages(False)

    def _messages(self, from_vehicles):
        codec = mav.MAVLink(None)
        codec.robust_parsing = True
        kept = [(t, data) for t, way, data in list(self._kept) if way == from_vehicles]
        return [(t, m) for t, data in kept for m in codec.parse_buffer(data) or () if m.get_msgId() in WANTED]

    def __exit__(self, *_):
        self._stop.set()
        self._thread.join()
        self._outer.close()
        self._inner.close()


def _socket():
    sock = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    sock.bind(("127.0.0.1", 0))
    return sock
