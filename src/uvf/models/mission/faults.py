"""Faults of sensors and servos as a mission file lists them: what is lost, frozen or off, from when to when."""

from collections.abc import Mapping, Sequence
from typing import Annotated, Literal

import msgspec
from msgspec import Meta

from uvf.models.keys import key, plain
from uvf.models.yaml_data import BadInput, FileLocation

Part = Literal[
    "imu", "compass", "gnss", "air_data", "pitot", "static", "battery", "scan", "wheels", "aileron", "elevator", "rudder", "throttle"
]
WITHOUT_VALUE = ("scan", "wheels")
"""Parts of which no single value can be off."""
Size = Annotated[float, Meta(ge=-1e6, le=1e6)]
Moment = Annotated[float, Meta(ge=0, le=1e6)]


class Fault(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """lost: nothing comes, or where the part shares its message, zero. frozen: as it was at ``at``. bias: off by ``size``."""

    vehicle: Annotated[str, plain("Vehicle that has the fault.")]
    part: Annotated[Part, plain("Sensor or servo that fails.")]
    kind: Annotated[
        Literal["lost", "frozen", "bias"],
        plain(
            "`lost`: no reading comes, or zero where the part shares its message. `frozen`: the reading of the time "
            "`at`. `bias`: off by `size`."
        ),
    ]
    at: Annotated[Moment, key("s", "Simulation time at which the fault begins.")]
    until: Annotated[Moment | None, key("s", "Simulation time at which it ends; left out: never.")] = None
    size: Annotated[
        Size,
        key(
            "unit of the part",
            "Offset of a `bias`: gnss m to the north, imu rad/s of roll rate, compass T ahead, pressures Pa, battery 0 "
            "to 1, surfaces rad, throttle 0 to 1.",
        ),
    ] = 0.0

    def holds(self, t: float) -> bool:
        """Whether the fault is active at simulation time ``t`` [s]."""
        return self.at <= t and (self.until is None or t < self.until)


def check_faults(faults: Sequence[Fault], vehicles: Mapping[str, object], place: FileLocation) -> None:
    """Checks a mission's faults against its vehicles. Raises BadInput."""
    for i, fault in enumerate(faults):
        if fault.vehicle not in vehicles:
            raise BadInput(f"{place.at(i, 'vehicle')}: no vehicle '{fault.vehicle}'; there are: {', '.join(sorted(vehicles))}")
        if fault.until is not None and fault.until <= fault.at:
            raise BadInput(f"{place.at(i, 'until')}: {fault.until:g} s is not after at, {fault.at:g} s")
        if fault.kind == "bias" and fault.part in WITHOUT_VALUE:
            raise BadInput(f"{place.at(i, 'kind')}: {fault.part} takes no bias; it may be lost or frozen")
        if fault.kind == "bias" and fault.size == 0:
            raise BadInput(f"{place.at(i)}: a bias needs a size")
