"""All that travels on the bus, watched while some page has the tab Graph open or plots something."""

from collections.abc import Sequence
from typing import NamedTuple, Protocol


class WatchedMessage(NamedTuple):
    """One message of any key.

    age: how long ago it came [s, wall]; boot: which process sent it, 0 if that is not said; stamp: s, simulation.
    """

    key: str
    type_name: str
    payload: bytes
    age: float
    boot: int
    stamp: float = 0.0


class BusWatch(Protocol):
    """Listens to everything between ``start`` and ``stop``; none of its methods waits for the bus, but for ``close``."""

    def start(self) -> None:
        """Begins to listen."""
        ...

    def stop(self) -> None:
        """Ends listening; what has not been taken is dropped."""
        ...

    def samples(self) -> Sequence[WatchedMessage]:
        """Takes the messages that have come since the last call, oldest first."""
        ...

    def tokens(self) -> Sequence[str] | None:
        """Newest list of the liveliness tokens of services and endpoints, without ``uvf/``: another object with each look; None before."""
        ...

    def close(self) -> None:
        """Ends it for good."""
        ...
