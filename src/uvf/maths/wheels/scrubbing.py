"""How a vehicle turns whose wheels scrub: about which point, and as which two wheels.

Wheels that cannot be steered slip across, and along, when it turns. At low speed the ground's friction, of one size whatever the
direction, leaves the motion that dissipates least (Alexander and Maddocks, On the kinematics of wheeled mobile robots, 1989), and that
is a rotation about a point that does not depend on the speeds (Mandow et al., Experimental kinematics for wheeled skid-steer mobile
robots, 2007).
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
ROUNDS = 500
STILL = 1e-9  # of the treads' speed, below which a wheel rolls without slip


class Scrubbing(NamedTuple):
    """track: of the two wheels that turn as all of them do [m]; pivot: x, y [m] of the point that moves as the middle of their axle."""

    track: float
    pivot: tuple[float, float]


def scrubbing(wheels: Floats, loads: Floats) -> Scrubbing:
    """Of wheels at (n, 2) [m], the left ones at larger y than the right ones, under loads (n,) [any unit].

    The treads run at 1 m/s, backwards on the left: of all motions (v_x, v_y, w) the one with the least sum of load times slip, by
    least squares weighted anew by the slip. Four wheels of track b and wheelbase l under equal loads give b + l^2 / b.
    """
    x, y = wheels.T
    treads = np.where(y > np.median(y), -1.0, 1.0)
    zero, one = np.zeros(len(x)), np.ones(len(x))
    rows = np.concatenate((np.column_stack((one, zero, -y)), np.column_stack((zero, one, x))))
    wanted = np.concatenate((treads, zero))
    slip = one
    for _ in range(ROUNDS):
        weights = np.sqrt(np.tile(loads / np.maximum(slip, STILL), 2))
        motion = np.linalg.lstsq(rows * weights[:, None], wanted * weights, rcond=None)[0]
        slip = np.hypot(*(rows @ motion - wanted).reshape(2, -1))
    v_x, v_y, turn = motion.tolist()
    return Scrubbing(2.0 / turn, (-v_y / turn, v_x / turn))


def shared_loads(wheels: Floats, centre_of_mass: Floats) -> Floats:
    """Loads (n,), 1 together, of wheels at (n, 2) [m] that give alike under a body with its mass above (2,) [m]; none is below 0."""
    rows = np.column_stack((np.ones(len(wheels)), wheels))
    planes = np.linalg.lstsq(rows.T @ rows, np.array((1.0, *centre_of_mass)), rcond=None)[0]
    loads = np.maximum(rows @ planes, 0.0)
    shares: Floats = loads / loads.sum()
    return shares
