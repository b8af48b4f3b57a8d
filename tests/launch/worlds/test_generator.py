"""Made-up houses: as many rooms as asked for, doors of 0.9 m, every room reached; the seed decides all."""

import numpy as np
import pytest

from launch.worlds.generator import generate
from uvf.models.world.file import load_world
from uvf.models.world.geometry import floor_plan, free_regions
from uvf.models.world.writer import write_world


@pytest.mark.parametrize(("rooms", "seed"), [(1, 0), (3, 1), (6, 3), (9, 2)])
def test_a_robot_of_thirty_centimetres_reaches_every_room(rooms, seed):
    world = generate(rooms, seed)
    assert len(world.fields) == rooms
    assert world.boxes
    plan = floor_plan(world, 0.05)
    largest = free_regions(plan, 0.3) == 1
    for field in world.fields:
        (r0, c0), (r1, c1) = plan.cell(*field.area[:2]), plan.cell(*field.area[2:])
        assert largest[r0:r1, c0:c1].mean() > 0.3


def test_doors_are_at_least_ninety_centimetres_wide():
    """On each line of walls the gaps between stretches are the doors."""
    world = generate(6, 3)
    lines = {}
    for wall in world.walls[1:]:
        (ax, ay), (bx, by) = wall.points
        key, span = (("x", ax), (ay, by)) if ax == bx else (("y", ay), (ax, bx))
        lines.setdefault(key, []).append(sorted(span))
    gaps = [b[0] - a[1] for spans in lines.values() for a, b in zip(sorted(spans), sorted(spans)[1:], strict=False)]
    doors = [gap for gap in gaps if gap > 0.01]
    assert len(doors) >= 5
    assert min(doors) >= 0.9 - 1e-6


def test_the_seed_decides_all():
    assert generate(4, 7) == generate(4, 7)
    assert generate(4, 7) != generate(4, 8)


def test_what_is_written_is_read_again(tmp_path):
    world = generate(4, 7)
    write_world(world, tmp_path / "made")
    read = load_world(tmp_path, "made")
    assert [box.name for box in read.boxes] == [box.name for box in world.boxes]
    assert np.allclose([box.centre for box in read.boxes], [box.centre for box in world.boxes], atol=1e-4)
    assert (tmp_path / "made" / "world.yaml").read_text().count("\n") < 80
