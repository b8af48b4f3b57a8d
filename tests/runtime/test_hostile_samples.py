"""Whatever a stranger puts on the bus, the recorder goes on, and the log says what it has refused."""

import random
import resource

import pytest

from schemas import topics
from uvf.runtime.bus.interface import Sample
from uvf.runtime.log.bounds import CHANNELS_MOST, FOREIGN_MOST, PAYLOAD_MOST, STANDING_MOST
from uvf.runtime.log.reading import log_metadata, read_log
from uvf.runtime.log.recording import Recorder
from uvf.runtime.log.recovery import recover

POSE = topics.POSE.at("v")
HONEST = Sample(POSE, "foxglove.PoseInFrame", b"pose", 10, 1, 5)

REFUSED = {
    "a stamp that is negative": (HONEST._replace(stamp_ns=-1), "stamp"),
    "a stamp beyond 64 bits": (HONEST._replace(stamp_ns=2**64), "stamp"),
    "a stamp beyond those of the wire": (HONEST._replace(stamp_ns=2**63), "stamp"),
    "a key that is huge": (HONEST._replace(key="uvf/v/" + "x" * 100_000), "key"),
    "a key that is no UTF-8": (HONEST._replace(key="uvf/v/\ud800"), "key"),
    "a key that would steer a terminal": (HONEST._replace(key="uvf/v/\x1b[2J"), "key"),
    "no key": (HONEST._replace(key="uvf"), "key"),
    "a type name that is huge": (HONEST._replace(type_name="x" * 100_000), "type"),
    "a type name that is no UTF-8": (HONEST._replace(type_name="\udcff"), "type"),
    "a payload that is huge": (HONEST._replace(payload=bytes(PAYLOAD_MOST + 1)), "size"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_cannot_be_recorded_is_refused_and_counted_and_the_recorder_goes_on(tmp_path, case):
    hostile, why = REFUSED[case]
    with Recorder(tmp_path / "a.mcap") as recorder:
        recorder.write(HONEST)
        recorder.write(hostile)
        recorder.write(hostile)
        recorder.write(HONEST._replace(seq=2))
    assert [s.seq for s in read_log(tmp_path / "a.mcap")] == [1, 2]
    metadata = log_metadata(tmp_path / "a.mcap")
    assert (metadata[f"refused {why}"], metadata["complete"]) == ("2", "false")


RECORDED = {
    "a number beyond 32 bits": HONEST._replace(seq=2**32 + 2),
    "the largest number": HONEST._replace(seq=2**64 - 1),
    "the latest stamp of the wire": HONEST._replace(stamp_ns=2**63 - 1),
    "an epoch and a boot of the largest kind": HONEST._replace(boot=2**64 - 1, epoch=2**32 - 1),
    "a key outside of the table": HONEST._replace(key="uvf/v/what/nobody/knows"),
    "a key of two parts": HONEST._replace(key="uvf/v"),
    "a type that nobody knows": HONEST._replace(type_name="no such type"),
    "no type": HONEST._replace(type_name=""),
    "no payload": HONEST._replace(payload=b""),
    "the largest payload": HONEST._replace(payload=bytes(PAYLOAD_MOST)),
}


@pytest.mark.parametrize("case", RECORDED)
def test_what_is_only_odd_is_recorded(tmp_path, case):
    odd = RECORDED[case]
    with Recorder(tmp_path / "a.mcap") as recorder:
        recorder.write(odd)
    expected = odd._replace(seq=odd.seq % 2**32, boot=0, epoch=0)
    assert list(read_log(tmp_path / "a.mcap")) == [expected]
    assert log_metadata(tmp_path / "a.mcap")["complete"] == "true"


def test_numbers_go_on_from_zero_after_2_to_the_32_and_gaps_are_still_counted(tmp_path):
    with Recorder(tmp_path / "a.mcap") as recorder:
        for seq in range(2**32 - 3, 2**32 + 6):
            if seq not in (2**32 - 1, 2**32, 2**32 + 3):
                recorder.write(HONEST._replace(seq=seq))
    assert log_metadata(tmp_path / "a.mcap")[f"gap {POSE}"] == "3"
    recover(tmp_path / "a.mcap", tmp_path / "again.mcap")
    again = log_metadata(tmp_path / "again.mcap")
    assert again[f"gap {POSE}"] == "3"
    assert again["hash"] == log_metadata(tmp_path / "a.mcap")["hash"]


def test_a_stranger_of_another_type_does_not_take_the_schema_of_a_topic_away(tmp_path):
    with Recorder(tmp_path / "a.mcap") as recorder:
        recorder.write(HONEST._replace(type_name="nonsense"))
        recorder.write(HONEST)
    assert [s.type_name for s in read_log(tmp_path / "a.mcap")] == ["nonsense", "foxglove.PoseInFrame"]


@pytest.mark.parametrize(
    ("of", "most"),
    [
        (lambda n: HONEST._replace(key=f"uvf/v/strange/{n}"), FOREIGN_MOST),
        (lambda n: HONEST._replace(type_name=f"strange{n}"), FOREIGN_MOST),
        (lambda n: HONEST._replace(key=topics.POSE.at(f"v{n}")), CHANNELS_MOST),
    ],
    ids=["keys outside of the table", "types", "vehicles"],
)
def test_ever_new_keys_and_types_are_bounded_and_those_known_before_are_recorded_on(tmp_path, of, most):
    beyond = 100
    with Recorder(tmp_path / "a.mcap") as first:
        first.write(of(0))
        for n in range(most + beyond):
            first.write(of(n)._replace(seq=2))
    assert first.refused["channel"] == beyond
    assert len({(s.key, s.type_name) for s in read_log(tmp_path / "a.mcap")}) == most
    with Recorder(tmp_path / "b.mcap", before=first) as second:
        second.write(of(most + beyond))
        second.write(of(0)._replace(seq=3))
    assert [s.seq for s in read_log(tmp_path / "b.mcap")] == [3]
    assert log_metadata(tmp_path / "b.mcap")["refused channel"] == str(beyond + 1)


def test_strange_keys_leave_room_for_those_of_the_table(tmp_path):
    with Recorder(tmp_path / "a.mcap") as recorder:
        for n in range(2 * FOREIGN_MOST):
            recorder.write(HONEST._replace(key=f"uvf/v/strange/{n}"))
        recorder.write(HONEST)
        recorder.write(Sample(f"{topics.ARM.at('v')}/request", topics.ARM.message.DESCRIPTOR.full_name, b"", 1, 1, 5))
    assert {s.key for s in read_log(tmp_path / "a.mcap")} >= {POSE, f"{topics.ARM.at('v')}/request"}


def test_what_stands_until_the_next_file_is_bounded(tmp_path):
    payload = bytes(PAYLOAD_MOST)
    fit = STANDING_MOST // PAYLOAD_MOST
    with Recorder(tmp_path / "a.mcap") as first:
        for n in range(fit + 2):
            first.write(Sample(topics.MAP.at(f"v{n}"), "foxglove.Grid", payload, n, 1, 5))
        first.write(Sample(topics.MAP.at("v0"), "foxglove.Grid", b"small", fit + 2, 2, 5))
    with Recorder(tmp_path / "b.mcap", before=first) as second:
        pass
    assert second.carried == fit
    assert log_metadata(tmp_path / "b.mcap")["refused head"] == "2"


def test_an_epoch_that_no_clock_has_told_does_not_push_what_stands_out_of_the_next_file(tmp_path):
    clock = Sample(topics.CLOCK.at("sys"), "uvf.v1.Clock", b"", 10, 1, 5, epoch=2)
    with Recorder(tmp_path / "a.mcap") as first:
        first.write(Sample(topics.MAP.at("v"), "foxglove.Grid", b"map", 10, 1, 5, epoch=2))
        first.write(Sample(topics.MAP.at("old"), "foxglove.Grid", b"old", 10, 1, 5, epoch=1))
        first.write(clock)
        first.write(Sample(topics.MAP.at("x"), "foxglove.Grid", b"x", 10, 1, 5, epoch=2**32 - 1))
    with Recorder(tmp_path / "b.mcap", before=first):
        pass
    assert {s.payload for s in read_log(tmp_path / "b.mcap")} >= {b"map", b""}
    assert b"old" not in {s.payload for s in read_log(tmp_path / "b.mcap")}


def test_a_flood_of_keys_and_types_does_not_fill_the_memory(tmp_path):
    noise = random.Random(1)
    with Recorder(tmp_path / "a.mcap") as recorder:
        recorder.write(HONEST)
        before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        for n in range(20_000):
            recorder.write(HONEST._replace(key=f"uvf/v/{'x' * 5000}/{noise.random()}", type_name="y" * 5000 + str(n)))
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 30_000  # kB
    assert recorder.refused["key"] == 20_000
