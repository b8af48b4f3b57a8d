"""Vehicles that no mission names: since when they are shown, and whom the page does not show."""

from collections.abc import Mapping
from typing import NamedTuple

from google.protobuf.message import Message

from schemas.messages import Guest
from uvf.runtime.contract.inbox import OWNERS_MOST

FORGOTTEN_AFTER = 60.0  # s, wall: who has been lost for so long makes room for others


class Forgotten(NamedTuple):
    """What had last been heard of it: its word of itself stays on the bus for ever, and is no sign that it is there."""

    guest: Guest
    signs: Mapping[str, Message | None]


class Guests:
    """Remembers as many names that are not shown as there can be on an input: each is looked at once."""

    def __init__(self) -> None:
        self.met: dict[str, tuple[float, Guest]] = {}
        """Those that are shown: when they were met [s, wall], and by which word."""
        self._undrawable: dict[str, str] = {}
        """The model that they name, which this host has not."""
        self._forgotten: dict[str, Forgotten] = {}

    def is_away(self, name: str, guest: Guest) -> bool:
        """Turned away or forgotten, and there is nothing new of it since."""
        before = self._forgotten.get(name)
        return self._undrawable.get(name) == guest.model or (before is not None and before.guest is guest)

    def turn_away(self, name: str, model: str) -> bool:
        """Because of its model; whether it is the first time."""
        new = name not in self._undrawable
        self._undrawable[name] = model
        _trim(self._undrawable)
        return new

    def take_in(self, t: float, name: str, guest: Guest) -> None:
        self.met[name] = (t, guest)
        self._undrawable.pop(name, None)
        self._forgotten.pop(name, None)

    def forget(self, name: str, signs: Mapping[str, Message | None]) -> None:
        """signs: the newest of each kind by which one hears that it is there."""
        self._forgotten[name] = Forgotten(self.met.pop(name)[1], signs)
        _trim(self._forgotten)

    def hear(self, what: str, name: str, message: Message) -> None:
        """Of somebody who is not shown: who speaks again is forgotten no more."""
        before = self._forgotten.get(name)
        if before is not None and what in before.signs and before.signs[what] is not message:
            del self._forgotten[name]


def _trim(names: dict[str, str] | dict[str, Forgotten]) -> None:
    if len(names) > OWNERS_MOST:
        names.pop(next(iter(names)))
