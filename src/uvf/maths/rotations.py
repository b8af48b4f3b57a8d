"""Rotations: quaternions wxyz (Hamilton, unit), matrices, Euler angles Z-Y-X, and the two body conventions.

Names cancel: ``v_world = rotate(world_from_body, v_body)``.
"""

import math
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Number = TypeVar("Number", float, Floats)

IDENTITY: Floats = np.array((1.0, 0.0, 0.0, 0.0))
ENU_FROM_NED: Floats = np.array(((0.0, 1.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, -1.0)))
"""Swaps north and east and turns down into up; its own inverse."""
FLU_FROM_FRD: Floats = np.diag((1.0, -1.0, -1.0))
"""Turns right into left and down into up; its own inverse."""


def wrap(angle: float) -> float:
    """Angle [rad] wrapped into (-pi, pi]."""
    return float(-((np.pi - angle) % (2 * np.pi) - np.pi))


def multiply(p: Floats, q: Floats) -> Floats:
    """Hamilton product (4,) of two quaternions wxyz (4,): ``a_from_c = multiply(a_from_b, b_from_c)``."""
    pw, px, py, pz = p.tolist()
    qw, qx, qy, qz = q.tolist()
    return np.array(
        (
            pw * qw - px * qx - py * qy - pz * qz,
            pw * qx + px * qw + py * qz - pz * qy,
            pw * qy - px * qz + py * qw + pz * qx,
            pw * qz + px * qy - py * qx + pz * qw,
        )
    )


def inverse(q: Floats) -> Floats:
    """Inverse (4,) of a unit quaternion wxyz (4,): ``b_from_a`` of ``a_from_b``."""
    b_from_a: Floats = q * np.array((1.0, -1.0, -1.0, -1.0))
    return b_from_a


def rotate(a_from_b: Floats, v_b: Floats) -> Floats:
    """Vector (3,) of frame b in frame a, by the unit quaternion ``a_from_b`` wxyz (4,)."""
    v_a: Floats = matrix(a_from_b) @ v_b
    return v_a


def matrix(q: Floats) -> Floats:
    """Rotation matrix (3, 3) of a unit quaternion wxyz (4,)."""
    return np.array(_rows(*q.tolist()))


def matrices(q: Floats) -> Floats:
    """Rotation matrices ``a_from_b`` (n, 3, 3) of unit quaternions wxyz (n, 4)."""
    return np.moveaxis(np.array(_rows(*q.T)), 2, 0)


def _rows(w: Number, x: Number, y: Number, z: Number) -> tuple[tuple[Number, Number, Number], ...]:
    return (
        (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
        (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
    )


def from_matrix(r: Floats) -> Floats:
    """Unit quaternion wxyz (4,) of a rotation matrix (3, 3), w >= 0 (Shepperd 1978: divide by the largest component)."""
    trace = float(np.trace(r))
    squares = np.array((trace, r[0, 0], r[1, 1], r[2, 2]))
    i = int(np.argmax(squares))
    if i == 0:
        q = np.array((1 + trace, r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]))
    else:
        a, b, c = i - 1, i % 3, (i + 1) % 3
        q = np.zeros(4)
        q[0] = r[c, b] - r[b, c]
        q[1 + a] = 1 + r[a, a] - r[b, b] - r[c, c]
        q[1 + b] = r[b, a] + r[a, b]
        q[1 + c] = r[c, a] + r[a, c]
    q /= np.linalg.norm(q)
    return q if q[0] >= 0 else -q


def from_euler(roll: float, pitch: float, yaw: float) -> Floats:
    """Quaternion wxyz (4,) of yaw about z, then pitch about y, then roll about x [rad]."""
    cr, sr = math.cos(roll / 2), math.sin(roll / 2)
    cp, sp = math.cos(pitch / 2), math.sin(pitch / 2)
    cy, sy = math.cos(yaw / 2), math.sin(yaw / 2)
    return np.array(
        (
            cr * cp * cy + sr * sp * sy,
            sr * cp * cy - cr * sp * sy,
            cr * sp * cy + sr * cp * sy,
            cr * cp * sy - sr * sp * cy,
        )
    )


def from_axis(axis: Floats, angle: float) -> Floats:
    """Quaternion wxyz (4,) of a turn by ``angle`` [rad] about a unit axis (3,)."""
    return np.concatenate(((np.cos(angle / 2),), np.sin(angle / 2) * axis))


def to_euler(q: Floats) -> tuple[float, float, float]:
    """Euler angles (roll, pitch, yaw) [rad] of a quaternion wxyz (4,); pitch in [-pi/2, pi/2]."""
    w, x, y, z = q
    roll = np.arctan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
    pitch = np.arcsin(np.clip(2 * (w * y - z * x), -1.0, 1.0))
    yaw = np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
    return float(roll), float(pitch), float(yaw)


def level_from(a_from_b: Floats) -> Floats:
    """Quaternion wxyz (4,) of the tilt alone: of a frame that has b's heading and a's level, from b."""
    return multiply(from_euler(0.0, 0.0, -to_euler(a_from_b)[2]), a_from_b)


def enu_flu_from_ned_frd(ned_from_frd: Floats) -> Floats:
    """Attitude of the FLU body in ENU, as a quaternion wxyz (4,), from that of the FRD body in NED (4,).

    It serves the other way round as well, for both changes of axes are their own inverse.
    """
    return from_matrix(ENU_FROM_NED @ matrix(ned_from_frd) @ FLU_FROM_FRD)
