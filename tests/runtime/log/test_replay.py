"""A log is put back onto the bus at its own pace, finds its own mission, and a part of one is compared like the whole."""

from dataclasses import dataclass

import pytest

from schemas import topics
from schemas.messages import ArmRequest, Clock, ModeRequest, NavState, Odometry, PoseInFrame, Reply
from uvf.models.scenario import ROOT
from uvf.models.yaml_data import BadInput
from uvf.runtime.bus.interface import LocalBus, Sample
from uvf.runtime.contract.declaration import Reads, Writes, answers, call, replies, request, topic
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.contract.service import Answer, Service
from uvf.runtime.contract.service_runner import ServiceRunner
from uvf.runtime.log.comparison import differing
from uvf.runtime.log.reading import log_begin, read_log
from uvf.runtime.log.recording import Recorder
from uvf.runtime.log.replay import hand_over, into_service, logged_site, onto_bus, play

NS = 1_000_000_000


class Adder(Service):
    """Adds up the x of the poses that it hears; takes its sum up again."""

    name = "adder"
    hz = 10.0

    class Inputs(Reads):
        pose: PoseInFrame = topic(topics.POSE)

    class Outputs(Writes):
        state: NavState | None = topic(topics.NAV_STATE)

    class Recalls(Reads):
        state: None = topic(topics.NAV_STATE)

    def __init__(self, gain=1.0):
        self.gain, self.total = gain, 0.0

    def recall(self, left: Recalls) -> None:
        self.total = left.state.position.x

    def step(self, t: float, now: Inputs) -> Outputs:
        self.total += self.gain * now.pose.pose.position.x
        message = NavState()
        message.position.x = self.total
        return self.Outputs(state=message)


@dataclass
class Log:
    """Two files of one run of the adder; rotated in the middle."""

    first: object
    second: object


@pytest.fixture
def log(tmp_path):
    from uvf.runtime.time.lockstep import Lockstep

    lockstep = Lockstep([ServiceInstance(Adder, Adder, "v")])
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
    assert [str(d) for d in into_service(log.first, ServiceInstance(Adder, Adder, "v"))] == []


def test_a_later_file_alone_gives_the_same_too(log):
    assert log_begin(log.second) > 1.5 * NS
    assert [str(d) for d in into_service(log.second, ServiceInstance(Adder, Adder, "v"))] == []


def test_in_a_later_file_a_change_is_noticed_as_well(log):
    changed = list(into_service(log.second, ServiceInstance(Adder, lambda: Adder(1.5), "v")))
    assert {d.field for d in changed} == {"position.x"}
    assert len(changed) > 15


class Caller(Service):
    """Answers mode requests, asks to arm at each full second, says a half second late what it was answered."""

    name = "caller"
    hz = 10.0
    latency = 0.5

    class Inputs(Reads):
        clock: Clock = topic(topics.CLOCK)
        mode: list[ModeRequest] = request(topics.SET_MODE)
        arm: list[Answer[ArmRequest, Reply]] = answers(topics.ARM)

    class Outputs(Writes):
        state: NavState | None = topic(topics.NAV_STATE)
        mode: list[Reply] = replies(topics.SET_MODE)
        arm: list[ArmRequest] = call(topics.ARM)

    def __init__(self, say=lambda n: True, addend=0.0):
        self.say, self.addend = say, addend
        self.n, self.answers = 0, []

    def stale(self, t, missing):
        return self.Outputs()

    def step(self, t: float, now: Inputs) -> Outputs:
        self.n += 1
        self.answers += [a.reply.reason if a.reply is not None else a.reason for a in now.arm]
        message = NavState()
        message.position.x, message.position.y = self.n + self.addend, len(now.mode)
        replies = [Reply(reason=f"{self.n}") for _ in now.mode]
        return self.Outputs(state=[message] if self.say(self.n) else [], mode=replies, arm=[ArmRequest()] if self.n % 10 == 0 else [])


class Arming(Service):
    """Answers with the number of the question."""

    name = "arming"
    hz = 5.0

    class Inputs(Reads):
        arm: list[ArmRequest] = request(topics.ARM)

    class Outputs(Writes):
        arm: list[Reply] = replies(topics.ARM)

    def __init__(self):
        self.n = 0

    def step(self, t: float, now: Inputs) -> Outputs:
        self.n += len(now.arm)
        return self.Outputs(arm=[Reply(reason=f"answer {self.n}") for _ in now.arm])


