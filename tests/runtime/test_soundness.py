"""Numbers that no computation survives are refused at the border, whichever field they stand in."""

import math

import numpy as np
import pytest
from google.protobuf.descriptor import FieldDescriptor

from schemas import topics
from schemas.convert import occupancy_grid, planar_pose
from schemas.messages import GoalRequest, Grid, Imu, LaserScan, PosesInFrame, Vector3
from uvf.runtime.soundness import OPEN, fault
from uvf.runtime.wire import Malformed, decode

FLOATS = (FieldDescriptor.TYPE_DOUBLE, FieldDescriptor.TYPE_FLOAT)
TYPES = {t.message for t in topics.TOPICS.values()} | {t for r in topics.REQUESTS.values() for t in (r.message, r.reply)}


def ways(type_, way=()):
    """Every way to a number in a message of this type, as field names."""
    for field in type_.fields:
        if field.type in FLOATS:
            yield type_, (*way, field.name)
        elif field.message_type and not field.message_type.GetOptions().map_entry:
            yield from ways(field.message_type, (*way, field.name))


def put(message, way, value):
    """Sets the number at the end of a way; lists get one entry."""
    for name in way[:-1]:
        inner = getattr(message, name)
        message = inner.add() if hasattr(inner, "add") else inner
    repeated = isinstance(getattr(message, way[-1]), float) is False
    if repeated:
        getattr(message, way[-1]).append(value)
    else:
        setattr(message, way[-1], value)


@pytest.mark.parametrize("type_", sorted(TYPES - {Grid}, key=lambda t: t.__name__), ids=lambda t: t.__name__)
def test_a_number_that_is_none_is_found_in_every_field_but_the_open_ones(type_):
    for holder, way in ways(type_.DESCRIPTOR):
        for value in (math.nan, math.inf, -math.inf, 1e30):
            message = type_()
            put(message, way, value)
            assert bool(fault(message)) == (way[-1] not in OPEN.get(holder.full_name, ())), way
        message = type_()
        put(message, way, -123.5)
        assert fault(message) == "", way


def test_any_heading_and_beams_without_return_are_sound():
    assert fault(GoalRequest(yaw=math.nan)) == fault(LaserScan(ranges=[math.inf, 0.0, math.nan])) == ""


def test_one_bad_pose_in_a_path_is_found():
    path = PosesInFrame(poses=[planar_pose(1.0, 2.0, 0.1)] * 50)
    assert fault(path) == ""
    path.poses[49].position.y = math.nan
    assert fault(path)


@pytest.mark.parametrize(
    ("change", "why"),
    [
        ({"data": b""}, "0 cells"),
        ({"data": b"\0" * 7}, "7 cells do not make rows of 4"),
        ({"column_count": 0}, "12 cells do not make rows of 0"),
    ],
)
def test_a_map_that_is_no_rectangle_of_cells_is_refused(change, why):
    grid = occupancy_grid(np.zeros((3, 4), dtype=np.int8), 0.05, 0.0, 0.0, "map", 0.0)
    assert fault(grid) == ""
    for name, value in change.items():
        setattr(grid, name, value)
    assert why in fault(grid)
    grid.cell_size.x = 0.0
    assert fault(grid) == "cells without size"


def test_the_line_names_key_and_type():
    broken = Imu(angular_velocity=Vector3(z=math.nan)).SerializeToString()
    with pytest.raises(Malformed, match=r"^uvf/v/sensor/imu: broken uvf\.v1\.Imu: a number that is not finite or above 1e"):
        decode("uvf/v/sensor/imu", broken, Imu)
