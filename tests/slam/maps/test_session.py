"""The session file: what is saved is loaded; what is damaged is refused in one line; nothing is ever half written."""

import contextlib
import errno
import io
import json
import zipfile
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from uvf.maths.se2 import Pose2
from uvf.models.yaml_data import BadInput
from uvf.slam.maps.session import KINDS, NO_EDGES, Edges, MappingSession
from uvf.slam.maps.tiles import TileMap
from uvf.slam.method import Keyframe
from uvf.slam.reading import Beams, Reading

FRONT = Beams((0.1, -0.05), np.linspace(-1.5, 1.5, 31), 0.1, 8.0, 0.05)
REAR = Beams((-0.2, 0.0), np.linspace(3.0, 1.0, 12), 0.2, 4.0)


def session(n=7):
    rng = np.random.default_rng(1)
    keyframes = []
    for i in range(n):
        beams = (FRONT, REAR)[i % 3 == 2]
        ranges = rng.uniform(0.2, 9.0, len(beams.bearings)).astype(np.float32).astype(float)
        ranges[::5] = np.nan
        ranges[1::5] = np.inf
        keyframes.append(Keyframe(Pose2(*rng.normal(size=3)), Reading(0.1 * i, ranges, beams, Pose2(*rng.normal(size=3)))))
    ends = np.column_stack((np.arange(n - 1), np.arange(1, n)))
    information = np.repeat(np.diag((100.0, 100.0, 400.0))[None], n - 1, axis=0)
    kinds = np.full(n - 1, KINDS.index("odometry"), np.uint8)
    edges = Edges(ends, rng.normal(size=(n - 1, 3)), information, kinds, np.arange(n - 1) != 2)
    return MappingSession(tuple(keyframes), edges, "graph", {"loop_radius": 15.0, "names": ["a"]})


def test_what_is_saved_is_loaded(tmp_path):
    before = session()
    before.save(tmp_path / "house.session")
    after = MappingSession.load(tmp_path / "house.session")
    assert (after.method, after.parameters) == (before.method, before.parameters)
    for name in ("ends", "measured", "information", "kinds", "enabled"):
        assert np.array_equal(getattr(after.edges, name), getattr(before.edges, name))
    assert len(after.keyframes) == 7
    for a, b in zip(after.keyframes, before.keyframes, strict=True):
        assert (a.map_from_base, a.reading.t, a.reading.odom_from_base) == (b.map_from_base, b.reading.t, b.reading.odom_from_base)
        assert np.array_equal(a.reading.ranges, b.reading.ranges, equal_nan=True)
        assert np.array_equal(a.reading.beams.bearings, b.reading.beams.bearings)
        assert (a.reading.beams.origin, a.reading.beams.duration) == (b.reading.beams.origin, b.reading.beams.duration)
    assert after.keyframes[0].reading.beams is after.keyframes[1].reading.beams


def test_the_map_of_a_loaded_session_is_the_map_of_the_saved_one(tmp_path):
    maps = []
    session().save(tmp_path / "s")
    for each in (session(), MappingSession.load(tmp_path / "s")):
        maps.append(TileMap())
        maps[-1].follow(each.keyframes)
    assert np.array_equal(maps[0].cells()[0], maps[1].cells()[0])
    assert (maps[0].cells()[0] > 50).any()


def test_a_session_that_has_seen_nothing_yet_is_one(tmp_path):
    MappingSession((), NO_EDGES, "hector", {}).save(tmp_path / "s")
    assert MappingSession.load(tmp_path / "s").keyframes == ()


def stored(tmp_path, **changes):
    """A session's file with some arrays changed."""
    session().save(tmp_path / "s")
    with np.load(tmp_path / "s") as file:
        arrays = dict(file)
    header = json.loads(bytes(arrays["header"]))
    header.update(changes.pop("header", {}))
    arrays["header"] = np.frombuffer(json.dumps(header).encode(), np.uint8)
    for name, change in changes.items():
        arrays[name] = change(arrays[name])
    buffer = io.BytesIO()
    np.savez(buffer, **{name: a for name, a in arrays.items() if a is not None})
    (tmp_path / "s").write_bytes(buffer.getvalue())
    return tmp_path / "s"


def with_value(place, value):
    def change(a):
        a = a.copy()
        a[place] = value
        return a

    return change


