"""What the services of a run wait for, told in the terminal."""

import time
from collections.abc import Callable, Collection

from launch.launcher import Say
from schemas.messages import Health

PATIENCE = 5.0  # s, wall: at the start everybody waits a little


class Waits:
    """Reports once each input that has been missing for ``PATIENCE``, and its arrival after all."""

    def __init__(self, say: Say, processes: Collection[str], clock: Callable[[], float] = time.monotonic) -> None:
        """processes: whose reports count; anybody may send others."""
        self._say = say
        self._processes = frozenset(processes)
        self._clock = clock
        self._since: dict[tuple[str, str], float] = {}
        self._told: set[tuple[str, str]] = set()

    def hear(self, health: Health) -> None:
        """Takes a health message, whose ``missing`` holds 'service:input'."""
        if health.service not in self._processes:
            return
        now = self._clock()
        missing = {(health.service, name) for name in health.missing}
        for gone in [key for key in self._since if key[0] == health.service and key not in missing]:
            del self._since[gone]
            if gone in self._told:
                self._told.discard(gone)
                self._say(f"{_who(gone)} is there")
        for key in sorted(missing):
            if now - self._since.setdefault(key, now) > PATIENCE and key not in self._told:
                self._told.add(key)
                self._say(f"{_who(key)} has not come for {PATIENCE:.0f} s; 'uvf check' finds what nobody writes")


def _who(key: tuple[str, str]) -> str:
    service, _, wanted = key[1].partition(":")
    return f"{service}: input '{wanted}'"
