"""Which systems speak through each peer, and when a connection begins: with the first word, or the first after a silence."""

from collections.abc import Collection
from typing import NamedTuple

from services.autopilot.mavlink.connection.line import Sender
from uvf.mavlink.bounded import make_room
from uvf.mavlink.endpoint import Peer

CONNECTION_ENDS = 10.0  # s, wall, without a word: ten heartbeats
MOST_BEHIND_ONE = 32  # systems and components behind one address


class PeerNews(NamedTuple):
    """What is new. connection: nobody was there at this peer; system: this system was not."""

    connection: bool
    system: bool


class Peers:
    """Who speaks through each peer: a router may forward several systems at one address, a ground station may restart at the same one."""

    def __init__(self) -> None:
        self._heard: dict[Peer, dict[tuple[int, int], float]] = {}
        """Peer -> (system, component) -> when [s]."""

    def __len__(self) -> int:
        return sum(map(len, self._heard.values()))

    def hear(self, t: float, sender: Sender) -> PeerNews:
        """Notes a message at ``t`` [s, wall]: are its peer and its system new?"""
        there, who = self._heard.setdefault(sender.peer, {}), (sender.system, sender.component)
        before = self.systems(t, sender.peer)
        make_room(there, who, MOST_BEHIND_ONE, lambda other: there[other])
        there[who] = t
        return PeerNews(connection=not before, system=sender.system not in before)

    def systems(self, t: float, peer: Peer) -> set[int]:
        """The system ids heard through a peer within ``CONNECTION_ENDS`` before ``t`` [s, wall]."""
        return {system for (system, _), heard in self._heard.get(peer, {}).items() if t - heard <= CONNECTION_ENDS}

    def forget(self, t: float, known: Collection[Peer]) -> None:
        """Drops peers that are not in ``known`` or silent at ``t`` [s, wall]: callers from ever new addresses leave nothing behind."""
        for peer in [peer for peer in self._heard if peer not in known or not self.systems(t, peer)]:
            del self._heard[peer]