@pytest.mark.parametrize(
    ("changes", "part"),
    [
        ({"header": {"version": 3}}, "version 3; this is read up to version 2: use a newer uvf"),
        ({"header": {"format": "something"}}, "not a session of uvf slam"),
        ({"poses": lambda a: a[:3]}, r"poses has shape \(3, 3\), where \(7, 3\) belongs"),
        ({"stamps": lambda a: a[0]}, "stamps has shape"),
        ({"poses": lambda a: a.astype("U9")}, "poses is <U9"),
        ({"poses": with_value((4, 1), np.nan)}, "poses: a number that is not finite, in row 4"),
        ({"ends": with_value((2, 0), 99)}, "ends: no number 99; there are 7"),
        ({"ends": with_value((2, 0), -1)}, "ends: no number -1"),
        ({"lidar_of": with_value(2, 0)}, "keyframe 2 has 12 ranges, not as many as its lidar has beams"),
        ({"lidar_of": with_value(2, 2)}, "lidar_of: no number 2; there are 2"),
        ({"kinds": with_value(0, 9)}, "kinds: no number 9; there are 3"),
        ({"ranges": lambda a: a[:-1]}, "ranges has shape"),
        ({"information": lambda a: None}, "information is not a file in the archive"),
    ],
)
def test_what_does_not_fit_together_is_one_line(tmp_path, changes, part):
    with pytest.raises(BadInput, match=part) as refused:
        MappingSession.load(stored(tmp_path, **changes))
    assert "\n" not in str(refused.value)
    assert str(refused.value).startswith(f"session {tmp_path / 's'}: ")


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04 nothing", b"\x93NUMPY", b"text\n"])
def test_what_is_no_session_is_one_line(tmp_path, content):
    (tmp_path / "s").write_bytes(content)
    with pytest.raises(BadInput, match="not a session of uvf slam") as refused:
        MappingSession.load(tmp_path / "s")
    assert "\n" not in str(refused.value)


def test_a_file_cut_or_damaged_anywhere_is_refused(tmp_path):
    session().save(tmp_path / "s")
    whole = (tmp_path / "s").read_bytes()
    for cut in range(0, len(whole), 331):
        (tmp_path / "s").write_bytes(whole[:cut])
        with pytest.raises(BadInput, match="session"):
            MappingSession.load(tmp_path / "s")
    with zipfile.ZipFile(io.BytesIO(whole)) as archive:
        start = archive.getinfo("ranges.npy").header_offset + 200
    (tmp_path / "s").write_bytes(whole[:start] + bytes(b ^ 255 for b in whole[start : start + 8]) + whole[start + 8 :])
    with pytest.raises(BadInput, match="damaged"):
        MappingSession.load(tmp_path / "s")


def test_a_file_with_any_bytes_changed_is_loaded_or_refused(tmp_path):
    session().save(tmp_path / "s")
    whole = np.frombuffer((tmp_path / "s").read_bytes(), np.uint8)
    rng = np.random.default_rng(2)
    for _ in range(200):
        changed = whole.copy()
        changed[rng.integers(0, len(whole), 3)] = rng.integers(0, 256, 3)
        (tmp_path / "s").write_bytes(changed.tobytes())
        with contextlib.suppress(BadInput):
            assert len(MappingSession.load(tmp_path / "s").keyframes) == 7


def test_a_missing_file_is_told(tmp_path):
    with pytest.raises(BadInput, match="no such file"):
        MappingSession.load(tmp_path / "s")


def test_what_could_not_be_loaded_is_not_saved(tmp_path):
    session().save(tmp_path / "s")
    wrong = replace(session(), edges=replace(session().edges, ends=np.full((6, 2), 7)))
    with pytest.raises(BadInput, match="ends: no number 7"):
        wrong.save(tmp_path / "s")
    assert len(MappingSession.load(tmp_path / "s").keyframes) == 7


def test_a_full_disk_leaves_the_old_session(tmp_path, monkeypatch):
    session().save(tmp_path / "s")

    def full(path, content):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(Path, "write_bytes", full)
    with pytest.raises(BadInput, match=r"cannot be written: No space left on device$"):
        session(3).save(tmp_path / "s")
    assert len(MappingSession.load(tmp_path / "s").keyframes) == 7
    assert [p.name for p in tmp_path.iterdir()] == ["s"]
