"""Message signing (MAVLink guide, "Message Signing"): who signs with which key, what is believed, what is refused."""

import hashlib
import hmac
from collections.abc import Collection
from dataclasses import dataclass
from enum import Enum
from functools import partial

from services.autopilot.mavlink.connection.key_store import MOST_KEYS, KeyStore
from services.autopilot.mavlink.connection.line import Sender
from uvf.mavlink import dialect as mav
from uvf.mavlink.endpoint import Peer
from uvf.mavlink.framing import SIGNED, Sign
from uvf.runtime.bus.address import is_loopback

BLOCK = mav.MAVLINK_SIGNATURE_BLOCK_LEN
HASH_BYTES = 6
LINK_ID = 0
PER_SECOND = 100_000  # timestamps count 10 us
BEGINNING = 1_420_070_400  # 2015-01-01 UTC, Unix time [s]
LATEST = 2**47  # in the year 2059; a timestamp has 48 bits
OLDEST = 60 * PER_SECOND
MOST_STREAMS = 512
ALWAYS_HEARD = (mav.MAVLINK_MSG_ID_HEARTBEAT, mav.MAVLINK_MSG_ID_RADIO_STATUS)
NO_KEY = bytes(32)
NOT_SIGNED = "Unsigned message refused: this link is signed"
NOT_SIGNED_ELSEWHERE = "Unsigned message refused: signing is required from other machines"


class SignatureVerdict(Enum):
    """SIGNED: by one of our keys, and new; UNSIGNED: accepted without a signature; REPLAYED or REFUSED: rejected."""

    SIGNED = "signed"
    UNSIGNED = "unsigned"
    REPLAYED = "replayed or too old"
    REFUSED = "refused"


@dataclass
class SignatureCounts:
    """Number of messages by verdict."""

    good: int = 0
    replayed: int = 0
    refused: int = 0