def recorded(path, seconds, ask_at=()):
    """A log of Caller and Arming; when Caller is asked for a mode [s]."""
    from uvf.runtime.time.lockstep import Lockstep

    lockstep = Lockstep([ServiceInstance(Caller, Caller, "v"), ServiceInstance(Arming, Arming, "v")])

    def ask(t):
        if any(abs(t - at) < 1e-6 for at in ask_at):
            lockstep.bus.call(topics.SET_MODE.at("v"), ModeRequest().SerializeToString(), round(t * NS), lambda *reply: None)
        return True

    with Recorder(path) as recorder:
        recorder.follow(lockstep.bus)
        lockstep.run(seconds, ask)
    return path


def test_requests_and_answers_come_to_a_service_as_they_did(tmp_path):
    log = recorded(tmp_path / "a.mcap", 5.0, ask_at=(0.55, 1.25, 3.1))
    made = []

    def make():
        made.append(Caller())
        return made[-1]

    assert [str(d) for d in into_service(log, ServiceInstance(Caller, make, "v"))] == []
    assert made[-1].answers == ["answer 1", "answer 2", "answer 3", "answer 4"]


def compared_as_a_whole(log, make):
    """The differences, of all messages held in memory at once."""
    bus, made = LocalBus(), []
    keys = [topics.NAV_STATE.at("v"), *(f"{topics.SET_MODE.at('v')}/{half}" for half in ("request", "reply"))]
    for key in keys:
        bus.subscribe(key, topics.Qos.STATE, made.append)
    samples = list(read_log(log))
    for _ in play(
        ServiceRunner(ServiceInstance(Caller, make, "v"), bus),
        samples,
        lambda s: hand_over(bus, s) if s.key not in keys[::2] else None,
        4 * NS,
    ):
        pass
    logged, now = ({(s.key, s.stamp_ns): s for s in side if s.key in keys} for side in (samples, made))
    for which, old in logged.items():
        new = now.pop(which, None)
        if new is None:
            yield old.key, old.stamp_ns, "missing"
        elif new.payload != old.payload:
            yield old.key, old.stamp_ns, "changed"
    yield from ((new.key, new.stamp_ns, "surplus") for new in now.values())


@pytest.mark.parametrize(
    "make",
    [
        lambda: Caller(lambda n: n % 3),
        lambda: Caller(addend=0.5),
        lambda: Caller(lambda n: n % 7, addend=0.5),
    ],
)
def test_differences_come_in_the_order_of_the_log_and_what_it_does_not_hold_at_the_end(tmp_path, make):
    log = recorded(tmp_path / "a.mcap", 4.0, ask_at=(1.25, 3.1))
    with Recorder(tmp_path / "b.mcap") as thinned:
        for sample in read_log(log):
            if sample.key not in (topics.NAV_STATE.at("v"), f"{topics.SET_MODE.at('v')}/reply") or sample.seq % 4:
                thinned.write(sample)
    found = []
    for d in into_service(tmp_path / "b.mcap", ServiceInstance(Caller, make, "v")):
        kind = "missing" if d.now == "missing" else "surplus" if d.logged == "missing" else "changed"
        if (d.key, d.stamp_ns, kind) not in found[-1:]:
            found.append((d.key, d.stamp_ns, kind))
    expected = list(compared_as_a_whole(tmp_path / "b.mcap", make))
    assert found == expected
    assert {kind for *_, kind in expected} >= {"surplus"} and len(expected) > 5


def with_a_strangers(log, path, **changes):
    with Recorder(path) as recorder:
        for sample in read_log(log):
            recorder.write(sample)
        recorder.write(sample._replace(**changes))
    return path


def test_what_is_stamped_long_after_all_others_is_left_out_and_told(tmp_path):
    log = recorded(tmp_path / "a.mcap", 2.0)
    far = with_a_strangers(log, tmp_path / "far.mcap", key="uvf/v/stranger", stamp_ns=2**62)
    told, bus = [], LocalBus()
    assert [str(d) for d in into_service(far, ServiceInstance(Caller, Caller, "v"), warn=told.append)] == []
    assert onto_bus(far, bus, rate=1e6, warn=told.append) == len(list(read_log(log)))
    assert len(told) == 2
    assert "1 messages are stamped more than 3600 s after all others and are left out" in told[0]


def test_broken_bytes_on_the_key_of_a_service_are_a_difference(tmp_path):
    log = recorded(tmp_path / "a.mcap", 2.0)
    with Recorder(tmp_path / "b.mcap") as recorder:
        for sample in read_log(log):
            broken = sample.key == topics.NAV_STATE.at("v") and sample.seq == 5
            recorder.write(sample._replace(payload=b"\xff") if broken else sample)
    assert [d.logged for d in into_service(tmp_path / "b.mcap", ServiceInstance(Caller, Caller, "v"))] == ["broken bytes"]


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
