"""Instances of services: how each is made, and for whom."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from uvf.models.mission.faults import Fault
from uvf.models.scenario import Scenario
from uvf.runtime.contract.service import Service


@dataclass(frozen=True)
class ServiceInstance:
    """One service instance: how to make it afresh (at start and after each reset), and for which vehicle.

    writes_for: the vehicles about which a service of the whole world writes; faults: of the mission, of which those of links count here.
    """

    service: type[Service]
    make: Callable[[], Service]
    vehicle: str | None = None
    roles: dict[str, str] | None = None
    writes_for: tuple[str, ...] = ()
    faults: tuple[Fault, ...] = ()


class Build(Protocol):
    """``services/<name>/build.py`` holds one: which instances a process of this service hosts."""

    def __call__(self, site: Scenario) -> list[ServiceInstance]:
        """One entry for each instance, in the order of the mission's vehicles."""
