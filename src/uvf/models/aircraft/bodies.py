"""Fuselages, hulls, wheels, engines and what is carried: the parts of an aircraft's shape that no hinge moves, and propellers."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from uvf.models.aircraft.panels import Movable
from uvf.models.jsbsim.sizes import Hull, Sizes, Thruster
from uvf.models.shapes.mesh_parts import Colour, MeshPart, box, lathe, rod
from uvf.models.vehicle.looks import Looks
from uvf.models.vehicle.sensors import Sensors

PLATE: Colour = (58, 64, 76)
GLASS: Colour = (40, 60, 90)
BLADE: Colour = (30, 32, 36)
RUBBER: Colour = (24, 24, 26)

Stations = Sequence[tuple[float, float]]

POD: Stations = ((0.0, 0.45), (0.125, 1.0), (0.667, 1.0), (0.875, 0.77), (1.0, 0.27))
"""(place from tail to nose, radius) of a body that ends in a propeller, and below of one that tapers to its tail."""
CONE: Stations = ((0.0, 0.14), (0.3, 0.55), (0.52, 0.95), (0.6, 1.0), (0.86, 1.0), (0.96, 0.78), (1.0, 0.4))
CANOPY: Stations = ((0.62, 0.16), (0.7, 0.55), (0.8, 0.28))
BALL, BALL_ABOVE = 0.05, 0.065  # m, radius of a gimbal's housing, and how far its middle is above the camera
BOOMS = ("twin_boom", "inverted_v")


def fuselage_parts(looks: Looks, sizes: Sizes) -> list[MeshPart]:
    """Body, canopy and booms of an aircraft, and the housings of engines that are not in them, as meshes [m, body frame FLU]."""
    body, wing, tail = looks.fuselage, looks.wing, looks.tail
    on_booms = tail.kind in BOOMS
    half, centre = body.width / 2, (body.tail, 0.0, body.z)
    parts = [_turned(POD if on_booms else CONE, body.nose - body.tail, half, centre)]
    parts.append(_turned(CANOPY, body.nose - body.tail, half, (body.tail, 0.0, body.z + 0.62 * half), GLASS))
    for side in (-1.0, 1.0) if on_booms else ():
        start = (wing.x - 0.6 * wing.root, side * looks.booms, wing.z)
        parts.append(rod(start, (tail.x - tail.chord, side * looks.booms, tail.z), 0.08 * body.width, PLATE))
    return parts + [_housing(t, body.width) for t in sizes.thrusters if abs(t.place[1]) > half]


def _turned(
    stations: Sequence[tuple[float, float]], length: float, radius: float, tail: Sequence[float], colour: Colour | None = None
) -> MeshPart:
    return lathe(0, [(place * length, share * radius) for place, share in stations], tail, colour)


def _housing(thruster: Thruster, width: float) -> MeshPart:
    """Behind a propeller, about a jet."""
    x, y, z = thruster.place
    radius, length = (0.22 * thruster.radius, 1.4 * thruster.radius) if thruster.radius else (0.2 * width, 0.9 * width)
    stations = [(-0.8 * length, 0.6 * radius), (-0.3 * length, radius), (0.0, 0.8 * radius)]
    return lathe(0, stations, (x, y, z), PLATE)


def undercarriage(sizes: Sizes, width: float, above: float) -> list[MeshPart]:
    """A wheel and a leg at each contact point of a fuselage of ``width`` [m]; legs begin at the height ``above`` [m, body frame FLU]."""
    parts = []
    for x, y, z in sizes.wheels:
        radius = min(0.3 * (above - z), 0.12 * width + 0.02)
        if radius <= 0:
            continue
        parts.append(lathe(1, [(-0.3 * radius, radius), (0.3 * radius, radius)], (x, y, z + radius), RUBBER))
        parts.append(rod((x, y, z + radius), (x, float(np.clip(y, -0.3 * width, 0.3 * width)), above), 0.2 * radius, PLATE))
    return parts


class Gondola(NamedTuple):
    """Box below an airship's hull: centre and full edges x, y, z [m, body frame FLU]."""

    centre: tuple[float, float, float]
    size: tuple[float, float, float]


def gondola(sizes: Sizes, hull: Hull) -> Gondola:
    """The gondola of an airship, below the hull, where wheels and engines are."""
    x, y, z = hull.middle
    along, across, high = (float(r) for r in hull.radii)
    below = [p[0] for p in (*sizes.wheels, *(t.place for t in sizes.thrusters)) if p[2] < z - 0.6 * high]
    return Gondola(
        (float(np.mean(below)) if below else float(x), float(y), float(z) - 1.08 * high), (0.4 * along, 0.4 * across, 0.28 * high)
    )


def airship(sizes: Sizes, hull: Hull, car: Gondola) -> list[MeshPart]:
    """The fixed parts of an airship: an ellipsoid as hull, the gondola, engines on rods."""
    places = np.linspace(-1.0, 1.0, 17) * 0.99
    envelope = lathe(0, [(float(x * hull.radii[0]), float(np.sqrt(1 - x * x))) for x in places], (0.0, 0.0, 0.0))
    parts = [
        MeshPart(envelope.vertices * (1.0, hull.radii[1], hull.radii[2]) + hull.middle, envelope.faces),
        box(car.centre, car.size, PLATE),
    ]
    for thruster in sizes.thrusters:
        parts += [rod(car.centre, thruster.place, 0.02 * hull.radii[1], PLATE), _housing(thruster, car.size[1])]
    return parts


def propeller(name: str, thruster: Thruster) -> Movable:
    """A propeller as a turning part of two blades and a hub, about the thruster's place."""
    r = thruster.radius
    blades = [box((0, side * 0.52 * r, 0), (0.05 * r, 0.96 * r, 0.15 * r), BLADE) for side in (-1.0, 1.0)]
    hub = lathe(0, [(-0.12 * r, 0.06 * r), (0.0, 0.14 * r), (0.12 * r, 0.06 * r)], (0, 0, 0), BLADE)
    return Movable(name, thruster.place, np.array((1.0, 0.0, 0.0)), [*blades, hub], spins=True)


def payload(sensors: Sensors) -> list[MeshPart]:
    """The housings of the gimbal and the lidar, where they are mounted."""
    parts = []
    if sensors.gimbal is not None:
        parts.append(_ball(*sensors.gimbal.mount.xyz))
    if sensors.lidar is not None:
        parts.append(lathe(2, [(-0.03, 0.035), (0.04, 0.035)], sensors.lidar.mount.xyz, GLASS))
    return parts


def _ball(x: float, y: float, z: float) -> MeshPart:
    ring = [(BALL * float(np.sin(a)), BALL * float(np.cos(a))) for a in np.linspace(-1.45, 1.45, 9)]
    return lathe(2, ring, (x, y, z + BALL_ABOVE), GLASS)
