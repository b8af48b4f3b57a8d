"""What is beyond the limits of the schema is refused at the border, whichever field it stands in."""

import math

import numpy as np
import pytest
from google.protobuf.descriptor import FieldDescriptor

from schemas import limits, messages, topics
from schemas.limits import BYTES, ENTRIES, LENGTHS, MOST, OPEN, PATTERNS
from schemas.messages import (
    GoalRequest,
    Grid,
    Health,
    Imu,
    LaserScan,
    MissionProgress,
    Pose,
    PosesInFrame,
    Quaternion,
    SimObject,
    Timestamp,
    Vector3,
)
from uvf.runtime.bus.wire import Malformed, decode
from uvf.runtime.mavlink.mission_items import ORIGIN
from uvf.runtime.messages.convert import occupancy_grid, planar_pose
from uvf.runtime.messages.validation import IDS, error_in

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
            assert bool(error_in(message)) == (way[-1] not in OPEN.get(holder.full_name, ())), way
        message = type_()
        put(message, way, -1.0 if holder is Quaternion.DESCRIPTOR else -0.5)
        assert error_in(message) == "", way


@pytest.mark.parametrize(("length", "sound"), [(0.0, True), (0.5, False), (0.95, True), (1.0, True), (1.05, True), (2.0, False)])
def test_an_orientation_is_of_unit_length_or_left_out(length, sound):
    error = error_in(SimObject(pose=Pose(orientation=Quaternion(w=0.6 * length, z=0.8 * length))))
    assert (error == "") == sound
    assert sound or (error.startswith("pose.orientation: (") and error.endswith("is no unit quaternion"))


@pytest.mark.parametrize("reached", [-1, 0, ENTRIES])
def test_an_index_is_no_more_than_a_list_can_hold(reached):
    assert error_in(MissionProgress(reached=reached)) == ""
    assert error_in(MissionProgress(reached=ENTRIES + 1)) == f"reached: {ENTRIES + 1} is not within -1 to {ENTRIES}"


@pytest.mark.parametrize("name", sorted(MOST))
def test_a_place_or_a_reading_that_nothing_can_have_is_refused(name):
    """An aircraft at 10^11 m from home plans its way back for as long as memory lasts."""
    type_name, _, field = name.rpartition(".")
    type_ = getattr(messages, type_name.rpartition(".")[2])

    def error_of(length):
        vector = type_.DESCRIPTOR.fields_by_name[field].message_type is not None
        return error_in(filled(type_, (field, "y") if vector else (field,), length))

    assert error_of(-MOST[name]) == ""
    assert error_of(1e11).startswith(field)
    assert error_of(1e11).endswith(f"1e+11 is more than {MOST[name]:g}")
    assert "nan is not finite" in error_of(math.nan)


def fields(type_, way=()):
    """Every field of a message of this type and of those inside it, with the way there."""
    for field in type_.fields:
        yield field, (*way, field.name)
        if (
            field.message_type
            and field.message_type.full_name != "google.protobuf.Timestamp"
            and not field.message_type.GetOptions().map_entry
        ):
            yield from fields(field.message_type, (*way, field.name))


def filled(type_, way, *values):
    """A message with these values in one field."""
    message = holder = type_()
    for name in way[:-1]:
        inner = getattr(holder, name)
        holder = inner.add() if hasattr(inner, "add") else inner
    if isinstance(getattr(holder, way[-1]), int | float | str | bytes):
        setattr(holder, way[-1], values[0])
    else:
        getattr(holder, way[-1]).extend(values)
    return message


BAD_TEXTS = ("x" * 5000, "a\x00b", "\x1b[2J", "right\u202eleft", "\u2066", "\x85")
GOOD_TEXTS = ("", "two\nlines\tand a tab", "Grüße, 你好, ✖")


def bad_and_good(field):
    """Values beyond and within the limits of a field."""
    kinds = FieldDescriptor
    if field.full_name in PATTERNS:
        return ("../../etc", "a/b", "<img src=x>", "a b", "-x", "..", "x" * 81), ("milvus", "my2bot_B-7", "v1.2")
    if field.type == kinds.TYPE_STRING:
        return BAD_TEXTS, GOOD_TEXTS
    if field.type == kinds.TYPE_ENUM:
        return (99, -1, 2**31 - 1), tuple(field.enum_type.values_by_number)
    if field.full_name in BYTES:
        return (b"x", b"x" * 31, b"x" * 33), (b"", b"x" * ORIGIN.size)
    if field.type in (kinds.TYPE_INT64, kinds.TYPE_UINT64) and field.full_name not in IDS:
        return (2**63 - 1,), (2**53,)
    return (), ()


