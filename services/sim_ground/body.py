"""What is known of a ground vehicle's body at one moment."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled

Floats = NDArray[np.float64]
Three = tuple[float, float, float]
Four = tuple[float, float, float, float]
Motion = tuple[Floats, Floats, Floats, Floats]
"""The first four fields of ``BodyState``."""


class Touch(NamedTuple):
    """A contact. other: name of what is touched; bearing: its direction [rad] from the body's x axis, counter-clockwise."""

    other: str
    bearing: float


class LinkPose(NamedTuple):
    """Of a link's centre of mass in the world: position (3,) [m], orientation (4,)."""

    position: Floats
    orientation: Floats


class BodyPose(NamedTuple):
    """Of a body's centre of mass in the world: position (3,) [m], orientation xyzw (4,); velocity [m/s], angular velocity [rad/s]."""

    position: Three
    xyzw: Four
    velocity: Three
    angular_velocity: Three


class BodyState(NamedTuple):
    """Motion of base_link: the point on the floor under the axle's middle.

    position: (3,) m, world; velocity: (3,) m/s, world; world_from_body: wxyz; angular_velocity: (3,) rad/s, body (FLU);
    wheel_angles: of each driven wheel, as its file has them [rad] since the start, unwrapped; wheel_speeds likewise [rad/s];
    steered_to: of each joint that steers [rad], as the URDF counts; joints: of all others that move, positions [rad or m] and speeds.
    """

    position: Floats
    world_from_body: Floats
    velocity: Floats
    angular_velocity: Floats
    wheel_angles: tuple[float, ...]
    wheel_speeds: tuple[float, ...]
    steered_to: tuple[float, ...] = ()
    joints: tuple[tuple[float, float], ...] = ()


@compiled
def base_motion(
    com: Three, world_from_com_xyzw: Four, com_velocity: Three, angular: Three, com_in_base: Floats, base_from_com: Floats
) -> Motion:
    """The motion of base_link from the engine's motion of the centre of mass.

    com (3,) [m], com_velocity (3,) [m/s], angular (3,) [rad/s], world_from_com_xyzw (4,), all world; com_in_base: (3,) [m],
    base_from_com: (4,) wxyz.
    """
    bx, by, bz, bw = world_from_com_xyzw
    cw, cx, cy, cz = base_from_com[0], -base_from_com[1], -base_from_com[2], -base_from_com[3]
    w = bw * cw - bx * cx - by * cy - bz * cz
    x = bw * cx + bx * cw + by * cz - bz * cy
    y = bw * cy - bx * cz + by * cw + bz * cx
    z = bw * cz + bx * cy - by * cx + bz * cw
    r = np.array(
        (
            (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
            (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
            (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
        )
    )
    position, velocity, turning = np.empty(3), np.empty(3), np.empty(3)
    ax = r[0, 0] * com_in_base[0] + r[0, 1] * com_in_base[1] + r[0, 2] * com_in_base[2]
    ay = r[1, 0] * com_in_base[0] + r[1, 1] * com_in_base[1] + r[1, 2] * com_in_base[2]
    az = r[2, 0] * com_in_base[0] + r[2, 1] * com_in_base[1] + r[2, 2] * com_in_base[2]
    p, q, s = angular
    position[0], position[1], position[2] = com[0] - ax, com[1] - ay, com[2] - az
    velocity[0] = com_velocity[0] - (q * az - s * ay)
    velocity[1] = com_velocity[1] - (s * ax - p * az)
    velocity[2] = com_velocity[2] - (p * ay - q * ax)
    for i in range(3):
        turning[i] = r[0, i] * p + r[1, i] * q + r[2, i] * s
    return position, np.array((w, x, y, z)), velocity, turning
