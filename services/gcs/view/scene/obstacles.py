"""What moves around a vehicle, and where it will be: a ring where it is, and one where its speed takes it."""

import numpy as np
from numpy.typing import NDArray

from schemas.messages import MovingObstacle
from services.gcs.view.drawing import Colour, Polyline

Floats = NDArray[np.float64]

MOVING: Colour = (255, 120, 60)
AHEAD = 2.0  # s
CORNERS = 25
MOST = 50


def predicted(obstacle: MovingObstacle, z: float) -> Polyline:
    """Both rings and the way between them, at height ``z`` [m], drawn in one stroke."""
    now = np.array((obstacle.position.x, obstacle.position.y))
    way = AHEAD * np.array((obstacle.velocity.x, obstacle.velocity.y))
    turn = np.arctan2(way[1], way[0]) + np.linspace(0.0, 2 * np.pi, CORNERS)
    ring = max(obstacle.radius, 0.02) * np.column_stack((np.cos(turn), np.sin(turn)))
    flat = np.vstack((now + ring, now + way + ring))
    return Polyline(np.column_stack((flat, np.full(len(flat), z))), MOVING, 2.5)
