"""The treads of wheels that scrub, are steered or have rollers, with friction of their own: the engine's is not for them."""

from collections.abc import Sequence
from math import cos, expm1, hypot, inf, sin
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.sim_ground.body import BodyPose, LinkPose, Three
from services.sim_ground.touching import EngineContact
from uvf.maths.kinematics import spin_velocity
from uvf.maths.rotations import rotate
from uvf.maths.wheels.tread import tread_forces, wheel_frame

Floats = NDArray[np.float64]
Push = tuple[int, Floats, Three]
"""Of a wheel: its link, the force (3,) [N, world] and where it acts (3,) [m, world]."""


class Rolling(NamedTuple):
    """How a vehicle moves: its root, its wheels, and the speeds [rad/s] at which they turn about their axles."""

    body: BodyPose
    wheels: Sequence[LinkPose]
    spins: Sequence[float]


class Treads:
    """Of a vehicle's wheels by their joints; axles (n, 3): in the wheels' axes of inertia; on_left: whose grip counts.

    grip: (n, 2) friction along and across [-]; along: the direction in which the wheel rolls, or turned from there by ``holds_at`` [rad].
    contact: length of the tread on the ground [m], which rolling renews; inf: of wheels that scrub anyway.
    """

    def __init__(
        self, wheels: Sequence[int], axles: Floats, grip: Floats, on_left: Sequence[bool], holds_at: Sequence[float], contact: float = inf
    ) -> None:
        self.wheels = tuple(wheels)
        self._contact = contact
        self._axles, self._grip, self._side = axles, grip, np.array([0 if left else 1 for left in on_left])
        self._turned = np.array([((cos(a), sin(a)), (-sin(a), cos(a))) for a in holds_at])
        self.deflections = np.zeros((len(wheels), 2))
        """Of the treads, along and across [m]: with the engine's state all that the next step depends on."""

    def pushes(self, contacts: Sequence[EngineContact], rolling: Rolling, shares: tuple[float, float], dt: float) -> list[Push]:
        """Friction of the next step of ``dt`` [s], by the loads of the one before.

        contacts: the vehicle's; shares: of their grip that the left and the right wheels have now.
        """
        touching = _by_wheel(contacts)
        n = len(self.wheels)
        slips, loads, frames, renewed = np.zeros((n, 2)), np.zeros(n), np.zeros((n, 2, 3)), np.zeros(n)
        root, body, turning = (np.array(v) for v in (rolling.body.position, rolling.body.velocity, rolling.body.angular_velocity))
        for i, (wheel, link, spin) in enumerate(zip(self.wheels, rolling.wheels, rolling.spins, strict=True)):
            if (mark := touching.get(wheel)) is None:
                continue
            axle, place = rotate(link.orientation, self._axles[i]), np.array(mark.place)
            frames[i] = self._turned[i] @ wheel_frame(axle, np.array(mark.normal))
            carried = body + spin_velocity(turning, place - root)
            slips[i] = frames[i] @ (carried + spin_velocity(spin * axle, place - link.position))
            loads[i] = mark.load
            renewed[i] = -expm1(-abs(frames[i, 0] @ carried) * dt / self._contact)
        forces = tread_forces(self.deflections, slips, loads, np.array(shares)[self._side, None] * self._grip, renewed, dt)
        return [(wheel, forces[i] @ frames[i], touching[wheel].place) for i, wheel in enumerate(self.wheels) if wheel in touching]


def _by_wheel(contacts: Sequence[EngineContact]) -> dict[int, EngineContact]:
    """One contact for each link that bears: the engine keeps several of one wheel that rolls, and shares its load among them."""
    found: dict[int, EngineContact] = {}
    for contact in (c for c in contacts if c.load > 0.0):
        if (other := found.get(contact.link)) is None:
            found[contact.link] = contact
            continue
        load = other.load + contact.load
        share = contact.load / load
        place, normal = _mean(other.place, contact.place, share), _unit(_mean(other.normal, contact.normal, share))
        found[contact.link] = contact._replace(place=place, normal=normal, load=load)
    return found


def _mean(one: Three, two: Three, share: float) -> Three:
    """Between the two, by the share of the second."""
    x, y, z = (a + (b - a) * share for a, b in zip(one, two, strict=True))
    return x, y, z


def _unit(vector: Three) -> Three:
    x, y, z = vector
    length = max(hypot(x, y, z), 1e-9)
    return x / length, y / length, z / length
