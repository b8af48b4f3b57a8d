"""How sure an estimate is: the ellipse that holds the vehicle with 95 %, and the particles that localize it."""

import numpy as np
from numpy.typing import NDArray

from schemas.messages import EstimateQuality, FrameTransform, MapFix, PosesInFrame
from services.gcs.view.drawing import Colour, Points, Polyline
from uvf.maths.rotations import matrix, to_euler
from uvf.runtime.messages.convert import array, wxyz

Floats = NDArray[np.float64]

SURE: Colour = (245, 170, 40)
PARTICLE: Colour = (240, 90, 200)
CORNERS = 49
WITHIN = np.sqrt(5.991)  # standard deviations that hold 95 % of a normal distribution in the plane
FARTHEST = 1000.0  # m: a larger ellipse tells nothing


def covariance_of(fix: MapFix | None, quality: EstimateQuality | None, world_from_map: FrameTransform | None) -> Floats | None:
    """Covariance (2, 2) [m^2, world] of a vehicle's place; None where nobody says it, or says what is none."""
    if fix is not None and len(fix.covariance) == 9:
        in_map = np.array(fix.covariance).reshape(3, 3)[:2, :2]
        turn = matrix(wxyz(world_from_map.rotation))[:2, :2] if world_from_map is not None else np.eye(2)
        covariance: Floats = turn @ in_map @ turn.T
    elif quality is not None and quality.position_known:
        covariance = np.eye(2) * quality.position_sigma**2
    else:
        return None
    return covariance if np.isfinite(covariance).all() else None


def ellipse(covariance: Floats, z: float) -> Polyline | None:
    """The ellipse around the origin at height ``z`` [m]; None where it would be no ellipse or larger than a world."""
    values, vectors = np.linalg.eigh((covariance + covariance.T) / 2)
    if values[0] < 0 or WITHIN * np.sqrt(values[1]) > FARTHEST:
        return None
    turn = np.linspace(0.0, 2 * np.pi, CORNERS)
    flat = (WITHIN * np.sqrt(values) * np.column_stack((np.cos(turn), np.sin(turn)))) @ vectors.T
    return Polyline(np.column_stack((flat, np.full(CORNERS, z))), SURE, 2.0)


def cloud(particles: PosesInFrame, world_from_map: FrameTransform | None, z: float) -> Points:
    """The particles' places at height ``z`` [m]."""
    flat = np.array([(p.position.x, p.position.y) for p in particles.poses]).reshape(-1, 2)
    if world_from_map is not None:
        yaw = to_euler(wxyz(world_from_map.rotation))[2]
        turn = np.array(((np.cos(yaw), -np.sin(yaw)), (np.sin(yaw), np.cos(yaw))))
        flat = flat @ turn.T + array(world_from_map.translation)[:2]
    return Points(np.column_stack((flat, np.full(len(flat), z))), PARTICLE, 0.05)
