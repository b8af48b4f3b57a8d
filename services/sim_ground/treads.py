"""The treads of driven wheels that scrub or have rollers, with friction of their own: the engine's is not for them."""

from collections.abc import Sequence
from math import cos, sin

import numpy as np
from numpy.typing import NDArray

from services.sim_ground.body import LinkMotion, Three
from services.sim_ground.touching import EngineContact
from uvf.maths.kinematics import spin_velocity
from uvf.maths.rotations import rotate
from uvf.maths.wheels.tread import tread_forces, wheel_frame

Floats = NDArray[np.float64]
Push = tuple[int, Floats, Three]
"""Of a wheel: its link, the force (3,) [N, world] and where it acts (3,) [m, world]."""


class Treads:
    """Of a vehicle's driven wheels by their joints; axles (n, 3): in the wheels' axes of inertia.

    grip: friction along and across [-]; along: the direction in which the wheel rolls, or turned from there by ``holds_at`` [rad].
    """

    def __init__(self, wheels: Sequence[int], axles: Floats, grip: tuple[float, float], holds_at: Sequence[float] = ()) -> None:
        self._wheels, self._axles, self._grip = tuple(wheels), axles, grip
        self._turned = np.array([((cos(a), sin(a)), (-sin(a), cos(a))) for a in holds_at or (0.0,) * len(wheels)])
        self.deflections = np.zeros((len(wheels), 2))
        """Of the treads, along and across [m]: with the engine's state all that the next step depends on."""

    def pushes(self, contacts: Sequence[EngineContact], links: Sequence[LinkMotion], shares: Sequence[float], dt: float) -> list[Push]:
        """Friction of the next step of ``dt`` [s], by the loads of the one before.

        contacts: the vehicle's; links: the wheels'; shares: of its grip that each wheel has now.
        """
        touching = {c.link: c for c in sorted(contacts, key=lambda c: c.load) if c.load > 0.0}
        n = len(self._wheels)
        slips, loads, frames = np.zeros((n, 2)), np.zeros(n), np.zeros((n, 2, 3))
        for i, (wheel, link) in enumerate(zip(self._wheels, links, strict=True)):
            if (mark := touching.get(wheel)) is None:
                continue
            frames[i] = self._turned[i] @ wheel_frame(rotate(link.orientation, self._axles[i]), np.array(mark.normal))
            slips[i] = frames[i] @ (link.velocity + spin_velocity(link.angular_velocity, np.array(mark.place) - link.position))
            loads[i] = mark.load
        forces = tread_forces(self.deflections, slips, loads, np.multiply.outer(np.array(shares), np.array(self._grip)), dt)
        return [(wheel, forces[i] @ frames[i], touching[wheel].place) for i, wheel in enumerate(self._wheels) if wheel in touching]
