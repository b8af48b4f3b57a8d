"""Faults of sensors and servos as a mission file lists them: what is lost, frozen or off, from when to when."""

from collections.abc import Mapping, Sequence
from typing import Annotated, Literal

import msgspec
from msgspec import Meta

from uvf.models.keys import key, plain
from uvf.models.vehicle.file import VehicleFile
from uvf.models.yaml_data import BadInput, FileLocation, nearest

Part = Literal[
    "imu",
    "compass",
    "gnss",
    "air_data",
    "pitot",
    "static",
    "battery",
    "scan",
    "other_scans",
    "wheels",
    "left_grip",
    "right_grip",
    "aileron",
    "elevator",
    "rudder",
    "throttle",
    "link",
]
LINK = "link"
"""The radio link between a vehicle and what does not run aboard it: other vehicles, tasks, the page."""
WITHOUT_VALUE = ("scan", "other_scans", "wheels", LINK)
"""Parts of which no single value can be off."""
GRIPS = ("left_grip", "right_grip")
"""How well a wheel holds on to the ground."""
ON_GROUND, IN_THE_AIR = ("wheels", *GRIPS), ("air_data", "pitot", "static", "aileron", "elevator", "rudder", "throttle")
"""Parts that only one kind of vehicle has."""
SENSOR_OF = {
    **{"imu": "imu", "compass": "imu", "gnss": "gnss", "scan": "lidar", "other_scans": "other_lidars", "wheels": "encoders"},
    **dict.fromkeys(("air_data", "pitot", "static"), "air_data"),
}
"""Which sensor of a vehicle's file gives what fails."""
Size = Annotated[float, Meta(ge=-1e6, le=1e6)]
Moment = Annotated[float, Meta(ge=0, le=1e6)]


class Fault(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """lost: nothing comes, or where the part shares its message, zero. frozen: as it was at ``at``. bias: off by ``size``."""

    vehicle: Annotated[str, plain("Vehicle that has the fault.")]
    part: Annotated[Part, plain("Sensor, servo, grip of a wheel or radio link that fails.")]
    kind: Annotated[
        Literal["lost", "frozen", "bias"],
        plain(
            "`lost`: no reading comes, or zero where the part shares its message; a wheel slides as on ice; a vehicle and the "
            "rest of the team and the tasks hear nothing of each other. `frozen`: the reading "
            "of the time `at`. `bias`: off by `size`."
        ),
    ]
    at: Annotated[Moment, key("s", "Simulation time at which the fault begins.")]
    until: Annotated[Moment | None, key("s", "Simulation time at which it ends; left out: never.")] = None
    size: Annotated[
        Size,
        key(
            "unit of the part",
            "Offset of a `bias`: gnss m to the north, imu rad/s of roll rate, compass T ahead, pressures Pa, battery 0 "
            "to 1, surfaces rad, throttle 0 to 1; grips -1 to 0, the share of its friction that a wheel has less.",
        ),
    ] = 0.0

    def holds(self, t: float) -> bool:
        """Whether the fault is active at simulation time ``t`` [s]."""
        return self.at <= t and (self.until is None or t < self.until)


def check_faults(faults: Sequence[Fault], vehicles: Mapping[str, object], duration: float, place: FileLocation) -> None:
    """Checks a mission's faults against its vehicles and its duration [s]. Raises BadInput."""
    for i, fault in enumerate(faults):
        if fault.vehicle not in vehicles:
            raise BadInput(f"{place.at(i, 'vehicle')}: no vehicle '{fault.vehicle}'; {nearest(fault.vehicle, vehicles)}")
        if fault.until is not None and fault.until <= fault.at:
            raise BadInput(f"{place.at(i, 'until')}: {fault.until:g} s is not after at, {fault.at:g} s")
        if fault.at >= duration:
            raise BadInput(f"{place.at(i, 'at')}: {fault.at:g} s is after the end, {duration:g} s; make it or 'duration' another")
        if fault.part in GRIPS and (fault.kind == "frozen" or not -1.0 <= fault.size <= 0.0):
            raise BadInput(f"{place.at(i)}: a {fault.part} may be lost, or have a bias from -1 to 0")
        if fault.part == LINK and fault.kind != "lost":
            raise BadInput(f"{place.at(i, 'kind')}: a link may be lost, and come back at 'until'")
        if fault.kind == "bias" and fault.part in WITHOUT_VALUE:
            raise BadInput(f"{place.at(i, 'kind')}: {fault.part} takes no bias; it may be lost or frozen")
        if fault.kind == "bias" and fault.size == 0:
            raise BadInput(f"{place.at(i)}: a bias needs a size")


def check_parts(faults: Sequence[Fault], files: Mapping[str, VehicleFile], place: FileLocation) -> None:
    """Checks that vehicles have the parts that fail; files: of each vehicle. Raises BadInput."""
    for i, fault in enumerate(faults):
        file, here = files[fault.vehicle], place.at(i, "part")
        if fault.part in (IN_THE_AIR if file.kind == "ground" else ON_GROUND):
            raise BadInput(f"{here}: {fault.vehicle} has no {fault.part}; it is a {file.kind} vehicle")
        sensor = SENSOR_OF.get(fault.part)
        if sensor is not None and not getattr(file.sensors, sensor):
            raise BadInput(f"{here}: {fault.vehicle} has no {fault.part}: there is no {sensor} among the sensors of its vehicle.yaml")
        if fault.part == "battery" and not file.has_battery:
            raise BadInput(f"{here}: {fault.vehicle} has no battery; give its vehicle.yaml one")
