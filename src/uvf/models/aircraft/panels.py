"""Wings, tails and fins as flat panels with surfaces on hinges: one description for all of them."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import msgspec
import numpy as np

from uvf.models.jsbsim.sizes import Hull
from uvf.models.shapes.mesh_parts import Colour, Floats, MeshPart, Point, plate
from uvf.models.vehicle.looks import Looks, Tail

WING_HINGE, TAIL_HINGE = 0.75, 0.65  # of the chord, where surfaces begin
GAP = 0.015  # of the chord
THICK = 0.11  # of the chord
DOWN, LEFT = (0.0, 0.0, -1.0), (0.0, 1.0, 0.0)
MOVES: Colour = (225, 229, 236)
FIN_CHORD = 1.3  # chord of a fin in the middle, of that of the plane
TIP = 0.72  # chord at the tip of a tail, of that at its root
SIDES = (("left", 1.0), ("right", -1.0))


@dataclass(frozen=True)
class Movable:
    """Turns about a hinge: ``axis`` (3,), a unit vector through ``origin`` (3,) [m], both in the body frame (FLU).

    A positive angle is that of SurfaceCommand: trailing edge down, or left for a rudder. parts: relative to the origin, at rest.
    spins: it is told a speed instead of an angle.
    """

    name: str
    origin: Floats
    axis: Floats
    parts: list[MeshPart]
    spins: bool = False


class PanelSurface(NamedTuple):
    """A hinged surface from ``start`` to ``end``, parts of the panel's span from 0 at its root to 1 at its tip.

    way: the direction, in the body frame (FLU), in which a positive angle moves its trailing edge.
    """

    name: str
    start: float
    end: float
    way: Point


@dataclass(frozen=True)
class Panel:
    """A flat panel between the leading edges of its root and tip, (3,) [m, body frame FLU]; chords [m] go straight back.

    surfaces: in order from root to tip; hinge: where they begin, as a part of the chord.
    """

    root: Point
    tip: Point
    root_chord: float
    tip_chord: float
    surfaces: Sequence[PanelSurface]
    hinge: float = TAIL_HINGE

    def fixed(self) -> list[MeshPart]:
        """The part of the panel that does not move: all before the hinge line, and behind it what lies between the surfaces."""
        edges = [0.0, *(edge for surface in self.surfaces for edge in (surface.start, surface.end)), 1.0]
        behind = [(a, b) for a, b in zip(edges[::2], edges[1::2], strict=True) if b - a > GAP]
        strips = [self._strip((0.0, 1.0), (0.0, self.hinge)), *(self._strip(along, (self.hinge, 1.0)) for along in behind)]
        return [plate(strip, self._thickness) for strip in strips]

    def movables(self) -> list[Movable]:
        """Each surface as a part that turns about its hinge."""
        return [self._hinged(surface) for surface in self.surfaces]

    @property
    def _thickness(self) -> float:
        return THICK * (self.root_chord + self.tip_chord) / 2

    def _strip(self, along: tuple[float, float], chord: tuple[float, float]) -> list[Point]:
        """The outline of a part; its first two points are on its front edge, root first."""
        return [self._at(a, c) for a, c in ((along[0], chord[0]), (along[1], chord[0]), (along[1], chord[1]), (along[0], chord[1]))]

    def _at(self, along: float, chord: float) -> Point:
        x, y, z = (a + along * (b - a) for a, b in zip(self.root, self.tip, strict=True))
        return x - chord * (self.root_chord + along * (self.tip_chord - self.root_chord)), y, z

    def _hinged(self, surface: PanelSurface) -> Movable:
        outline = self._strip((surface.start, surface.end), (self.hinge + GAP, 1.0))
        origin = np.array(outline[0])
        axis = np.subtract(outline[1], outline[0])
        axis = axis / np.linalg.norm(axis)
        axis *= np.sign(np.cross(axis, (-1.0, 0.0, 0.0)) @ surface.way)
        part = plate(outline, 0.6 * self._thickness, MOVES)
        return Movable(surface.name, origin, axis, [replace(part, vertices=part.vertices - origin)])


def wing_panels(looks: Looks) -> list[Panel]:
    """The left and the right half of the wing, each with a flap and an aileron."""
    wing, half = looks.wing, looks.wing.span / 2
    return [
        Panel(
            (wing.x, 0.0, wing.z),
            (wing.x - wing.sweep, side * half, wing.z + wing.rise),
            wing.root,
            wing.tip,
            (PanelSurface(f"{name}_flap", 0.11, 0.5, DOWN), PanelSurface(f"{name}_aileron", 0.54, 0.98, DOWN)),
            WING_HINGE,
        )
        for name, side in SIDES
    ]


def tail_panels(looks: Looks) -> list[Panel]:
    """The panels of the tail that ``looks`` asks for, with elevators, rudders or both; none for a tail of kind ``none``."""
    tail, booms = looks.tail, looks.booms
    if tail.kind == "none":
        return []
    if tail.kind in ("v", "inverted_v"):
        inner, outer = (booms, 0.0) if tail.kind == "inverted_v" else (0.0, tail.span / 2)
        return [_panel(tail, (0.0, side * inner, 0.0), (side * (outer - inner), tail.fin), _mixed(name)) for name, side in SIDES]
    half = booms if tail.kind == "twin_boom" else tail.span / 2
    at = (-0.3 * tail.chord, 0.0, tail.fin) if tail.kind == "t" else (0.0, 0.0, 0.0)
    plane = [_panel(tail, at, (side * half, 0.0), [PanelSurface(f"{name}_elevator", 0.08, 0.96, DOWN)]) for name, side in SIDES]
    if tail.kind != "twin_boom":
        tail = msgspec.structs.replace(tail, chord=FIN_CHORD * tail.chord)
    fins = {"left_rudder": booms, "right_rudder": -booms} if tail.kind == "twin_boom" else {"rudder": 0.0}
    return plane + [_panel(tail, (0.0, y, 0.0), (0.0, tail.fin), [PanelSurface(name, 0.08, 0.96, LEFT)]) for name, y in fins.items()]


def _mixed(name: str) -> list[PanelSurface]:
    return [PanelSurface(f"{name}_elevator", 0.04, 0.5, DOWN), PanelSurface(f"{name}_rudder", 0.54, 0.96, LEFT)]


def _panel(tail: Tail, at: Point, reach: tuple[float, float], surfaces: Sequence[PanelSurface]) -> Panel:
    """at: from the tail's place; reach: to the side and up, of the tip from the root [m]."""
    root = (tail.x + at[0], at[1], tail.z + at[2])
    tip = (root[0] - 0.24 * tail.chord, root[1] + reach[0], root[2] + reach[1])
    return Panel(root, tip, tail.chord, TIP * tail.chord, surfaces)


def hull_fins(hull: Hull) -> list[Panel]:
    """The four fins at the stern of an airship, reaching 1.36 radii out; their roots lie within the hull."""
    x, across, high = hull.radii
    ways = {
        "left_elevator": (across, 0.0, DOWN),
        "right_elevator": (-across, 0.0, DOWN),
        "upper_rudder": (0.0, high, LEFT),
        "lower_rudder": (0.0, -high, LEFT),
    }
    front, back = hull.middle[0] - 0.6 * x, hull.middle[0] - 0.72 * x
    return [
        Panel(
            (front, hull.middle[1] + 0.5 * y, hull.middle[2] + 0.5 * z),
            (back, hull.middle[1] + 1.36 * y, hull.middle[2] + 1.36 * z),
            0.34 * x,
            0.22 * x,
            [PanelSurface(name, 0.45, 0.96, way)],
        )
        for name, (y, z, way) in ways.items()
    ]
