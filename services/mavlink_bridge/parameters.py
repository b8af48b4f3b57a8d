"""Parameters of an autopilot by name: read, and set until it says that the new value is in force."""

import json
import math
import struct
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from schemas.messages import Param, ParamReply
from services.mavlink_bridge.connection import TEXT_WITHIN, Wire
from services.mavlink_bridge.limits import LARGEST_FLOAT, WHOLE_FLOAT, OutOfLimits
from uvf.mavlink import dialect as mav
from uvf.runtime.messages.validation import legible

AGAIN_AFTER, TRIES = 0.7, 5  # s
NAME_BYTES = 16
NUMBER_LETTERS = 40
WAITING_MOST = 64
"""Parameters that are being asked for."""
INTEGER = {
    mav.MAV_PARAM_TYPE_UINT8: "<Bxxx",
    mav.MAV_PARAM_TYPE_INT8: "<bxxx",
    mav.MAV_PARAM_TYPE_UINT16: "<Hxx",
    mav.MAV_PARAM_TYPE_INT16: "<hxx",
    mav.MAV_PARAM_TYPE_UINT32: "<I",
    mav.MAV_PARAM_TYPE_INT32: "<i",
}
LIMITS = {
    mav.MAV_PARAM_TYPE_UINT8: (0, 2**8 - 1),
    mav.MAV_PARAM_TYPE_INT8: (-(2**7), 2**7 - 1),
    mav.MAV_PARAM_TYPE_UINT16: (0, 2**16 - 1),
    mav.MAV_PARAM_TYPE_INT16: (-(2**15), 2**15 - 1),
    mav.MAV_PARAM_TYPE_UINT32: (0, 2**32 - 1),
    mav.MAV_PARAM_TYPE_INT32: (-(2**31), 2**31 - 1),
    mav.MAV_PARAM_TYPE_REAL32: (-LARGEST_FLOAT, LARGEST_FLOAT),
}
"""Of each type that goes over the wire in four bytes."""
ERRORS = {
    1: "there is none of this name",
    2: "out of range",
    3: "may not be set",
    5: "read only",
    6: "of a kind that is not known",
    7: "wrong type",
}
Value = int | float


@dataclass
class RequestedParameter:
    """A request to read or set a parameter."""

    name: str
    value: Value | None
    """To be set; None = only read."""
    done: Callable[[ParamReply], None]
    kind: int | None = None
    """MAV_PARAM_TYPE, known once it has been read."""
    sent_at: float = -math.inf
    tries: int = 0
    why: str = ""


