"""Faults of sensors and servos, put into the messages at the simulator's border: every reader meets them as it would meet real ones."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from google.protobuf.message import Message

from uvf.models.mission.faults import GRIPS, Fault
from uvf.runtime.messages.outputs import Value

EARTH_RADIUS = 6.371e6  # m


@dataclass(frozen=True)
class Where:
    """Fields of a message that a fault concerns; the first one takes a bias, times ``scale``, if there is one.

    whole: the message is about this alone.
    """

    output: str
    fields: tuple[str, ...] = ()
    scale: float = 1.0
    whole: bool = False


AIR = ("static_pressure", "differential_pressure")
FIELD = ("magnetic_field.x", "magnetic_field.y", "magnetic_field.z")
INERTIAL = ("angular_velocity.x", "angular_velocity.y", "angular_velocity.z", "specific_force.x", "specific_force.y", "specific_force.z")
PARTS: dict[str, Where] = {
    "imu": Where("imu", (*INERTIAL, *FIELD), whole=True),
    "compass": Where("imu", FIELD),
    "gnss": Where("gnss", ("latitude",), 1 / EARTH_RADIUS, whole=True),
    "air_data": Where("air_data", AIR, whole=True),
    "static": Where("air_data", AIR[:1]),
    "pitot": Where("air_data", AIR[1:]),
    "battery": Where("battery", ("remaining",), whole=True),
    "scan": Where("scan", whole=True),
    "other_scans": Where("other_scans", whole=True),
    "wheels": Where("wheels", whole=True),
    **{name: Where("surfaces", (name,)) for name in ("aileron", "elevator", "rudder", "throttle")},
}


@dataclass
class Faults:
    """Faults of a run, with the messages that frozen parts repeat."""

    faults: Sequence[Fault] = ()
    _kept: dict[tuple[int, str], Any] = field(default_factory=dict)
    """By the fault's number and the frame of the sensor, of which one message may carry several."""

    def spoil(self, t: float, vehicle: str, read: dict[str, Value]) -> dict[str, Value]:
        """Messages of a vehicle at ``t`` [s], by output, as its faults let them arrive. The messages may be changed."""
        for number, fault in enumerate(self.faults):
            where = PARTS.get(fault.part)
            if where is None or fault.vehicle != vehicle or (value := read.get(where.output)) is None:
                continue
            if fault.holds(t) and fault.kind == "lost" and where.whole:
                read = {name: kept for name, kept in read.items() if name != where.output}
                continue
            for message in [value] if isinstance(value, Message) else value:
                if fault.holds(t):
                    self._change(number, fault, message)
                else:
                    self._keep(number, fault, message)
        return read

    def grip(self, t: float, vehicle: str) -> tuple[float, float]:
        """What is left of the friction of a vehicle's left and right wheel at ``t`` [s], 0 to 1."""
        left = dict.fromkeys(GRIPS, 1.0)
        for fault in self.faults:
            if fault.part in left and fault.vehicle == vehicle and fault.holds(t):
                left[fault.part] *= 1.0 + fault.size if fault.kind == "bias" else 0.0
        return left["left_grip"], left["right_grip"]

    def _keep(self, number: int, fault: Fault, message: Any) -> None:
        if fault.kind == "frozen":
            kept = self._kept[number, _frame(message)] = type(message)()
            kept.CopyFrom(message)

    def _change(self, number: int, fault: Fault, message: Any) -> None:
        where = PARTS[fault.part]
        if fault.kind == "bias":
            _set(message, where.fields[0], _get(message, where.fields[0]) + fault.size * where.scale)
        elif fault.kind == "lost":
            for name in where.fields:
                _set(message, name, 0.0)
        elif (kept := self._kept.get((number, _frame(message)))) is None:
            self._keep(number, fault, message)
        elif where.whole:
            stamp = type(message.timestamp)()
            stamp.CopyFrom(message.timestamp)
            message.CopyFrom(kept)
            message.timestamp.CopyFrom(stamp)
        else:
            for name in where.fields:
                _set(message, name, _get(kept, name))


def _frame(message: Any) -> str:
    return str(getattr(message, "frame_id", ""))


def _get(message: Any, name: str) -> float:
    for part in name.split("."):
        message = getattr(message, part)
    value: float = message
    return value


def _set(message: Any, name: str, value: float) -> None:
    *parts, last = name.split(".")
    for part in parts:
        message = getattr(message, part)
    setattr(message, last, value)
