"""A log is put back onto the bus at its own pace, finds its own mission, and a part of one is compared like the whole."""

from dataclasses import dataclass

import pytest

from schemas import topics
from schemas.messages import Clock, NavState, Odometry, PoseInFrame
from uvf.runtime.bus import LocalBus, Sample
from uvf.runtime.params import BadInput
from uvf.runtime.recording import Recorder, log_begin
from uvf.runtime.replay import differing, into_service, logged_site, onto_bus
from uvf.runtime.service import Service
from uvf.runtime.site import ROOT, Host

NS = 1_000_000_000


class Adder(Service):
    """Adds up the x of the poses that it hears; takes its sum up again."""

    name = "adder"
    hz = 10.0
    inputs = {"pose": topics.POSE}
    outputs = {"state": topics.NAV_STATE}
    recalls = {"state": topics.NAV_STATE}

    def __init__(self, gain=1.0):
        self.gain, self.total = gain, 0.0

    def recall(self, state=None):
        self.total = state.position.x

    def step(self, t, pose):
        self.total += self.gain * pose.pose.position.x
        message = NavState()
        message.position.x = self.total
        return {"state": message}


@dataclass
class Log:
    """Two files of one run of the adder; rotated in the middle."""

    first: object
    second: object


@pytest.fixture
def log(tmp_path):
    from uvf.runtime.lockstep import Lockstep

    lockstep = Lockstep([Host(Adder, Adder, "v")])
    poses = lockstep.bus.publisher(topics.POSE.at("v"), PoseInFrame.DESCRIPTOR.full_name, topics.POSE.qos)

    def feed(t):
        pose = PoseInFrame()
        pose.pose.position.x = 1.0 + t
        poses.put(pose.SerializeToString(deterministic=True), round(t * NS))
        return True

    made = Log(tmp_path / "log-000.mcap", tmp_path / "log-001.mcap")
    samples = []
    lockstep.bus.subscribe("uvf/**", topics.Qos.SENSOR, samples.append)
    lockstep.run(4.0, feed)
    with Recorder(made.first) as first:
        for sample in samples[: len(samples) // 2]:
            first.write(sample)
    with Recorder(made.second, before=first) as second:
        for sample in samples[len(samples) // 2 :]:
            second.write(sample)
    return made


def test_the_first_file_gives_the_same(log):
    assert [str(d) for d in into_service(log.first, Host(Adder, Adder, "v"))] == []


def test_a_later_file_alone_gives_the_same_too(log):
    assert log_begin(log.second) > 1.5 * NS
    assert [str(d) for d in into_service(log.second, Host(Adder, Adder, "v"))] == []


def test_in_a_later_file_a_change_is_noticed_as_well(log):
    changed = list(into_service(log.second, Host(Adder, lambda: Adder(1.5), "v")))
    assert {d.field for d in changed} == {"position.x"}
    assert len(changed) > 15


def test_what_stands_at_the_head_is_said_at_once_and_the_rest_at_its_pace(tmp_path):
    hour = 3600 * NS
    with Recorder(tmp_path / "a.mcap") as recorder:
        recorder.write(Sample(topics.MAP.at("v"), "foxglove.Grid", b"", NS, 1, 5))
        for n in range(3):
            clock = Clock(t_ns=hour + n * NS // 10).SerializeToString()
            recorder.write(Sample(topics.CLOCK.at("sys"), "uvf.v1.Clock", clock, hour + n * NS // 10, n + 1, 5))
    bus, heard = LocalBus(), []
    bus.subscribe("uvf/**", topics.Qos.SENSOR, heard.append)
    assert onto_bus(tmp_path / "a.mcap", bus, rate=100.0) == 4
    assert [s.stamp_ns for s in heard] == [NS, hour, hour + NS // 10, hour + 2 * NS // 10]


def attach(path, **files):
    with Recorder(path, {name.replace("__", "/") + ".yaml": data for name, data in files.items()}):
        pass
    return path


def test_a_log_brings_its_own_mission_world_and_vehicles(tmp_path):
    names = ("missions/demo", "worlds/house/world", "vehicles/burger/vehicle", "vehicles/milvus/vehicle")
    files = {name.replace("/", "__"): (ROOT / f"{name}.yaml").read_bytes() for name in names}
    files["missions__demo"] = files["missions__demo"].replace(b"seed: 1", b"seed: 77")
    assert b"seed: 77" in files["missions__demo"]
    with logged_site(attach(tmp_path / "a.mcap", **files)) as site:
        assert site.mission.seed == 77
        assert set(site.members) == {"burger", "milvus"}
        folder = site.world_folder
    assert not folder.exists()


def test_without_a_mission_in_it_the_flag_is_named(tmp_path):
    with pytest.raises(BadInput, match="--mission"), logged_site(attach(tmp_path / "a.mcap", notes=b"")):
        pass


def test_a_mission_that_is_not_understood_any_more_names_what_and_the_flag(tmp_path):
    bad = attach(tmp_path / "a.mcap", missions__demo=b"about: x\nworld: house\nvehicels: {}\n")
    with pytest.raises(BadInput, match=r"missions/demo\.yaml.*vehicels.*--mission") as caught, logged_site(bad):
        pass
    assert "/tmp" not in str(caught.value).replace(str(tmp_path), "")


def test_nothing_is_written_outside_of_its_own_folder(tmp_path):
    where = tmp_path / "in" / "a.mcap"
    where.parent.mkdir()
    evil = {"missions/x.yaml": b"about: x", "../../../../../../../../.." + str(tmp_path / "out"): b"x", str(tmp_path / "out"): b"x"}
    with Recorder(where, evil):
        pass
    with pytest.raises(BadInput), logged_site(where):
        pass
    assert not (tmp_path / "out").exists()


def told(covariance=(0.25, 0.5), text="0.0012345678901234"):
    message = Odometry(pose_covariance=covariance)
    message.metadata.add(key="a", value=text)
    return message


@pytest.mark.parametrize(
    ("other", "fields"),
    [
        (told((0.25, 0.5 + 1e-12)), []),
        (told((0.25, 0.501)), ["pose_covariance"]),
        (told((0.25,)), ["pose_covariance"]),
        (told(text="0.0012345678901235"), []),
        (told(text="1.2345678901234e-03"), []),
        (told(text="0.00124"), ["metadata[0].value"]),
        (told(text="nan"), ["metadata[0].value"]),
        (told(text="wheels"), ["metadata[0].value"]),
    ],
)
def test_what_processors_round_differently_is_no_difference(other, fields):
    assert [name for name, *_ in differing(told(), other, 1e-9)] == fields
