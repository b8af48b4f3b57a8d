"""How often each message goes to whom: default rates, and other ones for peers that asked."""

from collections.abc import Mapping, Sequence

from uvf.mavlink.endpoint import Peer

SHORTEST = 0.02  # s: one step of the service


class Schedule:
    """When each message is due, by message id. Intervals [s]; ``None`` = not sent."""

    def __init__(self, hz: Mapping[int, float]) -> None:
        self._default = {message: 1.0 / rate if rate > 0 else None for message, rate in hz.items()}
        self._own: dict[tuple[int, Peer], float | None] = {}
        self._due: dict[tuple[int, Peer | None], float] = {}

    def interval(self, message: int, peer: Peer) -> float | None:
        """Interval [s] at which a peer gets a message."""
        return self._own.get((message, peer), self._default.get(message))

    def set_interval(self, message: int, peer: Peer, microseconds: float) -> bool:
        """Sets the interval [microseconds] as MAV_CMD_SET_MESSAGE_INTERVAL does: -1 off, 0 default. False for an unknown message."""
        if message not in self._default:
            return False
        self._own.pop((message, peer), None)
        self._due.pop((message, peer), None)
        if microseconds != 0:
            self._own[message, peer] = max(microseconds * 1e-6, SHORTEST) if microseconds > 0 else None
        return True

    def hurry(self, message: int, t: float) -> None:
        """Makes a message due at once, at ``t`` [s, wall], for everybody who gets it."""
        for key in [k for k in self._due if k[0] == message]:
            self._due[key] = t

    def due(self, t: float, peers: Sequence[Peer]) -> list[tuple[int, list[Peer]]]:
        """(message id, who gets it at ``t`` [s, wall]); sets the next due times."""
        own: dict[int, dict[Peer, float | None]] = {}
        for (message, peer), interval in self._own.items():
            own.setdefault(message, {})[peer] = interval
        result = []
        for message, interval in self._default.items():
            special = own.get(message, {})
            to = [p for p in peers if p not in special] if self._is_due((message, None), interval, t) else []
            to += [p for p in peers if p in special and self._is_due((message, p), special[p], t)]
            if to:
                result.append((message, to))
        return result

    def renew(self, peer: Peer) -> None:
        """Restores the default rates for a peer."""
        self._own = {key: interval for key, interval in self._own.items() if key[1] != peer}
        self._due = {key: at for key, at in self._due.items() if key[1] != peer}

    def forget(self, peers: Sequence[Peer]) -> None:
        """Drops the rates of peers that are gone."""
        for gone in {peer for _, peer in self._own if peer not in peers}:
            self.renew(gone)

    def _is_due(self, key: tuple[int, Peer | None], interval: float | None, t: float) -> bool:
        if interval is None:
            return False
        due = self._due.get(key, t)
        if t < due - 1e-9:
            return False
        self._due[key] = due + interval if due + interval > t else t + interval
        return True
