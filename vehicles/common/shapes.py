"""Draws the meshes of the vehicles here (binary STL, m): python vehicles/common/shapes.py"""

from pathlib import Path

import numpy as np
import trimesh

VEHICLES = Path(__file__).resolve().parents[1]
TURN = np.linspace(0, 2 * np.pi, 32, endpoint=False)


def slab(centres: list[tuple[float, float]], radius: float, z: tuple[float, float], taper: float = 0.0) -> trimesh.Trimesh:
    """A convex slab from z[0] to z[1] with rounded corners about ``centres``; the upper edge is drawn in by ``taper`` [m]."""
    rings = [(np.array(centre), r, h) for centre in centres for r, h in ((radius, z[0]), (radius - taper, z[1]))]
    points = [np.column_stack((c[0] + r * np.cos(TURN), c[1] + r * np.sin(TURN), np.full(len(TURN), h))) for c, r, h in rings]
    return trimesh.PointCloud(np.vstack(points)).convex_hull


def corners(x: float, y: float) -> list[tuple[float, float]]:
    """The corners [m] of a rectangle that reaches ``x`` ahead and ``y`` to the side."""
    return [(x, y), (-x, y), (-x, -y), (x, -y)]


def main() -> None:
    """Writes all meshes."""
    made = {
        "my2bot/meshes/deck.stl": slab(corners(0.095, 0.060), 0.025, (-0.0025, 0.0025)),
        "my3bot/meshes/storey.stl": slab([(0.045, 0.075), (0.045, -0.075), (-0.150, 0.0)], 0.050, (-0.003, 0.003)),
        "mybot05/meshes/tub.stl": slab(corners(0.255, 0.135), 0.055, (0.0, 0.10), taper=0.03),
    }
    for name, mesh in made.items():
        mesh.export(VEHICLES / name)


if __name__ == "__main__":
    main()
