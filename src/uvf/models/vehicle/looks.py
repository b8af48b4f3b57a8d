"""``air: looks:`` of a vehicle.yaml: how an aircraft is drawn, in metres from its centre of gravity, x forward, y left, z up.

All of it may be left out: what is not given (nan, or "") is worked out from the JSBSim model (``aircraft.dimensions``),
and is left out again when they are written.
"""

from math import nan
from typing import Annotated, Literal

import msgspec
from msgspec import Meta

from uvf.models.keys import key, plain

Length = Annotated[float, Meta(ge=-200, le=200)]
Share = Annotated[float, Meta(ge=0, le=1)]


class Wing(msgspec.Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """x, z: the front edge of its root; span from tip to tip; sweep: how far the tip's front edge lies behind the root's."""

    x: Annotated[Length, key("m", "Leading edge at the root, forward of the centre of gravity.")] = nan
    z: Annotated[Length, key("m", "Leading edge at the root, above the centre of gravity.")] = nan
    span: Annotated[Length, key("m", "Distance from tip to tip.")] = nan
    root: Annotated[Length, key("m", "Chord at the root.")] = nan
    tip: Annotated[Length, key("m", "Chord at the tip.")] = nan
    sweep: Annotated[Length, key("m", "Distance of the tip's leading edge behind the root's.")] = nan
    rise: Annotated[Length, key("m", "Height of the tip above the root.")] = nan


class Fuselage(msgspec.Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """From ``nose`` back to ``tail`` along x, ``width`` wide and high, its middle at ``z``."""

    nose: Annotated[Length, key("m", "Forward end, from the centre of gravity.")] = nan
    tail: Annotated[Length, key("m", "Rear end, from the centre of gravity; negative is behind it.")] = nan
    width: Annotated[Length, key("m", "Width and height.")] = nan
    z: Annotated[Length, key("m", "Middle above the centre of gravity.")] = nan


class Tail(msgspec.Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """x, z: the front edge of its root; span of the plane; chord at the root; fin: its height.

    kind: plane and fin on the fuselage, the plane on top of the fin (t), two slanted panels (v), on two booms: plane and
    two fins (twin_boom) or panels that meet above the middle (inverted_v).
    """

    kind: Annotated[
        Literal["", "conventional", "t", "v", "twin_boom", "inverted_v", "none"],
        plain(
            "Plane and fin on the fuselage (`conventional`), plane on top of the fin (`t`), two slanted panels (`v`), "
            "on two booms (`twin_boom`, `inverted_v`), or `none`."
        ),
    ] = ""
    x: Annotated[Length, key("m", "Leading edge at the root, forward of the centre of gravity.")] = nan
    z: Annotated[Length, key("m", "Leading edge at the root, above the centre of gravity.")] = nan
    span: Annotated[Length, key("m", "Span of the tailplane.")] = nan
    chord: Annotated[Length, key("m", "Chord at the root.")] = nan
    fin: Annotated[Length, key("m", "Height of the fin.")] = nan


class Looks(msgspec.Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """booms: their distance from the middle; colour: red, green, blue for cameras (on the page each vehicle has a colour of its own)."""

    wing: Annotated[Wing, plain("Wing.")] = Wing()
    fuselage: Annotated[Fuselage, plain("Fuselage.")] = Fuselage()
    tail: Annotated[Tail, plain("Tail.")] = Tail()
    booms: Annotated[Length, key("m", "Distance of the tail booms from the middle.")] = nan
    colour: Annotated[
        tuple[Share, Share, Share], plain("Red, green, blue for cameras, each 0 to 1; the page gives each vehicle a colour of its own.")
    ] = (0.92, 0.92, 0.94)
