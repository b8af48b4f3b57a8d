"""A run's log is a series of files: each can be read alone, together they hold everything, and a full disk only interrupts them."""

import random
import resource
import shutil
from collections import Counter

import pytest

from launch.recorder import ROOM, LogSeries, attachments
from launch.runs import keep_quota
from schemas import topics
from uvf.models.scenario import ROOT, load_scenario
from uvf.models.yaml_data import BadInput
from uvf.runtime.bus.interface import LocalBus, Sample
from uvf.runtime.log.folder import logs_of
from uvf.runtime.log.reading import log_attachments, log_metadata, read_log, restarts_of
from uvf.runtime.log.recovery import recover
from uvf.runtime.log.run_samples import run_samples

POSE, MAP, STATUS = (topic.at("v") for topic in (topics.POSE, topics.MAP, topics.STATUS))
NOISE = random.Random(1).randbytes(200_000)  # does not compress


def put(bus, key, payload, t):
    topic = {POSE: topics.POSE, MAP: topics.MAP, STATUS: topics.STATUS}[key]
    bus.deliver(key, topic.message.DESCRIPTOR.full_name, topic.qos, payload, round(t * 1e9))


def noise(n):
    return NOISE[n * 200 % 199_000 :][:200]


def drive(bus, series, steps=range(300)):
    """Ten times a second a pose, now and then a status, once a map; flushed each second."""
    for n in steps:
        put(bus, POSE, noise(n), n / 10)
        if n == 5:
            put(bus, MAP, b"the map", n / 10)
        if n % 7 == 0:
            put(bus, STATUS, b"status %d" % n, n / 10)
        if n % 10 == 9:
            series.flush()


def follow(series):
    bus = LocalBus()
    bus.subscribe("uvf/**", topics.Qos.SENSOR, series.write)
    return bus


def logs(folder):
    return sorted(folder.glob("log-*.mcap"))


@pytest.fixture
def told():
    return []


@pytest.fixture
def tell(told):
    return lambda line, severity: told.append(line)


@pytest.fixture
def rotated(tmp_path, tell):
    series = LogSeries(tmp_path, {"missions/x.yaml": b"x"}, tell, rotate_bytes=10_000)
    drive(follow(series), series)
    series.close()
    return tmp_path


def test_a_full_file_is_followed_by_the_next(rotated, told):
    sizes = [log.stat().st_size for log in logs(rotated)]
    assert len(sizes) > 4
    assert all(10_000 <= size < 25_000 for size in sizes[:-1])
    assert told == []


def test_each_file_alone_holds_what_stands_and_what_was_run(rotated):
    for log in logs(rotated):
        samples = list(read_log(log))
        assert b"the map" in [s.payload for s in samples]
        first_status = next(s for s in samples if s.key == STATUS)
        first_pose = next(s for s in samples if s.key == POSE)
        assert first_status.stamp_ns <= first_pose.stamp_ns <= first_status.stamp_ns + 800_000_000
        assert log_attachments(log) == {"missions/x.yaml": b"x"}


def test_all_files_together_hold_every_message_once_besides_the_heads(rotated):
    counts = Counter((s.key, s.seq) for log in logs(rotated) for s in read_log(log))
    assert [counts[POSE, n] for n in range(1, 301)] == [1] * 300
    repeats = sum(counts.values()) - len(counts)
    assert repeats == sum(int(log_metadata(log)["carried"]) for log in logs(rotated)) == 2 * (len(logs(rotated)) - 1)


def test_a_rotation_is_no_gap(rotated):
    assert {log_metadata(log)["complete"] for log in logs(rotated)} == {"true"}


def test_gaps_are_those_of_the_whole_run(tmp_path, tell):
    series = LogSeries(tmp_path, {}, tell, rotate_bytes=3000)
    for n in (1, 2, 5, 6, 7, 9):
        series.write(Sample(POSE, "foxglove.PoseInFrame", NOISE[: 2000 + n], n, n, 5))
        series.flush()
    series.close()
    assert len(logs(tmp_path)) > 2
    assert log_metadata(logs(tmp_path)[-1])[f"gap {POSE}"] == "3"