class Signing:
    """Signs and checks messages. Each peer (link) has a key or none; keys are stored, so that a peer is known again after a restart.

    started: Unix time [s] at t = 0; required: unsigned messages from other machines are refused, but heartbeats.
    Raises ValueError when the file of keys is broken.
    """

    def __init__(self, store: KeyStore | None = None, started: float = BEGINNING, required: bool = False) -> None:
        self.counts = SignatureCounts()
        self._store = store or KeyStore()
        self._started = started
        self._required = required
        self._keys, newest = self._store.load()
        self._by_peer: dict[Peer, bytes] = {}
        self._last = newest
        """The newest timestamp given or believed."""
        self._streams: dict[tuple[bytes, int, int, int], int] = {}
        """(key, link id, system, component) -> newest timestamp: a packet counts once, whatever address repeats it."""

    def check(self, t: float, message: mav.MAVLink_message, sender: Sender) -> SignatureVerdict:
        """Whether a message is accepted at ``t`` [s] since the link's start.

        A peer that signs with one of our keys is signed to from then on.
        """
        verdict = self._look(t, bytes(message.get_msgbuf()), sender)
        if verdict is SignatureVerdict.UNSIGNED and self._has_to_sign(sender.peer) and message.get_msgId() not in ALWAYS_HEARD:
            verdict = SignatureVerdict.REFUSED
        self.counts.good += verdict is SignatureVerdict.SIGNED
        self.counts.replayed += verdict is SignatureVerdict.REPLAYED
        self.counts.refused += verdict is SignatureVerdict.REFUSED
        return verdict

    def why_refused(self, peer: Peer) -> str:
        """Why an unsigned message of this peer is refused."""
        return NOT_SIGNED if peer in self._by_peer else NOT_SIGNED_ELSEWHERE

    def setup(self, message: mav.MAVLink_setup_signing_message, sender: Sender, verdict: SignatureVerdict, armed: bool) -> str:
        """Handles SETUP_SIGNING for a vehicle that is ``armed`` or not; returns the text to report, "" for a repetition."""
        key = bytes(message.secret_key)
        if verdict is not SignatureVerdict.SIGNED and not is_loopback(sender.peer[0]):
            return "Signing refused: it is set up from this machine, or over a link that is signed"
        if verdict is SignatureVerdict.REPLAYED:
            return "Signing refused: the message has been heard before"
        if self._by_peer.get(sender.peer, NO_KEY) == key:
            return ""
        if armed:
            return "Signing refused: disarm first"
        if key == NO_KEY:
            return self._disable(sender.peer)
        if message.initial_timestamp > LATEST:
            return "Signing refused: the timestamp lies in the far future"
        if not self._has_room(key):
            return f"Signing refused: {MOST_KEYS} keys are in use already"
        self._by_peer[sender.peer] = key
        self._keys = [key, *(k for k in self._keys if k != key)]
        self._last = max(self._last, message.initial_timestamp)
        return "This link is signed from now on" + self._keep()

    def signer(self, t: float, peer: Peer) -> Sign | None:
        """The function that signs packets to a peer at ``t`` [s, since the link's start]; None where nothing is signed."""
        key = self._by_peer.get(peer)
        return partial(self._sign, t, key) if key is not None else None

    def _has_room(self, key: bytes) -> bool:
        """Beyond the most that are kept the oldest that no link uses is given up."""
        if key in self._keys or len(self._keys) < MOST_KEYS:
            return True
        used = set(self._by_peer.values())
        idle = next((k for k in reversed(self._keys) if k not in used), None)
        if idle is not None:
            self._keys.remove(idle)
        return idle is not None

    def forget_all_but(self, peers: Collection[Peer]) -> None:
        """Drops the keys of peers that are gone."""
        self._by_peer = {peer: key for peer, key in self._by_peer.items() if peer in peers}

    def forget(self, peer: Peer) -> None:
        """Drops a peer's key at the end of a connection: whoever comes next signs, or does not."""
        self._by_peer.pop(peer, None)

    def _sign(self, t: float, key: bytes, packet: bytes) -> bytes:
        now = round((self._started - BEGINNING + t) * PER_SECOND)
        self._last = max(now, self._last + 1)
        stamped = bytes((LINK_ID,)) + self._last.to_bytes(6, "little")
        return stamped + _digest(key, packet + stamped)

    def _has_to_sign(self, peer: Peer) -> bool:
        return peer in self._by_peer or (self._required and not is_loopback(peer[0]))

    def _look(self, t: float, packet: bytes, sender: Sender) -> SignatureVerdict:
        """A signature by a key that is not ours says nothing, and counts as none."""
        if packet[0] != mav.PROTOCOL_MARKER_V2 or not packet[2] & SIGNED:
            return SignatureVerdict.UNSIGNED
        first = self._by_peer.get(sender.peer, b"")
        key = next((k for k in sorted(self._keys, key=lambda k: k != first) if _matches(k, packet)), None)
        if key is None:
            return SignatureVerdict.UNSIGNED
        if not self._is_new(t, key, packet, sender):
            return SignatureVerdict.REPLAYED
        self._by_peer[sender.peer] = key
        return SignatureVerdict.SIGNED

    def _is_new(self, t: float, key: bytes, packet: bytes, sender: Sender) -> bool:
        """Later than all before of its stream; the first of one at most a minute behind us."""
        link, timestamp = packet[-BLOCK], int.from_bytes(packet[-BLOCK + 1 : -HASH_BYTES], "little")
        stream = (key, link, sender.system, sender.component)
        now = max(self._last, round((self._started - BEGINNING + t) * PER_SECOND))
        if not self._streams.get(stream, now - OLDEST - 1) < timestamp <= LATEST or not self._may_begin(stream, now):
            return False
        self._streams[stream] = timestamp
        self._last = max(self._last, timestamp)
        return True

    def _may_begin(self, stream: tuple[bytes, int, int, int], now: int) -> bool:
        """Streams of more than a minute ago are forgotten without loss: what they repeat is too old. A younger one never is."""
        if stream not in self._streams and len(self._streams) >= MOST_STREAMS:
            self._streams = {known: newest for known, newest in self._streams.items() if newest >= now - OLDEST}
        return stream in self._streams or len(self._streams) < MOST_STREAMS

    def _disable(self, peer: Peer) -> str:
        """The key of this link is given up everywhere."""
        key = self._by_peer.get(peer)
        if key is None:
            return ""
        self._by_peer = {p: k for p, k in self._by_peer.items() if k != key}
        self._keys.remove(key)
        self._streams = {stream: newest for stream, newest in self._streams.items() if stream[0] != key}
        return "This link is no longer signed" + self._keep()

    def _keep(self) -> str:
        try:
            self._store.save(self._keys, self._last)
        except OSError as error:
            return f", until UVF ends: the key cannot be kept ({error.strerror})"
        return ""


def _digest(key: bytes, signed: bytes) -> bytes:
    return hashlib.sha256(key + signed).digest()[:HASH_BYTES]


def _matches(key: bytes, packet: bytes) -> bool:
    return hmac.compare_digest(packet[-HASH_BYTES:], _digest(key, packet[:-HASH_BYTES]))
