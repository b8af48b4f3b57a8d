"""What floor a body of any outline can come to, and whether it stands free."""

import numpy as np
import pytest

from uvf.maths.se2 import Pose2
from uvf.models.world.file import Box, Cylinder, Origin, WorldFile
from uvf.models.world.footing import Footing
from uvf.models.world.geometry import around, floor_plan, free_regions, reachable_floor
from uvf.models.world.reach import covered_floor

LONG = np.array(((0.5, 0.15), (-0.3, 0.15), (-0.3, -0.15), (0.5, -0.15)))[::-1]
LONG = LONG[np.argsort(np.arctan2(LONG[:, 1], LONG[:, 0]))]
"""Of a robot 0.8 m long, 0.3 m wide, that turns about a point behind its middle."""


def corridor(width, shelf=False):
    """Two rooms with a way of ``width`` [m] between them, along x at y = 0."""
    walls = [Box(name, (0.0, y, 0.5), (2.0, 4.0, 1.0)) for name, y in (("left", 2.0 + width / 2), ("right", -2.0 - width / 2))]
    shelves = [Box("shelf", (-2.0, 0.0, 0.5), (0.2, 0.2, 1.0))] if shelf else []
    return WorldFile(about="test", origin=Origin(0.0, 0.0), floor=(-4.0, -4.0, 4.0, 4.0), boxes=[*walls, *shelves])


def share_of_the_far_room(world, start, outline=LONG):
    plan = floor_plan(world, 0.05)
    covered, (x, _) = covered_floor(plan, start, outline), plan.centres()
    return float(covered[x > 1.0].mean())


def test_a_long_robot_goes_through_a_way_in_which_it_could_not_turn():
    world = corridor(0.6)
    assert share_of_the_far_room(world, Pose2(-2.0, 0.0, 0.0)) > 0.95
    plan = floor_plan(world, 0.05)
    assert not reachable_floor(plan, -2.0, 0.0, 0.52)[:, 100:].any()


def test_what_is_narrower_than_the_robot_ends_its_floor():
    assert share_of_the_far_room(corridor(0.25), Pose2(-2.0, 0.0, 0.0)) == 0.0


@pytest.mark.parametrize("yaw", [0.0, 3.3, -0.3])
def test_a_start_in_the_way_itself_counts_by_its_heading(yaw):
    assert share_of_the_far_room(corridor(0.6), Pose2(0.0, 0.0, yaw)) > 0.95
    assert share_of_the_far_room(corridor(0.6), Pose2(0.0, 0.0, np.pi / 2)) == 0.0


def test_of_a_round_robot_it_is_what_its_disc_sweeps():
    angles = np.arange(32) * np.pi / 16
    disc = 0.3 / np.cos(np.pi / 32) * np.column_stack((np.cos(angles), np.sin(angles)))
    plan = floor_plan(corridor(1.0, shelf=True), 0.05)
    by_outline, by_radius = covered_floor(plan, Pose2(-3.0, 0.0, 0.0), disc), reachable_floor(plan, -3.0, 0.0, 0.3)
    assert (by_outline != by_radius).mean() < 0.01
    assert by_radius.mean() > 0.5


@pytest.mark.parametrize(("pose", "free"), [((-2.0, 0.0, 0.0), True), ((-1.45, 0.0, np.pi / 2), True), ((-1.45, 0.0, 0.0), True)])
def test_a_start_is_free_by_the_outline_not_by_its_circle(pose, free):
    assert Footing(corridor(0.4)).is_free(Pose2(*pose), LONG) == free


def test_a_start_is_not_free_where_a_corner_reaches_into_something():
    narrow = Footing(corridor(0.4))
    assert not narrow.is_free(Pose2(-1.1, 0.0, np.pi / 2), LONG)
    assert not narrow.is_free(Pose2(-1.2, 0.0, 0.4), LONG)
    post = Footing(
        WorldFile(
            about="test", origin=Origin(0.0, 0.0), floor=(-4.0, -4.0, 4.0, 4.0), cylinders=[Cylinder("post", (0.6, 0.0, 0.0), 0.15, 1.0)]
        )
    )
    assert not post.is_free(Pose2(0.0, 0.0, 0.0), LONG)
    assert post.is_free(Pose2(0.0, 0.0, 1.0), LONG)
    assert not post.is_free(Pose2(0.6, 0.05, 1.0), LONG)


def test_the_floor_of_a_closed_building_counts_before_what_lies_about_it_unless_it_is_small():
    def largest(side):
        ways = ((1, 0), (-1, 0), (0, 1), (0, -1))
        middles = [(x * side / 2, y * side / 2, 0.5) for x, y in ways]
        sizes = [(side * abs(y) + 0.1, side * abs(x) + 0.1, 1.0) for x, y in ways]
        ring = [Box(f"wall_{i}", *each) for i, each in enumerate(zip(middles, sizes, strict=True))]
        plan = floor_plan(WorldFile(about="test", origin=Origin(0.0, 0.0), floor=(-4.0, -4.0, 4.0, 4.0), boxes=ring), 0.05)
        regions = free_regions(plan, 0.1)
        return bool(regions[plan.cell(0.0, 0.0)] == 1), around(regions)

    assert largest(5.0) == (True, {2})
    assert largest(1.5) == (False, {1})
