"""The bridge's end of a link: which autopilots are heard there, and each one's messages for the vehicle that it is."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass, field
from typing import Any

from uvf.mavlink import dialect as mav
from uvf.mavlink.codec import Codec
from uvf.mavlink.endpoint import DatagramLink, Peer

SYSTEM, COMPONENT = 255, mav.MAV_COMP_ID_UDP_BRIDGE
"""Who the bridge is on the link: a ground station, as far as the autopilot's failsafes are concerned."""
LOST_AFTER = 3.5  # s without a heartbeat, as QGroundControl has it
HEARTBEAT_PERIOD = 1.0  # s
INBOX_MOST = 2000
"""Messages of one autopilot that nobody has fetched: what is older is dropped."""
AUTOPILOTS_MOST = 32
"""At one address, beside those that are named by their ids."""
RIVALS_MOST = 8


NO_VEHICLES = {
    mav.MAV_TYPE_GCS,
    mav.MAV_TYPE_ANTENNA_TRACKER,
    mav.MAV_TYPE_ONBOARD_CONTROLLER,
    mav.MAV_TYPE_GIMBAL,
    mav.MAV_TYPE_ADSB,
    *range(mav.MAV_TYPE_CAMERA, mav.MAV_TYPE_SERVO + 1),
    mav.MAV_TYPE_ODID,
    *range(mav.MAV_TYPE_BATTERY, mav.MAV_TYPE_WINCH + 1),
}
"""Types of what flies or drives nothing, whatever autopilot its heartbeat names."""


@dataclass
class HeardAutopilot:
    """An autopilot heard at the address; its system id may be reused once it has been silent."""

    system: int
    component: int
    peer: Peer
    heartbeat: mav.MAVLink_heartbeat_message
    heard_at: float
    since: float
    inbox: list[mav.MAVLink_message] = field(default_factory=list)
    rivals: set[Peer] = field(default_factory=set)
    """Other addresses that have used its id meanwhile."""

    @property
    def identity(self) -> tuple[int, int, int]:
        """Component, firmware and type: where they differ it is another autopilot, whose numbers mean something else."""
        return self.component, self.heartbeat.autopilot, self.heartbeat.type

    def is_lost(self, t: float) -> bool:
        """Whether no heartbeat has come within ``LOST_AFTER`` before ``t`` [s, wall]."""
        return t - self.heard_at > LOST_AFTER


class Station:
    """The bridge's end of a link, shared by all vehicles at one address."""

    def __init__(self, link: DatagramLink) -> None:
        self.autopilots: dict[int, HeardAutopilot] = {}
        """By system id."""
        self.expected: frozenset[int] = frozenset()
        """Ids that are taken however many others there are."""
        self._refused: set[int] = set()
        self._unsendable: set[str] = set()
        """Kinds of messages that did not fit into their fields."""
        self._untold: list[str] = []
        self._link = link
        self._codec = Codec(COMPONENT)
        self._last_heartbeat = -HEARTBEAT_PERIOD

    def poll(self, t: float, own: Collection[int] = ()) -> list[str]:
        """Receives what has arrived until ``t`` [s, wall] and sends heartbeats; returns lines to be reported.

        own: ports from which this bus's own vehicles speak; they are on it already.
        """
        told: list[str] = []
        for datagram, peer in self._link.receive(t):
            if peer[1] in own:
                continue
            for message in self._codec.parse(datagram):
                told += self._take(t, message, peer)
            if any(known.peer == peer for known in self.autopilots.values()):
                self._link.keep(t, peer)
        if t - self._last_heartbeat >= HEARTBEAT_PERIOD:
            self._last_heartbeat = t
            hello = mav.MAVLink_heartbeat_message(mav.MAV_TYPE_GCS, mav.MAV_AUTOPILOT_INVALID, 0, 0, mav.MAV_STATE_ACTIVE, 3)
            peers = self._link.peers(t)
            self._codec.forget([*peers, *(known.peer for known in self.autopilots.values())])
            self._send(hello, peers)
        untold, self._untold = self._untold, []
        return told + untold

    def _take(self, t: float, message: mav.MAVLink_message, peer: Peer) -> list[str]:
        system, component = message.get_srcSystem(), message.get_srcComponent()
        is_heartbeat = message.get_msgId() == mav.MAVLINK_MSG_ID_HEARTBEAT
        known = self.autopilots.get(system)
        if is_heartbeat and known is None and is_autopilot(message) and system not in (0, SYSTEM):
            if len(self.autopilots) >= AUTOPILOTS_MOST and system not in self.expected:
                return self._refuse(system)
            known = self.autopilots[system] = HeardAutopilot(system, component, peer, message, t, t)  # type: ignore[arg-type]
        is_other = known is not None and component != known.component
        replaces = is_heartbeat and is_autopilot(message) and (component == mav.MAV_COMP_ID_AUTOPILOT1 or (known and known.is_lost(t)))
        if known is None or (is_other and not replaces):
            return []
        if peer != known.peer and not known.is_lost(t):
            first = peer not in known.rivals and len(known.rivals) < RIVALS_MOST
            known.rivals |= {peer} if first else set()
            return [f"system {system} speaks from {_text(peer)} too; only {_text(known.peer)} counts: give one another id"] if first else []
        if is_heartbeat and is_autopilot(message):
            before = known.identity
            known.component, known.peer, known.heartbeat, known.heard_at = component, peer, message, t  # type: ignore[assignment]
            known.rivals.discard(peer)
            if known.identity != before:
                known.inbox.clear()
        if peer == known.peer:
            known.inbox.append(message)
            del known.inbox[:-INBOX_MOST]
        return []

    def _refuse(self, system: int) -> list[str]:
        """Told once for all of them; there are no more than ids."""
        self._refused.add(system)
        if len(self._refused) > 1:
            return []
        mend = f"name it by --name NAME={system}"
        return [f"system {system} is left alone, as all others that come: {AUTOPILOTS_MOST} are at one address; {mend}"]

    def forget(self, system: int) -> None:
        """Drops a system that is not to be a vehicle of this bus."""
        del self.autopilots[system]

    def fetch(self, system: int) -> list[mav.MAVLink_message]:
        """Takes the messages of an autopilot since the last call."""
        taken = self.autopilots[system].inbox
        self.autopilots[system].inbox = []
        return taken

    def send(self, system: int, messages: Sequence[mav.MAVLink_message]) -> None:
        """Sends to an autopilot, where it was heard last."""
        for message in messages:
            self._send(message, [self.autopilots[system].peer])

    def _send(self, message: mav.MAVLink_message, peers: Sequence[Peer]) -> None:
        unsendable = self._codec.counts.unsendable
        for packet, peer in self._codec.packets(SYSTEM, message, [(peer, None) for peer in peers]):
            self._link.send(packet, peer)
        if self._codec.counts.unsendable > unsendable and message.get_type() not in self._unsendable:
            self._unsendable.add(message.get_type())
            self._untold.append(f"{message.get_type()} is not sent: a number does not fit its field")

    def close(self) -> None:
        """Closes the link."""
        self._link.close()


def is_autopilot(message: Any) -> bool:
    """Whether a heartbeat is that of a vehicle, and not of a camera, a gimbal or a ground station."""
    return bool(message.autopilot != mav.MAV_AUTOPILOT_INVALID and message.type not in NO_VEHICLES)


def _text(peer: Peer) -> str:
    return f"{peer[0]}:{peer[1]}"
