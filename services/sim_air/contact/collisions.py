"""Notices when an aircraft hits something: a solid of the world, a ground vehicle, another aircraft."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from services.sim_air.contact.surroundings import Around
from services.sim_air.engine.states import AircraftMotion
from uvf.maths.bvh import Bvh, build
from uvf.maths.raycast import MovingBody, Rays, Scene, cast
from uvf.maths.rotations import Floats, matrix
from uvf.maths.solids import joined
from uvf.models.shapes.scene import primitives

MARGIN = 1.0  # m about the bounding spheres within which it is looked at closely
STEP = 0.15  # m above the ground under the aircraft, up to where its own points of contact feel what there is
NOTHING = Scene(build(joined([])))


class Hit(NamedTuple):
    """A collision of an aircraft with something named ``other``."""

    aircraft: str
    other: str


class Feelers:
    """Lines through an aircraft from nose to tail, tip to tip and top to bottom, and from the last to the present position of each end."""

    def __init__(self, shape: Bvh) -> None:
        low, high = shape.bounds[0, :3], shape.bounds[0, 3:]
        self._ends: Floats = np.concatenate((np.diag(low), np.diag(high)))
        self.radius = float(np.linalg.norm(np.maximum(-low, high)))

    def feel(self, before: AircraftMotion, motion: AircraftMotion) -> Rays:
        """The rays to test; directions are as long as the lines. Of an aircraft that did not move only the lines through it."""
        was, now = self._at(before), self._at(motion)
        starts, ends = now[:3], now[3:]
        if np.linalg.norm(now - was, axis=1).min() > 0:
            starts, ends = np.concatenate((starts, was)), np.concatenate((ends, now))
        return Rays(starts, ends - starts)

    def _at(self, motion: AircraftMotion) -> Floats:
        ends: Floats = motion.position + self._ends @ matrix(motion.world_from_body).T
        return ends


class Collisions:
    """Detects collisions; each pair is reported once, when it begins to touch."""

    def __init__(self, around: Around) -> None:
        self._around = around
        self._feelers = {name: Feelers(shape) for name, shape in around.shapes.items()}
        self._before: Mapping[str, AircraftMotion] = {}
        self._touching: set[frozenset[str]] = set()
        bounds = around.still.tree.bounds
        self._highest = float(bounds[0, 5]) if len(bounds) else -np.inf

    def add(self, name: str, shape: Bvh) -> None:
        """Adds an aircraft with its shape."""
        self._feelers[name] = Feelers(shape)

    def remove(self, name: str) -> None:
        """Removes an aircraft."""
        del self._feelers[name]
        self.forget(name)

    def forget(self, name: str) -> None:
        """Forgets the last position of an aircraft that was put elsewhere: it did not fly there."""
        self._before = {other: motion for other, motion in self._before.items() if other != name}
        self._touching = {pair for pair in self._touching if name not in pair}

    def step(self, motions: Mapping[str, AircraftMotion]) -> list[Hit]:
        """The collisions that began in this step; motions: of all aircraft, by name."""
        moving = self._around.bodies() if self._around.crowded else {}
        near = self._near(motions, moving)
        close = {name: {other: moving[other] for other in others} for name, others in near.items()}
        hits = [hit for name, motion in motions.items() for hit in self._hits(name, motion, close.get(name, {}))]
        pairs = {frozenset(hit): hit for hit in reversed(hits)}
        new = [hit for pair, hit in pairs.items() if pair not in self._touching]
        self._touching, self._before = set(pairs), motions
        return new

    def _near(self, motions: Mapping[str, AircraftMotion], moving: Mapping[str, MovingBody]) -> dict[str, list[str]]:
        """What is within MARGIN of each aircraft's bounding sphere, itself left out; all pairs at once, since this is done every step."""
        if not moving:
            return {}
        names = list(moving)
        bounds = np.abs([body.tree.bounds[0] for body in moving.values()])
        radii = np.sqrt((np.maximum(bounds[:, :3], bounds[:, 3:]) ** 2).sum(axis=1))
        reach = np.array([self._feelers[name].radius + MARGIN for name in motions])
        away = np.array([m.position for m in motions.values()])[:, None] - np.array([body.position for body in moving.values()])
        close = (away**2).sum(axis=2) < (reach[:, None] + radii) ** 2
        return {name: [names[k] for k in np.flatnonzero(row) if names[k] != name] for name, row in zip(motions, close, strict=True)}

    def _hits(self, name: str, motion: AircraftMotion, near: Mapping[str, MovingBody]) -> list[Hit]:
        feelers = self._feelers[name]
        low = motion.position[2] - feelers.radius - MARGIN < self._highest
        if not low and not near:
            return []
        rays = feelers.feel(self._before.get(name, motion), motion)
        above = self._around.ground.under(motion.position) + STEP
        still = [Hit(name, self._which(rays, above))] if low and _meets(Scene(self._around.still.tree), [], rays, above) else []
        return still + [Hit(name, other) for other, body in near.items() if _meets(NOTHING, [body], rays)]

    def _which(self, rays: Rays, above: float) -> str:
        """The name of the solid of the world that has been hit."""
        still = (thing for thing in self._around.things if thing.path is None)
        return next(thing.name for thing in still if _meets(Scene(build(primitives(thing))), [], rays, above))


def _meets(scene: Scene, bodies: list[MovingBody], rays: Rays, above: float = -np.inf) -> bool:
    """Whether any line is met by something between its ends and ``above`` this height [m, world]."""
    shares = cast(scene, bodies, rays, 1.0)
    met = np.isfinite(shares)
    return bool((rays.origins[met, 2] + shares[met] * rays.directions[met, 2] > above).any())
