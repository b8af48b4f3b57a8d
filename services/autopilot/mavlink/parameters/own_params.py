"""The autopilot's own parameters as its type describes them: limits, units, choices, words."""

from collections.abc import Set
from dataclasses import dataclass
from typing import Annotated, Any, Literal, get_args, get_origin

from uvf.models.keys import hints_of, meta_of, unit_of
from uvf.models.params import Params
from uvf.models.vehicle.failsafe_params import FailsafeParams

READ_ONCE = "it is read only when the autopilot starts; the vehicle's file sets it"


@dataclass(frozen=True)
class Own:
    """A parameter of the autopilot itself. choices: of a parameter that is a word; else low..high are the limits of a number."""

    name: str
    about: str
    group: str
    unit: str = ""
    low: float = -float("inf")
    high: float = float("inf")
    choices: tuple[str, ...] = ()
    fixed: str = ""


def own_params(params: Params, fixed: Set[str]) -> dict[str, Own]:
    """The parameters of a set by name. Raises TypeError for one that is neither a number within limits nor a choice."""
    hints = hints_of(type(params))
    return {name: _described(name, hints[name], READ_ONCE if name in fixed else "") for name in params.__struct_fields__}


def _described(name: str, hint: Any, fixed: str) -> Own:
    meta = meta_of(hint)
    kind = get_args(hint)[0] if get_origin(hint) is Annotated else hint
    about, group = meta.description or "", _group(name)
    if get_origin(kind) is Literal:
        return Own(name, about, group, choices=get_args(kind), fixed=fixed)
    if kind is float and meta.ge is not None and meta.le is not None:
        return Own(name, about, group, unit_of(meta) or "", float(meta.ge), float(meta.le), fixed=fixed)
    raise TypeError(f"{name}: {hint} cannot be offered over MAVLink")


def _group(name: str) -> str:
    return "Failsafes" if name in FailsafeParams.__struct_fields__ else "Autopilot"