def test_the_quota_is_kept_while_recording(tmp_path, tell):
    most = 0
    series = LogSeries(tmp_path, {}, tell, lambda: keep_quota(tmp_path, 30_000), rotate_bytes=10_000)
    bus = follow(series)
    for n in range(0, 600, 10):
        drive(bus, series, range(n, n + 10))
        most = max(most, sum(log.stat().st_size for log in logs(tmp_path)))
    series.close()
    assert most < 45_000
    assert logs(tmp_path)[0].name != "log-000.mcap"
    assert b"the map" in [s.payload for s in read_log(logs(tmp_path)[0])]


class Disk:
    """Refuses files beyond a size, as a full one does; ``space`` is what it says is free."""

    def __init__(self):
        self._limits = resource.getrlimit(resource.RLIMIT_FSIZE)
        self.space = 10 * ROOM

    def free(self, folder):
        return self.space

    def fill(self, size):
        self.space = 0
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, self._limits[1]))

    def clear(self):
        self.space = 10 * ROOM
        resource.setrlimit(resource.RLIMIT_FSIZE, self._limits)


@pytest.fixture
def disk():
    made = Disk()
    yield made
    made.clear()


def test_a_full_disk_is_one_line_and_recording_goes_on_when_there_is_room(tmp_path, tell, told, disk):
    series = LogSeries(tmp_path, {}, tell, free=disk.free)
    bus = follow(series)
    drive(bus, series, range(50))
    disk.fill(logs(tmp_path)[0].stat().st_size + 1000)
    drive(bus, series, range(50, 150))
    assert len(told) == 1
    assert "recording ends here" in told[0] and "it goes on when there is room" in told[0]
    assert len(logs(tmp_path)) == 1
    disk.clear()
    drive(bus, series, range(150, 200))
    series.close()
    assert told[1:] == [f"recording goes on in {tmp_path / 'log-001.mcap'}"]
    after = list(read_log(tmp_path / "log-001.mcap"))
    assert b"the map" in [s.payload for s in after]
    assert recover(tmp_path / "log-000.mcap", tmp_path / "saved.mcap") > 50
    recorded = {s.seq for log in (tmp_path / "saved.mcap", tmp_path / "log-001.mcap") for s in read_log(log) if s.key == POSE}
    missed = int(log_metadata(tmp_path / "log-001.mcap")[f"gap {POSE}"])
    assert 200 - len(recorded) <= missed <= 200 - len(recorded) + 10


def test_a_disk_that_refuses_though_it_says_it_has_room_leaves_no_litter(tmp_path, tell, told, disk):
    series = LogSeries(tmp_path, {}, tell, free=disk.free)
    bus = follow(series)
    drive(bus, series, range(20))
    disk.fill(100)
    disk.space = 10 * ROOM
    drive(bus, series, range(20, 100))
    assert [log.name for log in logs(tmp_path)] == ["log-000.mcap"]
    assert len(told) == 1
    disk.clear()
    drive(bus, series, range(100, 120))
    series.close()
    assert log_metadata(tmp_path / "log-001.mcap")["complete"] == "false"


def test_a_disk_that_is_full_from_the_start_ends_nobody(tmp_path, tell, told, disk):
    disk.fill(100)
    series = LogSeries(tmp_path, {"missions/x.yaml": NOISE[:9000]}, tell, free=disk.free)
    bus = follow(series)
    drive(bus, series, range(30))
    assert logs(tmp_path) == [] and len(told) == 1
    disk.clear()
    drive(bus, series, range(30, 60))
    series.close()
    assert b"the map" in [s.payload for s in read_log(tmp_path / "log-000.mcap")]


def test_a_log_removed_while_it_is_written_is_said_and_begun_anew(tmp_path, tell, told):
    folder = tmp_path / "run"
    folder.mkdir()
    series = LogSeries(folder, {}, tell)
    bus = follow(series)
    drive(bus, series, range(20))
    shutil.rmtree(folder)
    drive(bus, series, range(20, 60))
    assert len(told) == 1 and "has been removed" in told[0]
    folder.mkdir()
    drive(bus, series, range(60, 80))
    series.close()
    assert [s.seq for s in read_log(folder / "log-001.mcap") if s.key == POSE][-1] == 80


