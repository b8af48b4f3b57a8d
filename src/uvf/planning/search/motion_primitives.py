"""Motion primitives of Hybrid-A*: arcs and straights, each the same length, which lead from heading bin to heading bin.

As Nav2's Smac planner chooses them: a turn covers whole bins and its chord is longer than a cell's diagonal, so that each leaves its cell.
"""

from dataclasses import dataclass
from math import asin, ceil, isfinite, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.curves.segments import checked_radius
from uvf.planning.costmap.headings import HEADINGS, STEP

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

SPACING = 0.6
"""Cells between the poses that are checked, at most."""


@dataclass(frozen=True)
class SteeredVehicle:
    """How a vehicle may move, and what that costs; Nav2's Smac parameters of the same names.

    Penalties are factors on a motion's cost, 1 or more, ``change_penalty`` 0 or more. Raises ValueError for others.
    """

    minimum_turning_radius: float
    """m."""
    reverses: bool
    """Reeds-Shepp and differential vehicles; else it only drives forwards (Dubins)."""
    reverse_penalty: float = 2.0
    change_penalty: float = 0.0
    """Added to the factor of a turn that follows a turn to the other side."""
    non_straight_penalty: float = 1.2

    def __post_init__(self) -> None:
        """Checks the figures."""
        checked_radius(self.minimum_turning_radius)
        for name, least in (("reverse_penalty", 1.0), ("change_penalty", 0.0), ("non_straight_penalty", 1.0)):
            value = getattr(self, name)
            if not (isfinite(value) and value >= least):
                raise ValueError(f"{name}: {value}; a finite number of {least:g} or more is needed")


class Moves(NamedTuple):
    """The primitives: ``curvature`` (p,) [1/cell], ``length`` signed (p,) [cells], ``turn`` (p,) [bins], ``price`` (p,) factor on the
    length, ``shape`` (64, p, n, 3) where the poses lie from the start: dx, dy [cells] and the yaw itself [rad], the last pose being
    the end."""

    curvature: Floats
    length: Floats
    turn: Ints
    price: Floats
    shape: Floats


def motion_primitives(vehicle: SteeredVehicle, resolution: float) -> Moves:
    """Primitives on cells of ``resolution`` [m]; left, straight, right, and the same backwards. Yaws are those of the bins."""
    radius = max(vehicle.minimum_turning_radius / resolution, 1.0)  # a chord over a cell's diagonal needs no tighter circle
    bins = max(ceil(2.0 * asin(sqrt(0.5) / radius) / STEP), 1)
    arc = bins * STEP * radius
    ways = (1.0, -1.0) if vehicle.reverses else (1.0,)
    lines = [(way * arc, side / radius) for way in ways for side in (1.0, 0.0, -1.0)]
    length, curvature = np.array(lines).T
    turn = np.rint(length * curvature / STEP).astype(np.int64)
    price = np.where(curvature == 0.0, 1.0, vehicle.non_straight_penalty) * np.where(length < 0.0, vehicle.reverse_penalty, 1.0)
    return Moves(np.ascontiguousarray(curvature), np.ascontiguousarray(length), turn, price, shapes(length, curvature, 0.0))


def shapes(length: Floats, curvature: Floats, residual: float) -> Floats:
    """(64, p, n, 3) poses along primitives (p,) that begin in each bin's heading plus ``residual`` [rad]."""
    n = max(ceil(float(np.abs(length).max()) / SPACING), 2)
    s = length[:, None] * (np.arange(1, n + 1) / n)
    half = 0.5 * curvature[:, None] * s
    chord = s * np.sinc(half / np.pi)
    begin = (np.arange(HEADINGS) * STEP + residual)[:, None, None]
    return np.stack((chord * np.cos(begin + half), chord * np.sin(begin + half), begin + 2.0 * half), axis=-1)
