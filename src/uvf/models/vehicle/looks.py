"""``air: looks:`` of a vehicle.yaml: how an aircraft is drawn, in metres from its centre of gravity, x forward, y left, z up.

All of it may be left out: what is not given (nan, or "") is worked out from the JSBSim model (``aircraft_plan``),
and is left out again when they are written.
"""

from math import nan
from typing import Annotated, Literal

import msgspec
from msgspec import Meta

Length = Annotated[float, Meta(ge=-200, le=200)]
Share = Annotated[float, Meta(ge=0, le=1)]


class Wing(msgspec.Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """x, z: the front edge of its root; span from tip to tip; sweep: how far the tip's front edge lies behind the root's."""

    x: Length = nan
    z: Length = nan
    span: Length = nan
    root: Length = nan
    tip: Length = nan
    sweep: Length = nan
    rise: Length = nan


class Fuselage(msgspec.Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """From ``nose`` back to ``tail`` along x, ``width`` wide and high, its middle at ``z``."""

    nose: Length = nan
    tail: Length = nan
    width: Length = nan
    z: Length = nan


class Tail(msgspec.Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """x, z: the front edge of its root; span of the plane; chord at the root; fin: its height.

    kind: plane and fin on the fuselage, the plane on top of the fin (t), two slanted panels (v), on two booms: plane and
    two fins (twin_boom) or panels that meet above the middle (inverted_v).
    """

    kind: Literal["", "conventional", "t", "v", "twin_boom", "inverted_v", "none"] = ""
    x: Length = nan
    z: Length = nan
    span: Length = nan
    chord: Length = nan
    fin: Length = nan


class Looks(msgspec.Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """booms: their distance from the middle; colour: red, green, blue for cameras (on the page each vehicle has a colour of its own)."""

    wing: Wing = Wing()
    fuselage: Fuselage = Fuselage()
    tail: Tail = Tail()
    booms: Length = nan
    colour: tuple[Share, Share, Share] = (0.92, 0.92, 0.94)
