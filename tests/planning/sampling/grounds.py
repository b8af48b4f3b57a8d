"""Ground for sampling planners, and an independent look at the paths that they find."""

import numpy as np
import pytest

from uvf.planning.sampling import Ground, clearance_field, disc

SIDE = 0.1  # m


def blocks(seed, body=None):
    """20 x 12 m with boxes that leave the corners free."""
    rng, occupied = np.random.default_rng(seed), np.zeros((120, 200), dtype=bool)
    for _ in range(30):
        row, column, height, width = *rng.integers((0, 0), (120, 200)), *rng.integers(4, 25, 2)
        occupied[row : row + height, column : column + width] = True
    occupied[:25, :25] = occupied[-25:, -25:] = False
    return Ground(clearance_field(occupied, SIDE), body or disc(0.15))


def wall(gap, body=None):
    """10 x 10 m in two halves; ``gap``: cells of the wall at x = 5 m that are left out."""
    occupied = np.zeros((100, 100), dtype=bool)
    occupied[:, 49:52] = True
    occupied[gap, 49:52] = False
    return Ground(clearance_field(occupied, SIDE), body or disc(0.15))


def check(ground, space, path, start, goal):
    """Every point at a tenth of a cell is free, curves are no tighter than allowed, all is joined, both ends are there."""
    found = path.sampled(0.1 * ground.field.resolution)
    for offset, radius in zip(ground.body.offsets, ground.body.radii, strict=True):
        x, y = found[:, 0] + offset * np.cos(found[:, 2]), found[:, 1] + offset * np.sin(found[:, 2])
        rows = np.floor((y - ground.field.y) / ground.field.resolution).astype(int)
        columns = np.floor((x - ground.field.x) / ground.field.resolution).astype(int)
        assert (ground.field.values[rows, columns] >= np.float32(radius) - 1e-6).all()
    assert found[0, :2] == pytest.approx(start[:2], abs=1e-9) and found[-1, :2] == pytest.approx(goal[:2], abs=1e-9)
    steps = np.hypot(*np.diff(found[:, :2], axis=0).T)
    assert steps.max() <= 0.1 * ground.field.resolution * (1 + 1e-9)
    assert path.length == pytest.approx(steps.sum(), rel=1e-3)
    if space.radius:
        turn = np.abs(np.mod(np.diff(found[:, 2]) + np.pi, 2 * np.pi) - np.pi)
        assert (turn <= steps / space.radius * (1 + 1e-3) + 1e-9).all()
        for at, end in ((found[0], start), (found[-1], goal)):
            assert abs(np.mod(at[2] - end[2] + np.pi, 2 * np.pi) - np.pi) < 1e-9
        moving = steps > 1e-9
        ahead = np.einsum("ij,ij->i", np.diff(found[:, :2], axis=0), np.column_stack((np.cos(found[1:, 2]), np.sin(found[1:, 2]))))
        assert (np.sign(ahead[moving]) == found[1:, 3][moving]).all()
