"""The ground below the scene."""

import numpy as np

from services.gcs.page.viser_ground import GROUND, plane


def test_the_ground_is_whole_and_its_triangles_are_small_where_the_worlds_are():
    """Drawn in software, two triangles 24 km long came out half a metre too high: the floor, the scan and the rover lay below."""
    vertices, faces = plane()
    corners = vertices[faces]
    u, v = corners[:, 1, :2] - corners[:, 0, :2], corners[:, 2, :2] - corners[:, 0, :2]
    areas = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    assert (areas > 0).all()
    assert areas.sum() / 2 == np.float32(24_000.0) ** 2
    assert (vertices[:, 2] == np.float32(GROUND)).all()
    near = np.abs(corners[..., :2]).max(axis=(1, 2)) <= 50
    assert areas[near].sum() / 2 == 100.0**2
    assert np.ptp(corners[near], axis=1).max() < 40
