"""Friction of wheels that scrub: each tread sticks by a spring and a damper, and slips where the ground holds no more.

Dahl's model in the plane of the ground, as tyre models have it (Pacejka, Tire and Vehicle Dynamics, 3rd ed., 3.1 and 8.6): friction
opposes the slip whatever its direction, and a vehicle that stands does not creep. Engines that limit friction by two fixed directions
let a vehicle turn by where it heads.
"""

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.maths.geodesy import GRAVITY

Floats = NDArray[np.float64]

STIFFNESS = 75.0
"""rad/s, of the load upon the tread that springs on it: it gives by 1.7 mm until it slips."""
DAMPING = 0.7
MOST = 0.4
"""rad of that oscillation in one step; with longer steps the tread is softer."""


@compiled
def tread_forces(deflections: Floats, slips: Floats, loads: Floats, grip: Floats, renewed: Floats, dt: float) -> Floats:
    """Forces (n, 2) [N] of the ground on n treads, along and across each, after a step of ``dt`` [s].

    deflections: (n, 2) [m], of the treads until then, which are set anew; slips: (n, 2) [m/s], velocity of the treads against the
    ground; loads: (n,) [N]; grip: (n, 2) [-], friction coefficients along and across, 0 where the tread rolls freely; renewed: (n,) [-],
    share of the tread on the ground that rolling has renewed in the step: it takes no deflection across over.
    """
    forces = np.zeros_like(slips)
    rate = min(STIFFNESS, MOST / dt)
    for i in range(len(loads)):
        deflections[i, 1] *= 1.0 - renewed[i]
        mass, used = loads[i] / GRAVITY, 0.0
        for k in range(2):
            limit = grip[i, k] * loads[i]
            if limit <= 0.0:
                deflections[i, k] = 0.0
                continue
            deflections[i, k] += slips[i, k] * dt
            forces[i, k] = -mass * (rate * rate * deflections[i, k] + 2.0 * DAMPING * rate * slips[i, k])
            used += (forces[i, k] / limit) ** 2
        if used > 1.0:
            for k in range(2):
                forces[i, k] /= np.sqrt(used)
                deflections[i, k] = -forces[i, k] / (mass * rate * rate)
    return forces


def wheel_frame(axle: Floats, normal: Floats) -> Floats:
    """Rows (2, 3): along and across a wheel in the plane that it touches. axle (3,), to the left; normal (3,), away from the ground."""
    along = np.cross(axle, normal)
    along /= max(float(np.linalg.norm(along)), 1e-9)
    return np.array((along, np.cross(normal, along)))
