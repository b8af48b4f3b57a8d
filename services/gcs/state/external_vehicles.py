"""Vehicles that no mission names: since when they are shown, and whom the page does not show."""

from collections.abc import Mapping
from typing import NamedTuple

from google.protobuf.message import Message

from schemas.messages import ExternalVehicle
from uvf.runtime.contract.inbox import OWNERS_MOST

FORGOTTEN_AFTER = 60.0  # s, wall: who has been lost for so long makes room for others


class Forgotten(NamedTuple):
    """What was last heard of a forgotten external vehicle: its latched announcement stays on the bus for ever, and is no sign of life."""

    external: ExternalVehicle
    signs: Mapping[str, Message | None]


class ExternalVehicles:
    """Vehicles that no mission names: those shown, and those turned away or forgotten."""

    def __init__(self) -> None:
        self.met: dict[str, tuple[float, ExternalVehicle]] = {}
        """Those that are shown: when they were met [s, wall], and by which word."""
        self._undrawable: dict[str, str] = {}
        """The model that they name, which this host has not."""
        self._forgotten: dict[str, Forgotten] = {}

    def is_away(self, name: str, external: ExternalVehicle) -> bool:
        """Whether it was turned away or forgotten, and there is nothing new of it since."""
        before = self._forgotten.get(name)
        return self._undrawable.get(name) == external.model or (before is not None and before.external is external)

    def turn_away(self, name: str, model: str) -> bool:
        """Does not show a vehicle because of its model; returns whether that is the first time."""
        new = name not in self._undrawable
        self._undrawable[name] = model
        _trim(self._undrawable)
        return new

    def take_in(self, t: float, name: str, external: ExternalVehicle) -> None:
        """Notes an external vehicle that is shown from ``t`` [s, wall] on."""
        self.met[name] = (t, external)
        self._undrawable.pop(name, None)
        self._forgotten.pop(name, None)

    def forget(self, name: str, signs: Mapping[str, Message | None]) -> None:
        """Drops an external vehicle. signs: its newest message of each kind that is a sign of life."""
        self._forgotten[name] = Forgotten(self.met.pop(name)[1], signs)
        _trim(self._forgotten)

    def hear(self, what: str, name: str, message: Message) -> None:
        """Takes a message of a vehicle that is not shown: one that speaks again is no longer forgotten."""
        before = self._forgotten.get(name)
        if before is not None and what in before.signs and before.signs[what] is not message:
            del self._forgotten[name]


def _trim(names: dict[str, str] | dict[str, Forgotten]) -> None:
    if len(names) > OWNERS_MOST:
        names.pop(next(iter(names)))
