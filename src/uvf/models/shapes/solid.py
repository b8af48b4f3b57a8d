"""A rigid shape with a pose and a colour: what worlds are built of and what vehicles' links look like and touch with."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from uvf.maths.rotations import IDENTITY, from_euler

Floats = NDArray[np.float64]
Colour = tuple[float, float, float]


@dataclass(frozen=True)
class Solid:
    """One shape in the frame of whatever it belongs to: the world, or a vehicle's link.

    size [m]: box (x, y, z), cylinder (radius, height along z), sphere (radius,); mesh (scale x, y, z) [-].
    position: (3,) [m], of the middle, for a mesh of its file's origin; orientation: wxyz (4,).
    """

    name: str
    shape: Literal["box", "cylinder", "sphere", "mesh"]
    size: tuple[float, ...]
    position: Floats
    orientation: Floats = field(default_factory=IDENTITY.copy)
    colour: Colour = (0.6, 0.6, 0.6)
    mesh: Path | None = None
    path: "Keyframes | None" = None


@dataclass(frozen=True)
class Keyframes:
    """A scripted motion that starts over at its end. keys: (n, 4) t [s], x, y [m], yaw [rad]; t rises from 0."""

    keys: Floats

    def at(self, t: float) -> tuple[float, float, float]:
        """Pose x, y [m], yaw [rad] at simulation time ``t`` [s]: straight between the keys, the yaw as written, not by the shorter way."""
        time = t % self.keys[-1, 0]
        x, y, yaw = (float(np.interp(time, self.keys[:, 0], column)) for column in self.keys[:, 1:].T)
        return x, y, yaw

    def velocity(self, t: float) -> tuple[float, float, float]:
        """Velocity x, y [m/s] and yaw rate [rad/s] between the keys around simulation time ``t`` [s]."""
        time = t % self.keys[-1, 0]
        i = min(int(np.searchsorted(self.keys[:, 0], time, side="right")), len(self.keys) - 1)
        dt, *moved = self.keys[i] - self.keys[i - 1]
        x, y, yaw = (float(m / dt) for m in moved)
        return x, y, yaw


def pose_at(solid: Solid, t: float) -> tuple[Floats, Floats]:
    """Position (3,) [m] and orientation wxyz (4,) of a solid of the world at simulation time ``t`` [s]."""
    if solid.path is None:
        return solid.position, solid.orientation
    x, y, yaw = solid.path.at(t)
    return np.array((x, y, solid.position[2])), from_euler(0.0, 0.0, yaw)
