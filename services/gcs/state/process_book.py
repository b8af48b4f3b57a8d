"""What runs: as the launchers tell, and as the processes say themselves."""

from collections.abc import Sequence

from schemas.messages import Health, Process, Processes
from services.gcs.state.refusals import PageRefusals
from services.gcs.state.vitals import Vitals

MOST_PROCESSES = 256
FORGOTTEN_AFTER = 60.0  # s, wall


class ProcessBook:
    """The state of all processes; at the limit the longest silent one makes room for a new one, once it has been silent for long."""

    def __init__(self, refused: PageRefusals) -> None:
        self.told: dict[str, Process] = {}
        """As the launchers tell, who say so only when something changes: what has failed stays failed."""
        self.vitals: dict[str, Vitals] = {}
        self._heard_of: dict[str, float] = {}
        """When a launcher or itself last said something of it [s, wall]."""
        self._refused = refused

    def hear(self, t: float, told: Sequence[Processes]) -> None:
        """Takes the launchers' reports at ``t`` [s, wall]; each launcher reports its own processes."""
        for process in (process for message in told for process in message.processes):
            if self._has_room(t, process.name):
                self.told[process.name] = process

    def hear_health(self, t: float, reports: Sequence[Health]) -> None:
        """Takes the processes' own health reports at ``t`` [s, wall]."""
        for report in reports:
            if self._has_room(t, report.service):
                self.vitals.setdefault(report.service, Vitals()).hear(t, report)

    def _has_room(self, t: float, name: str) -> bool:
        if name not in self._heard_of and len(self._heard_of) >= MOST_PROCESSES:
            silent = min(self._heard_of, key=self._heard_of.__getitem__)
            if t - self._heard_of[silent] <= FORGOTTEN_AFTER:
                self._refused.add("processes", name, f"more than {MOST_PROCESSES} processes are told of: not all are listed")
                return False
            del self._heard_of[silent]
            self.told.pop(silent, None)
            self.vitals.pop(silent, None)
        self._heard_of[name] = t
        return True
