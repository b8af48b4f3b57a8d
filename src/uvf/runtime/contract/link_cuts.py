"""Radio links that are cut by faults of the mission: between a vehicle and everything that does not run aboard it.

What a vehicle's services say to each other stays aboard, simulators stand for the world itself, and ground stations over MAVLink have a
link of their own.
"""

from collections.abc import Sequence

from schemas.topics import SYSTEM
from uvf.models.mission.faults import LINK, Fault
from uvf.runtime.messages.step_times import NS


class LinkCuts:
    """The cuts as the service of one owner meets them, a vehicle or the system."""

    def __init__(self, owner: str, faults: Sequence[Fault], is_simulator: bool) -> None:
        self._owner = owner
        self._faults = [] if is_simulator else [fault for fault in faults if fault.part == LINK]

    def __bool__(self) -> bool:
        """Whether there is any."""
        return bool(self._faults)

    def cut(self, other: str, t_ns: int) -> bool:
        """Whether nothing goes over to or comes from the vehicle ``other`` at ``t_ns`` [ns, simulation]."""
        if not self._faults or other in (self._owner, SYSTEM):
            return False
        return any(fault.vehicle in (self._owner, other) and fault.holds(t_ns / NS) for fault in self._faults)
