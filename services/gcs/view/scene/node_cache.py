"""Scene nodes kept by what they were made from: what has not changed is the same object again, and is not sent."""

from collections.abc import Callable, Mapping
from typing import Any

from services.gcs.view.drawing import Node

Nodes = dict[str, Node]
Layers = Mapping[str, tuple[str, Callable[[], Nodes]]]
"""By the node that bears it: the layer of the page that something belongs to, and what draws it."""


class NodeCache:
    """Nodes by a name of what they show; what is not asked for between two sweeps is dropped."""

    def __init__(self) -> None:
        self._made: dict[str, tuple[Any, Nodes]] = {}
        self._used: set[str] = set()
        self._due: dict[str, float] = {}

    def make(self, name: str, of: Any, make: Callable[[], Node]) -> Nodes:
        """The node made from ``of`` before, if it is still that; else a new one."""
        return self.make_all(name, of, lambda: {"": make()})

    def make_all(self, name: str, of: Any, make: Callable[[], Nodes]) -> Nodes:
        """The same of several nodes that are made at once."""
        self._used.add(name)
        before = self._made.get(name)
        if before is None or (before[0] is not of and before[0] != of):
            self._made[name] = (of, make())
        return dict(self._made[name][1])

    def make_seldom(self, name: str, of: Any, timing: tuple[float, float], make: Callable[[], Nodes]) -> Nodes:
        """The same, made anew no more often than ``timing``: the time now and the least time between two [s]."""
        t, period = timing
        if name in self._made and t < self._due.get(name, 0.0):
            self._used.add(name)
            return dict(self._made[name][1])
        self._due[name] = t + period
        return self.make_all(name, of, make)

    def sweep(self) -> None:
        """Drops what has not been asked for since the last time."""
        if len(self._made) > len(self._used):
            self._made = {name: made for name, made in self._made.items() if name in self._used}
        self._used = set()
