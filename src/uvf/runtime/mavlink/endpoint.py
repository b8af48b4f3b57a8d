"""UDP to ground stations: the vehicle speaks first to configured peers, and answers whoever else calls."""

import socket
from collections.abc import Sequence
from typing import Protocol

Peer = tuple[str, int]
"""Address and port of a ground station."""

FORGET_AFTER = 60.0  # s of silence, learned peers only
MOST_LEARNED = 32
DATAGRAM_BYTES = 65536
DATAGRAMS_PER_CALL = 500


class Link(Protocol):
    """Datagrams from and to peers."""

    @property
    def port(self) -> int:
        """From which this end speaks first."""

    def receive(self, t: float) -> list[tuple[bytes, Peer]]:
        """Everything that has arrived, without waiting; ``t`` [s] is now."""

    def peers(self, t: float) -> list[Peer]:
        """Who hears what is meant for everybody."""

    def keep(self, t: float, peer: Peer) -> None:
        """Something sound has come from a peer, in the last call: it hears the vehicles while it says something now and then."""

    def send(self, datagram: bytes, peer: Peer) -> None: ...

    def close(self) -> None: ...


class UdpLink:
    """One socket to speak from and perhaps one with a known port to be called at.

    targets: numeric addresses that always hear the vehicle; listen: where others may call, port 0 = any free one.
    Raises OSError when ``listen`` is taken.
    """

    def __init__(self, targets: Sequence[Peer], listen: Peer | None = None) -> None:
        self._targets = list(dict.fromkeys(targets))
        loopback = all(host.startswith("127.") for host, _ in self._targets)
        self._own = _bound(("127.0.0.1" if loopback else "0.0.0.0", 0))
        self._sockets = [self._own]
        self._learned: dict[Peer, tuple[float, socket.socket]] = {}
        self._arrived: dict[Peer, socket.socket] = {}
        """Where the datagrams of the last call have come in."""
        if listen is not None:
            try:
                self._sockets.append(_bound(listen))
            except OSError:
                self._own.close()
                raise

    @property
    def port(self) -> int:
        return int(self._own.getsockname()[1])

    @property
    def addresses(self) -> list[Peer]:
        """Where this end can be reached: the speaking socket first."""
        return [sock.getsockname() for sock in self._sockets]

    def receive(self, t: float) -> list[tuple[bytes, Peer]]:
        self._arrived.clear()
        arrived = [(data, peer) for sock in self._sockets for data, peer in self._drain(sock)]
        for peer in [p for p, (heard, _) in self._learned.items() if t - heard > FORGET_AFTER]:
            del self._learned[peer]
        return arrived

    def _drain(self, sock: socket.socket) -> list[tuple[bytes, Peer]]:
        arrived: list[tuple[bytes, Peer]] = []
        for _ in range(DATAGRAMS_PER_CALL):
            try:
                data, peer = sock.recvfrom(DATAGRAM_BYTES)
            except BlockingIOError:
                break
            except OSError:
                continue  # "connection refused" of an earlier datagram: nobody listens there yet
            self._arrived[peer] = sock
            arrived.append((data, peer))
        return arrived

    def keep(self, t: float, peer: Peer) -> None:
        if peer in self._targets:
            return
        if peer not in self._learned and len(self._learned) >= MOST_LEARNED:
            del self._learned[min(self._learned, key=lambda p: self._learned[p][0])]
        self._learned[peer] = (t, self._arrived[peer])

    def peers(self, t: float) -> list[Peer]:
        return [*self._targets, *self._learned]

    def send(self, datagram: bytes, peer: Peer) -> None:
        sock = self._learned[peer][1] if peer in self._learned else self._own
        try:
            sock.sendto(datagram, peer)
        except OSError:
            return  # refused, unreachable or the buffer is full: a datagram may be lost, the vehicle goes on

    def close(self) -> None:
        for sock in self._sockets:
            sock.close()


def _bound(address: Peer) -> socket.socket:
    sock = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    try:
        sock.setblocking(False)
        sock.bind(address)
    except OSError:
        sock.close()
        raise
    return sock
