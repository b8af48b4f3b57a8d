"""A footprint's radii, its padding, and the headings in which it touches obstacles, against the geometry itself."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from uvf.planning.costmap.footprint import RobotFootprint
from uvf.planning.costmap.headings import HEADINGS, STEP, blocked_headings, heading_bin

JACKAL = RobotFootprint.polygon(np.array(((0.254, 0.216), (-0.254, 0.216), (-0.254, -0.216), (0.254, -0.216))))
WEDGE = RobotFootprint.polygon(np.array(((0.6, 0.0), (-0.1, 0.3), (-0.1, -0.2))))
RESOLUTION = 0.05


def test_radii_of_a_rectangle_and_of_a_circle():
    assert JACKAL.inscribed_radius == pytest.approx(0.216)
    assert JACKAL.circumscribed_radius == pytest.approx(np.hypot(0.254, 0.216))
    circle = RobotFootprint.circle(0.3)
    assert circle.inscribed_radius == pytest.approx(0.3) and circle.circumscribed_radius == pytest.approx(0.3)


def test_padding_moves_every_side_outwards():
    wider = WEDGE.padded(0.05)
    assert wider.inscribed_radius == pytest.approx(WEDGE.inscribed_radius + 0.05)
    assert wider.sides()[:, 2] == pytest.approx(np.array([d + 0.05 for d in WEDGE.sides()[:, 2]]))
    rounder = RobotFootprint.circle(0.3).padded(0.1)
    assert rounder.round and rounder.circumscribed_radius == pytest.approx(0.4)


@pytest.mark.parametrize(
    ("points", "why"),
    [
        (np.zeros((2, 2)), "three or more points"),
        (np.array(((0, 0), (1, 1), (2, 2.0))), "lie in a line"),
        (np.array(((1, 1), (2, 1), (1, 2.0))), "must lie inside"),
        (np.array(((np.nan, 1), (2, 1), (1, 2.0))), "finite"),
    ],
)
def test_what_is_no_footprint_is_refused(points, why):
    with pytest.raises(ValueError, match=why):
        RobotFootprint.polygon(points)


@pytest.mark.parametrize("radius", [0.0, -1.0, np.nan, np.inf])
def test_a_circle_needs_a_radius(radius):
    with pytest.raises(ValueError, match="radius"):
        RobotFootprint.circle(radius)


def touches(footprint, occupied, cell, yaw):
    """By the sides' half planes, for every occupied cell's centre."""
    rows, columns = np.nonzero(occupied)
    dx, dy = (columns - cell[1]) * RESOLUTION, (rows - cell[0]) * RESOLUTION
    in_base = np.stack((np.cos(yaw) * dx + np.sin(yaw) * dy, np.cos(yaw) * dy - np.sin(yaw) * dx))
    sides = footprint.sides()
    return (sides[:, :2] @ in_base <= sides[:, 2:]).all(axis=0).any()


@pytest.mark.parametrize("footprint", [JACKAL, WEDGE, RobotFootprint.circle(0.31)], ids=["rectangle", "wedge", "circle"])
def test_a_heading_is_shut_where_the_outline_covers_an_obstacle(footprint):
    rng = np.random.default_rng(4)
    occupied = rng.random((60, 60)) < 0.02
    occupied[20:26, 20:26] = True  # with an inside
    blocked = blocked_headings(occupied, RESOLUTION, footprint)
    shut = free = 0
    for _ in range(3000):
        cell, yaw = tuple(rng.integers(0, 60, 2)), rng.uniform(-7.0, 7.0)
        bit = bool(int(blocked[cell]) >> heading_bin(yaw) & 1)
        if touches(footprint, occupied, cell, yaw):
            assert bit
            shut += 1
        elif bit:  # at another heading of the same bin then
            inside = STEP / 2 * np.linspace(-1.0, 1.0, 9) + heading_bin(yaw) * STEP
            assert any(touches(footprint.padded(0.003), occupied, cell, other) for other in inside) or occupied[cell]
        else:
            free += 1
    assert shut > 100 and free > 100


@given(st.floats(-50.0, 50.0))
def test_bins_of_headings_wrap(yaw):
    found = heading_bin(yaw)
    assert 0 <= found < HEADINGS
    assert abs(np.angle(np.exp(1j * (yaw - found * STEP)))) <= STEP / 2 + 1e-9