def test_each_kind_of_message_that_is_refused_is_told_once(tmp_path, tell, told):
    series = LogSeries(tmp_path, {}, tell, rotate_bytes=3000)
    for n in range(5):
        series.write(Sample(POSE, "foxglove.PoseInFrame", NOISE[n * 4000 : (n + 1) * 4000], 2**63 + n, n, 5))
        series.write(Sample(POSE, "foxglove.PoseInFrame", NOISE[n * 4000 : (n + 1) * 4000], n, n, 5))
        series.write(Sample(POSE + "\n", "foxglove.PoseInFrame", b"", n, n, 5))
        series.flush()
    series.close()
    assert len(logs(tmp_path)) > 2
    assert len(told) == 2
    assert "stamped before 0 or after" in " ".join(told) and "not printable" in " ".join(told)
    assert {log_metadata(logs(tmp_path)[-1])[f"refused {why}"] for why in ("stamp", "key")} == {"5"}


def test_a_recorder_that_is_started_again_begins_a_new_file(tmp_path, tell):
    (tmp_path / "log-007.mcap").touch()
    (tmp_path / "log-007-recovered.mcap").touch()
    LogSeries(tmp_path, {}, tell).close()
    assert (tmp_path / "log-008.mcap").stat().st_size > 0


def test_a_folder_that_cannot_be_written_is_told_at_the_start(tmp_path, tell):
    with pytest.raises(BadInput, match="cannot be written"):
        LogSeries(tmp_path / "missing", {}, tell)


def test_mission_world_and_vehicles_are_attached_by_their_places():
    attached = attachments(load_scenario(ROOT / "missions" / "demo.yaml"))
    for name in ("missions/demo.yaml", "worlds/house/world.yaml", "vehicles/burger/burger.urdf", "vehicles/milvus/engine/milvus_motor.xml"):
        assert attached[name] == (ROOT / name).read_bytes()


def tick(series, epoch, t):
    """The clock's word, and a pose and a map of that epoch."""
    for key, topic, payload in ((topics.CLOCK.at("sys"), topics.CLOCK, b""), (POSE, topics.POSE, b"pose"), (MAP, topics.MAP, b"map")):
        name = topic.message.DESCRIPTOR.full_name
        series.write(Sample(key, name, payload + b" %d" % epoch if payload else b"", round(t * 1e9), round(t * 10) + 1, epoch, epoch))


def test_where_time_starts_over_another_log_begins_and_the_run_is_what_came_since(tmp_path, tell):
    series = LogSeries(tmp_path, {}, tell)
    for epoch in (1, 2):
        for n in range(30 * epoch):
            tick(series, epoch, n / 10)
        series.flush()
    assert [log.name for log in logs_of(tmp_path)] == ["log-001.mcap"]  # while it is being recorded, too
    series.close()
    assert [log.name for log in logs(tmp_path)] == ["log-000.mcap", "log-001.mcap"]
    payloads = {name: {s.payload for s in read_log(tmp_path / name) if s.key == POSE} for name in ("log-000.mcap", "log-001.mcap")}
    assert payloads == {"log-000.mcap": {b"pose 1"}, "log-001.mcap": {b"pose 2"}}
    assert {s.payload for s in run_samples(tmp_path) if s.key == MAP} == {b"map 2"}
    assert max(s.stamp_ns for s in run_samples(tmp_path)) == round(5.9e9)


def test_a_flood_of_clocks_makes_no_flood_of_files(tmp_path, tell):
    series = LogSeries(tmp_path, {}, tell)
    for epoch in range(1, 200):
        tick(series, epoch, 0.0)
    series.close()
    assert len(logs(tmp_path)) <= 3


def test_a_log_that_grows_too_large_is_no_new_beginning(tmp_path, tell):
    series = LogSeries(tmp_path, {}, tell, rotate_bytes=30_000)
    drive(follow(series), series)
    series.close()
    assert logs_of(tmp_path) == logs(tmp_path) and len(logs(tmp_path)) > 1


@pytest.mark.parametrize("data", [b"", b"nonsense", b"\x89MCAP0\r\n" + b"\x0c\xff\xff"])
def test_a_file_that_is_no_log_began_at_the_beginning(tmp_path, data):
    path = tmp_path / "log-000.mcap"
    path.write_bytes(data)
    assert restarts_of(path) == 0