@pytest.mark.parametrize("type_", sorted(TYPES, key=lambda t: t.__name__), ids=lambda t: t.__name__)
def test_texts_enums_and_long_integers_are_held_to_their_limits(type_):
    for field, way in fields(type_.DESCRIPTOR):
        if field.message_type is not None and field.message_type.GetOptions().map_entry:
            continue
        bad, good = bad_and_good(field)
        for value in bad:
            assert way[-1] in error_in(filled(type_, way, value)), (way, value)
        for value in good:
            assert way[-1] not in error_in(filled(type_, way, value)), (way, value)


@pytest.mark.parametrize("type_", sorted(TYPES, key=lambda t: t.__name__), ids=lambda t: t.__name__)
def test_lists_and_maps_are_bounded(type_):
    for field, way in fields(type_.DESCRIPTOR):
        if field.label != FieldDescriptor.LABEL_REPEATED or len(way) > 1:
            continue
        most, message = LENGTHS.get(field.full_name, ENTRIES), type_()
        entries = getattr(message, field.name)
        if field.message_type is not None and field.message_type.GetOptions().map_entry:
            text = field.message_type.fields_by_name["value"].type == FieldDescriptor.TYPE_STRING
            entries.update({str(n): "" if text else n for n in range(most + 1)})
        elif field.message_type is not None:
            for _ in range(most + 1):
                entries.add()
        else:
            entries.extend([{FieldDescriptor.TYPE_STRING: "", FieldDescriptor.TYPE_BYTES: b""}.get(field.type, 0)] * (most + 1))
        assert f"{field.name}: {most + 1} entries, {most} at most" in error_in(message)


@pytest.mark.parametrize("stamp", [{"seconds": -1}, {"nanos": -1}, {"nanos": 10**9}, {"seconds": 2**62}], ids=str)
def test_a_stamp_that_is_no_time_is_refused(stamp):
    assert "timestamp" in error_in(Imu(timestamp=Timestamp(**stamp)))
    assert error_in(Imu(timestamp=Timestamp(seconds=3, nanos=999_999_999))) == ""


def test_a_key_of_a_map_is_a_text_like_any_other():
    assert "holds control characters" in error_in(Health(gaps={"\x1b[2J": 1}))


@pytest.mark.parametrize("type_", sorted(TYPES, key=lambda t: t.__name__), ids=lambda t: t.__name__)
def test_more_bytes_than_a_type_may_have_are_not_even_read(type_, monkeypatch):
    monkeypatch.setattr(limits, "SIZE", 1000)
    monkeypatch.setattr(limits, "SIZES", dict.fromkeys(limits.SIZES, 1000))
    with pytest.raises(Malformed, match="1001 bytes, 1000 are the most for"):
        decode("uvf/v/x/y", b"\0" * 1001, type_)


def test_nesting_that_no_stack_holds_is_broken_bytes():
    payload = b"\x7b" * 30_000 + b"\x7c" * 30_000  # groups within groups, of a field that the type does not have
    with pytest.raises(Malformed):
        decode("uvf/v/x/y", payload, Imu)


def test_any_heading_and_beams_without_return_are_sound():
    assert error_in(GoalRequest(yaw=math.nan)) == error_in(LaserScan(ranges=[math.inf, 0.0, math.nan])) == ""


def test_one_bad_pose_in_a_path_is_found():
    path = PosesInFrame(poses=[planar_pose(1.0, 2.0, 0.1)] * 50)
    assert error_in(path) == ""
    path.poses[49].position.y = math.nan
    assert error_in(path)


@pytest.mark.parametrize(
    ("change", "why"),
    [
        ({"data": b""}, "0 cells"),
        ({"data": b"\0" * 7}, "7 cells do not make rows of 4"),
        ({"column_count": 0}, "12 cells do not make rows of 0"),
        ({"column_count": 60_000, "data": b"\0" * 60_000}, "more than 50000 cells along a side"),
    ],
)
def test_a_map_that_is_no_rectangle_of_cells_is_refused(change, why):
    grid = occupancy_grid(np.zeros((3, 4), dtype=np.int8), 0.05, 0.0, 0.0, "map", 0.0)
    assert error_in(grid) == ""
    for name, value in change.items():
        setattr(grid, name, value)
    assert why in error_in(grid)
    for side in (0.0, 10.1):
        grid.cell_size.x = side
        assert "cells are of 0.001 to 10 m" in error_in(grid)


def test_the_line_names_key_and_type():
    broken = Imu(angular_velocity=Vector3(z=math.nan)).SerializeToString()
    with pytest.raises(Malformed, match=r"^uvf/v/sensor/imu: broken uvf\.v1\.Imu: angular_velocity\.z: nan is not finite"):
        decode("uvf/v/sensor/imu", broken, Imu)
