"""How far what one session tells of a place is what the other one has seen there.

Corridors of the same width match along their walls wherever one lays them; doors, corners and ends tell which is which. So surfaces
count by their directions: what is asked is the part confirmed along that direction in which the least of it is.
"""

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.maths.se2 import Pose2, compose, inverse
from uvf.slam.matching.imls import offsets
from uvf.slam.matching.visibility import Rays
from uvf.slam.merging.part import VehicleMap

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]

SAME = 0.1
"""m from a surface up to which a point lies on it: what poses within a session, and the surfaces between its points, leave open."""
FAR = 10.0  # m, what is seen from farther away is not known that well
FACING = 0.2  # least cosine between a surface's normal and the way to the lidar that is to have seen it
HIDDEN, HIDDEN_SLOPE = 0.35, 0.02
"""m and m/m of range: what lies farther behind a beam's end is hidden from it."""


def confirmed_part(told: Floats, confirmed: Floats) -> float:
    """Part, 0 to 1, of ``told`` (2, 2), a sum of outer products of normals, that ``confirmed`` (2, 2) has along its weakest direction."""
    values, axes = np.linalg.eigh(told)
    if values[0] <= 0.0:
        return 0.0
    whiten = axes / np.sqrt(values)
    return float(np.linalg.eigvalsh(whiten.T @ confirmed @ whiten)[0])


def of_place(a: VehicleMap, i: int, b: VehicleMap, j: int, i_from_j: Pose2) -> tuple[Floats, Floats]:
    """Sums (told, confirmed) of outer products of normals, each (2, 2) in the frame of i.

    Of keyframes around j where those around i have looked, and the other way round.
    """
    one, back = _told(a, i, b, j, i_from_j), _told(b, j, a, i, inverse(i_from_j))
    c, s = np.cos(i_from_j.yaw), np.sin(i_from_j.yaw)
    turn = np.array(((c, -s), (s, c)))
    return one[0] + turn @ back[0] @ turn.T, one[1] + turn @ back[1] @ turn.T


def _told(a: VehicleMap, i: int, b: VehicleMap, j: int, i_from_j: Pose2) -> tuple[Floats, Floats]:
    submap, others = a.nodes.submap(i), b.nodes.submap(j)
    told, same = np.zeros((2, 2)), np.zeros((2, 2))
    looking = [(a.nodes.all[m].rays, inverse(submap.anchor_from_member[m - submap.members[0]])) for m in submap.members[::2]]
    for m in others.members[::3]:
        cloud = b.nodes.still(m)
        near = cloud.flat & (np.hypot(*cloud.points.T) < FAR)
        placed = cloud.moved(compose(i_from_j, others.anchor_from_member[m - others.members[0]]))
        points, normals = placed.points[near], placed.normals[near]
        looked = np.zeros(len(points), dtype=np.bool_)
        for rays, member_from_i in looking:
            _look(points, normals, member_from_i, rays, looked)
        points, normals = points[looked], normals[looked]
        agree = normals[np.abs(offsets(points, normals, submap.surfaces)) < SAME]
        told += normals.T @ normals
        same += agree.T @ agree
    return told, same


@compiled
def _look(points: Floats, normals: Floats, base_from_points: tuple[float, float, float], rays: Rays, looked: Mask) -> None:
    """Marks the surfaces that a sweep would have met, had they been there: that face the lidar, and are not hidden behind what it met."""
    origin, bearings, ranges = rays
    last = bearings.shape[0] - 1
    if last < 1:
        return
    width = 1.5 * (bearings[last] - bearings[0]) / last
    c, s = np.cos(base_from_points[2]), np.sin(base_from_points[2])
    for i in range(points.shape[0]):
        dx = c * points[i, 0] - s * points[i, 1] + base_from_points[0] - origin[0]
        dy = s * points[i, 0] + c * points[i, 1] + base_from_points[1] - origin[1]
        rho = np.sqrt(dx * dx + dy * dy)
        towards = -(c * normals[i, 0] - s * normals[i, 1]) * dx - (s * normals[i, 0] + c * normals[i, 1]) * dy
        if looked[i] or rho > FAR or towards < FACING * rho:
            continue
        angle = bearings[0] + (np.arctan2(dy, dx) - bearings[0]) % (2.0 * np.pi)
        k = np.searchsorted(bearings, angle)
        for m in range(max(0, k - 1), min(last, k) + 1):
            if abs(bearings[m] - angle) <= width and ranges[m] > rho - HIDDEN - HIDDEN_SLOPE * rho and ranges[m] > 0.0:
                looked[i] = True
