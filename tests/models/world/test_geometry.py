"""The house's plan: what is solid, what a robot can reach, and what the lidar's height leaves out."""

import numpy as np
import pytest

from uvf.maths.raycast import Rays, cast
from uvf.models.scenario import ROOT
from uvf.models.shapes.mesh import triangles
from uvf.models.shapes.scene import scene
from uvf.models.world.file import Box, Cylinder, Origin, Ramp, Wall, WorldFile, load_world
from uvf.models.world.footing import Footing
from uvf.models.world.geometry import all_boxes, floor_plan, reachable_floor, solids
from uvf.models.yaml_data import BadInput

HOUSE = load_world(ROOT / "worlds", "house")
START = (2.2, 1.3)
ROOMS = {
    "living room": START,
    "kitchen": (5.5, 1.7),
    "bathroom": (10, 2.5),
    "hall": (9.0, 4.3),
    "bedroom": (3, 6.5),
    "study": (6.5, 7.6),
    "guest room": (9.6, 7),
}


def world_of(**parts):
    return WorldFile(about="test", origin=Origin(0.0, 0.0), floor=(0.0, 0.0, 4.0, 2.0), **parts)


def reach(world, radius, start):
    plan = floor_plan(world, 0.05)
    return plan, reachable_floor(plan, *start, radius)


@pytest.mark.parametrize("room", ROOMS)
def test_each_room_of_the_house_can_be_reached_by_the_burger(room):
    plan, mask = reach(HOUSE, 0.115, START)
    assert mask[plan.cell(*ROOMS[room])]


def test_the_house_is_closed():
    plan, mask = reach(HOUSE, 0.115, START)
    assert not (mask[0].any() or mask[-1].any() or mask[:, 0].any() or mask[:, -1].any())
    assert 70.0 < mask.sum() * plan.resolution**2 < 85.0


def test_a_robot_wider_than_the_doors_stays_in_its_room():
    plan, mask = reach(HOUSE, 0.55, (1.0, 4.0))
    assert not mask[plan.cell(*ROOMS["bedroom"])]


def test_a_wall_across_the_floor_cuts_off_what_is_behind():
    plan, mask = reach(world_of(walls=[Wall([(2.0, 0.0), (2.0, 2.0)])]), 0.1, (1.0, 1.0))
    assert mask[plan.cell(1.5, 1.0)]
    assert not mask[plan.cell(2.0, 1.0)]
    assert not mask[plan.cell(3.0, 1.0)]


def test_the_reachable_floor_includes_what_the_body_sweeps_up_to_the_wall():
    plan, mask = reach(world_of(walls=[Wall([(2.0, 0.0), (2.0, 2.0)])]), 0.3, (1.0, 1.0))
    assert mask[plan.cell(1.85, 1.0)]


def test_a_start_inside_a_wall_reaches_nothing():
    assert not reach(world_of(walls=[Wall([(2.0, 0.0), (2.0, 2.0)])]), 0.1, (2.0, 1.0))[1].any()


def test_stretches_overlap_at_corners_but_free_ends_keep_their_length():
    first, second = all_boxes(world_of(walls=[Wall([(0.0, 0.0), (2.0, 0.0), (2.0, 1.0)], thickness=0.2)]))
    assert first.centre[:2] == pytest.approx((1.05, 0.0))
    assert first.size[0] == pytest.approx(2.1)
    assert second.centre[:2] == pytest.approx((2.0, 0.45))


def level_ranges(world, origin, angles):
    """m from (x, y), 18 cm above the floor."""
    level = np.column_stack((np.cos(angles), np.sin(angles), np.zeros(len(angles))))
    return cast(scene(solids(world)), [], Rays(np.array((*origin, 0.18)), level), 100.0)


def test_the_lidar_sees_a_table_by_its_legs_only():
    top = Box("top", (2.0, 1.0, 0.7), (1.0, 1.0, 0.05))
    leg = Cylinder("leg", (2.0, 1.0, 0.0), 0.05, 0.7)
    world = world_of(boxes=[top], cylinders=[leg])
    assert level_ranges(world, (0.0, 1.0), np.zeros(1)) == pytest.approx([1.95])
    assert not floor_plan(world, 0.05).cells[floor_plan(world, 0.05).cell(1.6, 1.0)]


def test_the_plan_and_the_rays_agree_on_where_the_walls_are():
    """Each ray ends in or beside an occupied cell and crosses none before."""
    plan = floor_plan(HOUSE, 0.05)
    angles = np.linspace(-np.pi, np.pi, 180, endpoint=False)
    ranges, footing = level_ranges(HOUSE, START, angles), Footing(HOUSE)
    for angle, distance in zip(angles, ranges, strict=True):
        beyond = (START[0] + (distance + 0.02) * np.cos(angle), START[1] + (distance + 0.02) * np.sin(angle))
        before = (START[0] + (distance - 0.08) * np.cos(angle), START[1] + (distance - 0.08) * np.sin(angle))
        assert plan.cells[plan.cell(*beyond)]
        assert footing.at(*before).room <= 0.08 + 1e-9


def test_coloured_fields_of_the_house_do_not_overlap():
    areas = [f.area for f in HOUSE.fields]
    overlaps = [(a, b) for i, a in enumerate(areas) for b in areas[:i] if a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3]]
    assert overlaps == []


@pytest.mark.parametrize(
    ("points", "complaint"),
    [("[[0, 0]]", r"walls\[0\]"), ("[[0, 0], [1, 0], [1, 0]]", r"walls\[0\]: the same point twice in a row; take one away")],
)
def test_a_wall_without_length_is_refused(tmp_path, points, complaint):
    (tmp_path / "flat").mkdir()
    text = f"{{about: test, origin: {{latitude: 0, longitude: 0}}, floor: [0, 0, 1, 1], walls: [{{points: {points}}}]}}"
    (tmp_path / "flat" / "world.yaml").write_text(text)
    with pytest.raises(BadInput, match=complaint):
        load_world(tmp_path, "flat")


def ramped(ramp):
    return WorldFile(about="test", origin=Origin(0.0, 0.0), floor=(-5.0, -5.0, 9.0, 9.0), ramps=[ramp])


@pytest.mark.parametrize("yaw", [0.0, 0.7, -2.0])
def test_a_ramp_rises_from_its_foot_to_its_height(yaw):
    ramp = Ramp("r", foot=(2.0, 1.0), height=0.4, length=2.5, width=1.2, yaw=yaw)
    (solid,) = solids(ramped(ramp))
    corners, _ = triangles(solid)
    along, across = np.array((np.cos(yaw), np.sin(yaw), 0.0)), np.array((-np.sin(yaw), np.cos(yaw), 0.0))
    foot = np.array((2.0, 1.0, 0.0))
    for side in (-0.6, 0.6):
        for edge in (foot, foot + 2.5 * along + (0.0, 0.0, 0.4)):
            assert np.linalg.norm(corners - (edge + side * across), axis=1).min() < 1e-9
    assert corners[:, 2].max() == pytest.approx(0.4)
    plan = floor_plan(ramped(ramp), 0.05)
    assert not plan.cells[plan.cell(*(foot + 1.2 * along)[:2])]
    assert plan.cells[plan.cell(*(foot + 2.3 * along + 0.6 * across)[:2])]  # its side, 0.37 m high