class ParameterClient:
    """Reads and sets parameters. bytewise: whether integers travel as their bytes (PX4), or as the nearest float (ArduPilot)."""

    def __init__(self, wire: Wire) -> None:
        self._wire = wire
        self.bytewise = True
        self._wanted: list[RequestedParameter] = []

    def handlers(self) -> dict[int, Callable[[Any], None]]:
        """Handlers of the parameter messages, by message id."""
        return {mav.MAVLINK_MSG_ID_PARAM_VALUE: self._on_value, mav.MAVLINK_MSG_ID_PARAM_ERROR: self._on_error}

    def ask(self, name: str, value: str, done: Callable[[ParamReply], None]) -> None:
        """Reads a parameter, or sets it to ``value``: JSON, empty = read only; ``done`` hears the reply."""
        try:
            wanted = _number(name, value) if value else None
            _check_name(name)
            if len(self._wanted) >= WAITING_MOST:
                raise OutOfLimits(f"{WAITING_MOST} parameters are being asked for already: ask again later, and less often")
        except OutOfLimits as refused:
            done(ParamReply(accepted=False, reason=str(refused)))
            return
        self._wanted.append(RequestedParameter(name, wanted, done))
        self.tick()

    def tick(self) -> None:
        """Repeats requests without an answer, and ends those that were refused."""
        for wanted in list(self._wanted):
            if wanted.why and self._wire.t - wanted.sent_at > TEXT_WITHIN:
                self._end(wanted, ParamReply(accepted=False, reason=wanted.why))
            elif not wanted.why and self._wire.t - wanted.sent_at > AGAIN_AFTER:
                self._try(wanted)

    def _try(self, wanted: RequestedParameter) -> None:
        if wanted.tries >= TRIES:
            self._end(wanted, ParamReply(accepted=False, reason=f"{wanted.name}: no answer; the autopilot may have none of this name"))
            return
        wanted.tries += 1
        wanted.sent_at = self._wire.t
        to, name = (self._wire.system, self._wire.component), wanted.name.encode()
        if wanted.value is None or wanted.kind is None:
            self._wire.send(mav.MAVLink_param_request_read_message(*to, name, -1))
        else:
            self._wire.send(mav.MAVLink_param_set_message(*to, name, self._coded(wanted.value, wanted.kind), wanted.kind))

    def _on_value(self, message: mav.MAVLink_param_value_message) -> None:
        name = _name(message.param_id)
        for wanted in [w for w in self._wanted if w.name == name]:
            try:
                value = self._decoded(message.param_value, message.param_type)
                self._check(wanted.value, message.param_type)
            except OutOfLimits as refused:
                self._end(wanted, ParamReply(accepted=False, reason=f"{name}: {refused}"))
            else:
                self._compare(wanted, message.param_type, value)
        self.tick()

    def _compare(self, wanted: RequestedParameter, kind: int, value: Value) -> None:
        """What the autopilot has now, with what it shall have."""
        known, wanted.kind = wanted.kind is not None, kind
        if wanted.value is None or (known and _same(value, wanted.value)):
            param = Param(name=wanted.name, value=json.dumps(value))
            self._end(wanted, ParamReply(accepted=True, params=[param]))
        elif known:
            words = self._wire.worry_since(wanted.sent_at)
            wanted.why = wanted.why or f"{wanted.name} stays {value:g}" + (f": {words}" if words else "")
        else:
            wanted.tries, wanted.sent_at = 0, -math.inf

    def _on_error(self, message: mav.MAVLink_param_error_message) -> None:
        for wanted in [w for w in self._wanted if w.name == _name(message.param_id)]:
            wanted.why = f"{wanted.name}: {ERRORS.get(message.error, f'error {message.error}')}"

    def _check(self, value: Value | None, kind: int) -> None:
        """Whether the parameter can have a value. Raises OutOfLimits."""
        if value is None:
            return
        low, high = LIMITS[kind]
        if not low <= value <= high:
            raise OutOfLimits(f"{value:g} is not within {low:g} and {high:g}, all that a parameter of its type can be")
        if kind in INTEGER and value != int(value):
            raise OutOfLimits(f"{value:g} is no whole number")
        if kind in INTEGER and not self.bytewise and abs(value) > WHOLE_FLOAT and struct.unpack("<f", struct.pack("<f", value))[0] != value:
            raise OutOfLimits(f"{value:.0f} cannot be told to this autopilot, which takes whole numbers as 32-bit floats")

    def _coded(self, value: Value, kind: int) -> float:
        """Of a value that has been checked."""
        if kind not in INTEGER or not self.bytewise:
            return float(value)
        coded: float = struct.unpack("<f", struct.pack(INTEGER[kind], int(value)))[0]
        return coded

    def _decoded(self, value: float, kind: int) -> Value:
        """What the autopilot means. Raises OutOfLimits when that is no number."""
        if kind not in LIMITS:
            raise OutOfLimits(f"the autopilot tells it as one of type {kind}, which the bridge does not know")
        if kind in INTEGER and self.bytewise:
            whole: int = struct.unpack(INTEGER[kind], struct.pack("<f", value))[0]
            return whole
        low, high = LIMITS[kind]
        if not low <= value <= high:
            raise OutOfLimits(f"the autopilot tells {value:g}, which is no number of its type")
        return round(value) if kind in INTEGER else value

    def _end(self, wanted: RequestedParameter, reply: ParamReply) -> None:
        self._wanted.remove(wanted)
        wanted.done(reply)

    def give_up(self, reason: str) -> None:
        """Refuses all open requests."""
        for wanted in list(self._wanted):
            self._end(wanted, ParamReply(accepted=False, reason=reason))


def _number(name: str, text: str) -> Value:
    """Of a request. Raises OutOfLimits."""
    value: object = None
    if len(text) <= NUMBER_LETTERS:
        try:
            value = json.loads(text)
        except ValueError:
            value = None
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise OutOfLimits(f"{legible(name, NAME_BYTES)}: {legible(text, NUMBER_LETTERS)} is no number")
    return value


def _check_name(name: str) -> None:
    """Raises OutOfLimits."""
    if not name or len(name) > NAME_BYTES or not (name.isascii() and name.isprintable()):
        raise OutOfLimits("name one parameter of the autopilot, of at most 16 letters")


def _name(raw: str | bytes) -> str:
    return raw.rstrip("\0") if isinstance(raw, str) else bytes(raw).split(b"\0")[0].decode("ascii", "replace")


def _same(one: Value, other: Value) -> bool:
    """As the wire has them: 32-bit floats."""
    return math.isclose(one, other, rel_tol=1e-6, abs_tol=1e-9)
