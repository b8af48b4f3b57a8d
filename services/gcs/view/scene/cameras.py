"""Where the scene is looked at from: views that fit what matters into the window."""

import numpy as np
from numpy.typing import NDArray

from services.gcs.state.session import VIEWS
from services.gcs.view.drawing import CameraView
from services.gcs.view.scene.scenery import extent
from uvf.models.scenario import Scenario

Floats = NDArray[np.float64]

FOV = 1.2  # rad, vertical
ASPECT = 0.95  # width by height, of a window that has not said its own
MARGIN = 0.9  # share of the window that the fitted things may fill
TILTED = 0.94  # of the width: a camera turned up sees what is near at its lower edge larger
LOW = 0.04  # rad between the lower edge of the window and what is fitted


def direction(azimuth: float, elevation: float) -> Floats:
    """Unit vector of sight (3,) of a camera that stands at ``azimuth`` (from east, left positive) and ``elevation`` [rad]."""
    flat = np.cos(elevation)
    return -np.array((flat * np.cos(azimuth), flat * np.sin(azimuth), np.sin(elevation)))


def _axes(sight: Floats) -> tuple[Floats, Floats]:
    """(right, up) of a camera that keeps its horizon level."""
    level = np.cross(sight, (0.0, 0.0, 1.0))
    right = (level / np.linalg.norm(level)).astype(np.float64)
    return right, np.cross(right, sight).astype(np.float64)


def fit(points: Floats, sight: Floats, aspect: float) -> CameraView:
    """The nearest camera that looks along ``sight`` (3,) and sees all points.

    points: (n, 3) [m, world]; aspect: width over height [-].
    """
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    right, up = _axes(sight)
    x, y, z = (points - middle) @ right, (points - middle) @ up, (points - middle) @ sight
    tall = MARGIN * np.tan(FOV / 2)
    distance = float(np.max(np.maximum(np.abs(x) / (tall * aspect), np.abs(y) / tall) - z))
    return _camera(middle - distance * sight, sight, distance)


def tilted_up(camera: CameraView, points: Floats) -> CameraView:
    """The camera turned up until the points (n, 3) [m, world] lie at the window's lower edge: room for the sky above them."""
    position, look_at = np.array(camera.position), np.array(camera.look_at)
    distance = float(np.linalg.norm(look_at - position))
    sight = (look_at - position) / distance
    up = _axes(sight)[1]
    below = float(np.min(np.arctan2((points - position) @ up, (points - position) @ sight)))
    turn = max(0.0, FOV / 2 - LOW + below)
    return _camera(position, np.cos(turn) * sight + np.sin(turn) * up, distance)


def _camera(position: Floats, sight: Floats, distance: float) -> CameraView:
    x, y, z = (float(c) for c in position)
    u, v, w = (float(c) for c in position + distance * sight)
    return CameraView((x, y, z), (u, v, w))


def cameras(site: Scenario, aspect: float = ASPECT) -> dict[str, CameraView]:
    """Named views for a window of ``aspect``, width over height [-].

    The first is the initial one: the floor before the sky, if the mission has aircraft.
    """
    x_min, y_min, x_max, y_max = site.world.floor
    floor = np.array([(x, y, z) for x in (x_min, x_max) for y in (y_min, y_max) for z in (0.0, 0.5)])
    low, high = extent(site)
    everything = np.array([(x, y, z) for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])])
    near = fit(floor, direction(-1.85, 0.47), TILTED * aspect)
    views = (
        tilted_up(near, floor) if any(site.of_kind("fixed_wing")) else near,
        fit(everything, direction(-1.85, 0.5), aspect),
        fit(floor, direction(-np.pi / 2, 1.56), aspect),
    )
    return dict(zip(VIEWS, views, strict=False))
