"""Markers that a vehicle has found: a ring about each, as wide as its place is unsure."""

import numpy as np

from schemas.messages import Detection
from services.gcs.view.drawing import Colour, Polyline

FOUND: Colour = (214, 30, 180)
LEAST_RADIUS = 0.5  # m, to be seen
CORNERS = 25
MOST = 100


def ring_about(found: Detection) -> Polyline:
    """The ring of one sigma at the height of the marker's middle."""
    radius = min(max(found.sigma, LEAST_RADIUS), 10 * LEAST_RADIUS)
    turn = np.linspace(0.0, 2 * np.pi, CORNERS)
    x, y, z = found.position.x, found.position.y, found.position.z
    return Polyline(np.column_stack((x + radius * np.cos(turn), y + radius * np.sin(turn), np.full(CORNERS, z))), FOUND, 3.0)
