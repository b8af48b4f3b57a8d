"""The measures of an aircraft from what its looks give, then what its JSBSim model says, then what is usual.

Usual: tail volume coefficients 0.5 and 0.04 (Raymer, "Aircraft Design", table 6.4), tails of aspect ratio 4, wings tapered to 0.7.
"""

from math import isnan, sqrt
from typing import TypeVar

import msgspec
import numpy as np

from uvf.models.aircraft.panels import FIN_CHORD
from uvf.models.jsbsim.sizes import Sizes, Thruster
from uvf.models.vehicle.looks import Fuselage, Looks, Tail, Wing

S = TypeVar("S", bound=msgspec.Struct)

SPAN = 2.0  # m, of a model that tells nothing
TAPER = 0.7
CENTRE = 0.05  # of the span: what is nearer to the middle is in it


def planned(looks: Looks, sizes: Sizes) -> Looks:
    """The looks with every measure given: those that are not told (nan) are derived from the model's sizes or are the usual ones."""
    wing = _wing(looks, sizes)
    rear = rear_propeller(sizes, wing.span)
    tail = _tail(looks.tail, wing, sizes, rear is not None)
    fuselage = _fuselage(looks.fuselage, wing, tail, sizes)
    return Looks(wing, fuselage, tail, _first(looks.booms, 0.14 * wing.span), looks.colour)


def rear_propeller(sizes: Sizes, span: float) -> Thruster | None:
    """The propeller in the middle behind the centre of gravity, for a wing of ``span`` [m]; None without one. Tail booms pass beside it."""
    found = (t for t in sizes.thrusters if t.radius and abs(t.place[1]) < CENTRE * span and t.place[0] < 0)
    return next(found, None)


def _first(*values: float) -> float:
    """The first that is known."""
    return next(value for value in values if not isnan(value))


def _filled(given: S, worked_out: S) -> S:
    """What is given, and the rest as worked out."""
    values = msgspec.structs.asdict(given)
    still = {
        name: getattr(worked_out, name) for name, value in values.items() if value == "" or (isinstance(value, float) and isnan(value))
    }
    return msgspec.structs.replace(given, **still)


def _wing(looks: Looks, sizes: Sizes) -> Wing:
    given = looks.wing
    span = _first(given.span, sizes.span, SPAN)
    known = [chord for chord in (sizes.area / span, sizes.chord) if not isnan(chord)]
    mean = min(known) if known else span / 8  # the area of some counts what carries besides the wing
    root = _first(given.root, 2 * mean / (1 + TAPER))
    tip = _first(given.tip, max(2 * mean - root, 0.2 * root))
    width, up = _first(looks.fuselage.width, _width(span, root)), float(sizes.aero[2])
    z = 0.45 * width if up > 0.2 * width else -0.35 * width if up < -0.2 * width else up
    front = float(sizes.aero[0]) + 0.25 * root
    return _filled(given, Wing(x=front, z=z, span=span, root=root, tip=tip, sweep=0.25 * (root - tip), rise=0.015 * span))


def _width(span: float, root: float) -> float:
    return min(0.1 * span, 0.65 * root)


def _tail(given: Tail, wing: Wing, sizes: Sizes, on_booms: bool) -> Tail:
    mean = (wing.root + wing.tip) / 2
    rear = -float(np.min([0.0, *sizes.structure[:, 0], *sizes.wheels[:, 0]]))
    arm = _first(sizes.tail_arm, 0.85 * rear if rear > 1.5 * mean else 0.5 * wing.span)
    area = _first(sizes.tail_area, 0.5 * mean * wing.span * mean / arm)
    fin_area = _first(sizes.fin_area, 0.04 * mean * wing.span * wing.span / arm)
    span = _first(given.span, sqrt(4 * area))
    chord = _first(given.chord, area / span / 0.86)
    kind = given.kind or ("twin_boom" if on_booms else "conventional")
    usual = Tail(
        kind=kind,
        x=float(sizes.aero[0]) - arm + 0.25 * chord,
        z=wing.z if on_booms else 0.15 * _width(wing.span, wing.root),
        span=span,
        chord=chord,
        fin=float(np.clip(fin_area / chord / (1.72 if on_booms else 0.86 * FIN_CHORD), 0.25 * span, 0.8 * span)),
    )
    return _filled(given, usual)


def _fuselage(given: Fuselage, wing: Wing, tail: Tail, sizes: Sizes) -> Fuselage:
    middle = [t.place[0] for t in sizes.thrusters if t.radius and abs(t.place[1]) < CENTRE * wing.span]
    before = [x for x in middle if x > 0]
    points = [point[0] for point in (*sizes.structure, *sizes.wheels) if abs(point[1]) < CENTRE * wing.span]
    nose = max(before) if before else max([wing.x + 0.7 * wing.root, -0.6 * tail.x, *points])
    behind = [x for x in middle if x <= 0]
    rear = max(behind) if behind else tail.x - tail.chord
    return _filled(given, Fuselage(nose=float(nose), tail=float(rear), width=_width(wing.span, wing.root), z=0.0))
