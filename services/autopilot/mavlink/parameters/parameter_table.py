"""The parameters of one vehicle: those of ``parameters.yaml`` and the autopilot's own, numbered in the order of their names."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from typing import Any, Literal

import msgspec
import numpy as np

from services.autopilot.mavlink.connection.facts import VehicleInfo
from services.autopilot.mavlink.parameters.own_params import Own, own_params
from uvf.mavlink import dialect as mav
from uvf.models.yaml_data import BadInput, load_yaml, nearest

FILE = Path(__file__).with_name("parameters.yaml")
Kind = Literal["ground", "fixed_wing"]
OWN_NAME_MOST = 16  # characters
FULL_CELL = 4.2  # V, of lithium polymer
WHOLE = (-(2**31), 2**31 - 1)


class Case(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One value of an enumeration: its name, and the autopilot parameters that mean the same."""

    says: str
    sets: dict[str, str] = {}


class ParameterRow(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One row of ``parameters.yaml``, whose head explains the keys."""

    type: Literal["int", "real"]
    group: str
    about: str
    value: float | Literal["system_id", "cells", "cell_full", "cell_empty"] = 0
    ground: float | None = None
    fixed: str = ""
    means: dict[int, str] = {}
    own: str = ""
    cases: dict[int, Case] = {}
    absent: list[Kind] = []


class Table(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The file ``parameters.yaml``."""

    parameters: dict[str, ParameterRow]


@dataclass(frozen=True)
class Parameter:
    """A parameter as MAVLink shows it. ``fixed``: why it cannot be set; else it is ``own``, a number, or one of ``cases``."""

    name: str
    type: int
    group: str
    about: str
    index: int = 0
    unit: str = ""
    low: float = -np.inf
    high: float = np.inf
    value: float = 0.0
    fixed: str = ""
    means: Mapping[int, str] = field(default_factory=dict)
    """What its numbers are called, where it is fixed."""
    own: str = ""
    cases: Mapping[int, Case] = field(default_factory=dict)

    @property
    def is_int(self) -> bool:
        """Whether its type is INT32."""
        return self.type == mav.MAV_PARAM_TYPE_INT32

    def number(self, own: Mapping[str, Any]) -> float:
        """Its value [unit of the parameter] on the wire, for these values of the autopilot's own parameters."""
        if self.own and not self.cases:
            return round(own[self.own]) if self.is_int else float(own[self.own])
        fits = (number for number, case in self.cases.items() if all(own[name] == value for name, value in case.sets.items()))
        return next(fits, self.value)

    def settings(self, number: float) -> dict[str, Any]:
        """The autopilot's parameters for which its value is ``number`` [unit of the parameter]; empty if it is impossible.

        Limits are compared in single precision: a station that sends 0.3 means the limit 0.3.
        """
        if self.cases:
            return dict(self.cases[int(number)].sets) if number in self.cases else {}
        if not np.float32(self.low) <= np.float32(number) <= np.float32(self.high):
            return {}
        return {self.own: float(min(max(number, self.low), self.high))}


def parameters_of(facts: VehicleInfo) -> list[Parameter]:
    """The parameters of a vehicle in order of name, numbered from 0. Raises BadInput when the file names an unknown one."""
    return parameters_with(own_params(facts.params, facts.fixed_params), facts.file.kind, {"system_id": facts.system_id, **_battery(facts)})


def _battery(facts: VehicleInfo) -> dict[str, float]:
    """Of the vehicle's file; without a battery nothing."""
    body = facts.file.ground or facts.file.air
    pack = body.battery if body is not None else None
    if pack is None:
        return {}
    cells = max(round(pack.full / FULL_CELL), 1)
    return {"cells": cells, "cell_full": pack.full / cells, "cell_empty": pack.empty / cells}


def parameters_with(own: Mapping[str, Own], kind: Kind, given: Mapping[str, float] | None = None) -> list[Parameter]:
    """Parameters of an autopilot of this kind with its ``own`` ones, in order of name.

    given: system_id, cells [-], cell_full and cell_empty [V] from the vehicle's file. Raises BadInput.
    """
    rows = {name: row for name, row in _table().parameters.items() if kind not in row.absent}
    found = [_standard(name, _of_kind(row, kind, given or {}), own, kind) for name, row in rows.items()]
    found += [_offered(one) for one in own.values() if len(one.name) <= OWN_NAME_MOST]
    return [replace(p, index=index) for index, p in enumerate(sorted(found, key=lambda p: p.name))]


@cache
def _table() -> Table:
    return load_yaml(FILE, Table)


def _of_kind(row: ParameterRow, kind: Kind, given: Mapping[str, float]) -> ParameterRow:
    """With the value of this vehicle."""
    if isinstance(row.value, str):
        return msgspec.structs.replace(row, value=float(given.get(row.value, 0.0)))
    return msgspec.structs.replace(row, value=row.ground) if kind == "ground" and row.ground is not None else row


def _standard(name: str, row: ParameterRow, own: Mapping[str, Own], kind: Kind) -> Parameter:
    named = {row.own} if row.own else {key for case in row.cases.values() for key in case.sets}
    for key in named - own.keys() if not row.fixed else ():
        raise BadInput(f"{FILE.name}: {name}: '{key}' is no parameter of a {kind} autopilot; {nearest(key, own)}")
    if not named and not row.fixed:
        raise BadInput(f"{FILE.name}: {name}: say what it sets ('own', 'cases') or why it is 'fixed'")
    type_ = mav.MAV_PARAM_TYPE_INT32 if row.type == "int" else mav.MAV_PARAM_TYPE_REAL32
    plain = Parameter(name, type_, row.group, row.about, value=float(row.value))
    if not named <= own.keys() or not named:
        return replace(plain, fixed=row.fixed, means=row.means)
    if row.own:
        mine = own[row.own]
        return replace(plain, own=row.own, unit=mine.unit, low=mine.low, high=mine.high)
    cases = {n: case for n, case in row.cases.items() if all(value in own[key].choices for key, value in case.sets.items())}
    return replace(plain, cases=cases)


def _offered(one: Own) -> Parameter:
    """One of the autopilot's own, under its name in capitals; a choice is the number of its place."""
    if not one.choices:
        real = mav.MAV_PARAM_TYPE_REAL32
        plain = Parameter(one.name.upper(), real, one.group, one.about, unit=one.unit, low=one.low, high=one.high, own=one.name)
    else:
        cases = {number: Case(choice, {one.name: choice}) for number, choice in enumerate(one.choices)}
        plain = Parameter(one.name.upper(), mav.MAV_PARAM_TYPE_INT32, one.group, one.about, cases=cases)
    return replace(plain, fixed=one.fixed)
