"""UDP to ground stations: the vehicle speaks first to configured peers, and answers whoever else calls."""

import math
import socket
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from uvf.mavlink.bounded import make_room

Peer = tuple[str, int]
"""Address and port of a ground station."""

FORGET_AFTER = 60.0  # s of silence, learned peers only
MOST_LEARNED = 32
CROWD = 8  # callers of one host, beyond which its others count less
ENGAGED_FOR = 2.0  # s since the last word of a transfer, or of sticks
AT_HOME_AFTER = 5.0  # s, after which a caller outranks those that come later
SPEAKS_WITHIN = 3.0  # s: three heartbeats
DATAGRAM_BYTES = 65536
DATAGRAMS_PER_CALL = 500


class DatagramLink(Protocol):
    """Datagrams from and to peers."""

    @property
    def port(self) -> int:
        """Port from which this end speaks first."""

    def receive(self, t: float) -> list[tuple[bytes, Peer]]:
        """All datagrams that have arrived, without waiting; ``t`` [s] is now."""

    def peers(self, t: float) -> list[Peer]:
        """Peers that broadcasts go to at ``t`` [s]."""

    def keep(self, t: float, peer: Peer, engaged: bool = False) -> None:
        """Keeps a peer that has sent something valid in the last call: it is sent broadcasts while it speaks now and then.

        t: [s], now; engaged: it transfers something, or steers.
        """

    def send(self, datagram: bytes, peer: Peer) -> None:
        """Sends a datagram to a peer."""
        ...

    def close(self) -> None:
        """Closes the link."""
        ...


@dataclass
class Caller:
    """Times [s] of a peer: since when it has spoken, when it was heard last, and when it last transferred something or steered."""

    since: float
    heard: float
    engaged: float = -math.inf

    def hear(self, t: float) -> None:
        """Notes that the peer has spoken at ``t`` [s]; after a silence it counts as a newcomer."""
        if t - self.heard > SPEAKS_WITHIN:
            self.since = t
        self.heard = t

    def rank(self, t: float, is_in_crowd: bool) -> tuple[bool, bool, bool, float]:
        """Sort key at ``t`` [s]; the lowest is dropped first.

        Who has spoken for a while counts more than newcomers, however often these speak, and the longer the more.
        """
        at_home = self.heard - self.since > AT_HOME_AFTER and t - self.heard <= SPEAKS_WITHIN
        return at_home, not is_in_crowd, t - self.engaged <= ENGAGED_FOR, -self.since if at_home else self.heard


class Callers:
    """Peers that have called and are heard now and then: never more than a few, however many strangers there are."""

    def __init__(self) -> None:
        self._heard: dict[Peer, Caller] = {}

    def keep(self, t: float, peer: Peer, engaged: bool = False) -> None:
        """Adds or refreshes a peer at ``t`` [s]; where there are too many, the lowest in rank makes room.

        That is a newcomer, or one that has fallen silent, first of a host with many. One that transfers or steers (``engaged``) goes after
        its equals.
        """
        hosts = Counter(host for host, _ in self._heard) if peer not in self._heard else Counter[str]()
        make_room(self._heard, peer, MOST_LEARNED, lambda p: self._heard[p].rank(t, hosts[p[0]] > CROWD))
        caller = self._heard.setdefault(peer, Caller(t, t))
        caller.hear(t)
        if engaged:
            caller.engaged = t

    def peers(self, t: float) -> list[Peer]:
        """Peers that are kept at ``t`` [s]; those silent for ``FORGET_AFTER`` seconds are forgotten."""
        self._heard = {peer: caller for peer, caller in self._heard.items() if t - caller.heard <= FORGET_AFTER}
        return list(self._heard)


class UdpLink:
    """One socket to speak from and perhaps one with a known port to be called at.

    targets: numeric addresses that are always sent broadcasts; listen: where others may call, port 0 = any free one.
    Raises OSError when ``listen`` is taken.
    """

    def __init__(self, targets: Sequence[Peer], listen: Peer | None = None) -> None:
        self._targets = list(dict.fromkeys(targets))
        loopback = all(host.startswith("127.") for host, _ in self._targets)
        self._own = _bound(("127.0.0.1" if loopback else "0.0.0.0", 0))
        self._sockets = [self._own]
        self._callers = Callers()
        self._called_at: dict[Peer, socket.socket] = {}
        """Where the callers, and whoever else has sent something in the last call, have come in."""
        if listen is not None:
            try:
                self._sockets.append(_bound(listen))
            except OSError:
                self._own.close()
                raise

    @property
    def port(self) -> int:
        """Port of the socket that speaks first."""
        return int(self._own.getsockname()[1])

    @property
    def addresses(self) -> list[Peer]:
        """Addresses where this end can be reached: the speaking socket first."""
        return [sock.getsockname() for sock in self._sockets]

    def receive(self, t: float) -> list[tuple[bytes, Peer]]:
        """All datagrams that have arrived at either socket, at most ``DATAGRAMS_PER_CALL`` of each; ``t`` [s] is now."""
        callers = self._callers.peers(t)
        self._called_at = {peer: sock for peer, sock in self._called_at.items() if peer in callers}
        return [(data, peer) for sock in self._sockets for data, peer in self._drain(sock)]

    def _drain(self, sock: socket.socket) -> list[tuple[bytes, Peer]]:
        arrived: list[tuple[bytes, Peer]] = []
        for _ in range(DATAGRAMS_PER_CALL):
            try:
                data, peer = sock.recvfrom(DATAGRAM_BYTES)
            except BlockingIOError:
                break
            except OSError:
                continue  # "connection refused" of an earlier datagram: nobody listens there yet
            self._called_at[peer] = sock
            arrived.append((data, peer))
        return arrived

    def keep(self, t: float, peer: Peer, engaged: bool = False) -> None:
        """Keeps a peer at ``t`` [s] as a caller, unless it is a target, which is always kept."""
        if peer not in self._targets:
            self._callers.keep(t, peer, engaged)

    def peers(self, t: float) -> list[Peer]:
        """The targets, then the callers kept at ``t`` [s]."""
        return [*self._targets, *self._callers.peers(t)]

    def send(self, datagram: bytes, peer: Peer) -> None:
        """Sends from the socket at which the peer has called; targets always hear the socket that speaks first. Errors are ignored."""
        sock = self._own if peer in self._targets else self._called_at.get(peer, self._own)
        try:
            sock.sendto(datagram, peer)
        except OSError:
            return  # refused, unreachable or the buffer is full: a datagram may be lost, the vehicle goes on

    def close(self) -> None:
        """Closes the sockets."""
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
