"""Logs hold the bytes as they travelled, open elsewhere, survive a kill and a full disk."""

import os
import random
from pathlib import Path

import pytest
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory

from schemas import topics
from schemas.messages import DriveCommand, PoseInFrame
from uvf.models.yaml_data import BadInput
from uvf.runtime.bus.interface import Sample
from uvf.runtime.log.reading import log_attachments, log_begin, log_metadata, read_log
from uvf.runtime.log.recording import Recorder
from uvf.runtime.log.recovery import recover
from uvf.runtime.messages.convert import planar_pose, stamp


def sample(seq, key="uvf/v/nav/pose"):
    pose = PoseInFrame(timestamp=stamp(seq * 0.1), frame_id="world", pose=planar_pose(seq, 2, 0.5))
    return Sample(key, "foxglove.PoseInFrame", pose.SerializeToString(), seq * 100_000_000, seq, 5)


def record(path, seqs):
    with Recorder(path) as recorder:
        for seq in seqs:
            recorder.write(sample(seq))
    return recorder


def test_a_log_gives_back_the_same_bytes(tmp_path):
    record(tmp_path / "a.mcap", range(1, 50))
    assert [s._replace(boot=5) for s in read_log(tmp_path / "a.mcap")] == [sample(n) for n in range(1, 50)]


def test_anybody_can_decode_it_with_the_schemas_inside(tmp_path):
    record(tmp_path / "a.mcap", range(1, 5))
    with (tmp_path / "a.mcap").open("rb") as file:
        decoded = [m for *_, m in make_reader(file, decoder_factories=[DecoderFactory()]).iter_decoded_messages()]
    assert [m.pose.position.x for m in decoded] == [1, 2, 3, 4]


def test_requests_and_replies_carry_their_schemas_too(tmp_path):
    with Recorder(tmp_path / "a.mcap") as recorder:
        for half, type_ in (("request", topics.SET_MODE.message), ("reply", topics.SET_MODE.reply)):
            recorder.write(Sample(f"{topics.SET_MODE.at('v')}/{half}", type_.DESCRIPTOR.full_name, type_().SerializeToString(), 1, 1, 5))
    with (tmp_path / "a.mcap").open("rb") as file:
        decoded = [m for *_, m in make_reader(file, decoder_factories=[DecoderFactory()]).iter_decoded_messages()]
    assert {type(m).__name__ for m in decoded} == {"ModeRequest", "Reply"}


def test_gaps_are_counted_and_make_the_log_incomplete(tmp_path):
    record(tmp_path / "a.mcap", [1, 2, 5, 6, 9])
    metadata = log_metadata(tmp_path / "a.mcap")
    assert metadata["complete"] == "false"
    assert metadata["gap uvf/v/nav/pose"] == "4"


def test_topics_that_are_not_logged_stay_out(tmp_path):
    with Recorder(tmp_path / "a.mcap") as recorder:
        recorder.write(sample(1, topics.HEALTH.by("slam").at("sys")))
    assert recorder.written == 0


def test_a_killed_recorder_loses_only_what_came_after_the_last_flush(tmp_path):
    recorder = Recorder(tmp_path / "a.mcap")
    for n in range(1, 30):
        recorder.write(sample(n))
    recorder.flush()
    cut = tmp_path / "cut.mcap"
    cut.write_bytes((tmp_path / "a.mcap").read_bytes())
    recorder.close()
    with pytest.raises(BadInput, match="uvf log recover"):
        list(read_log(cut))
    assert recover(cut, tmp_path / "whole.mcap") == 29
    assert [s.seq for s in read_log(tmp_path / "whole.mcap")] == list(range(1, 30))


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full on this system")
def test_a_full_disk_ends_the_recording_with_one_line():
    with Recorder(Path("/dev/full")) as recorder:
        for n in range(1, 200):
            recorder.write(sample(n))
        recorder.flush()
        assert "No space left" in recorder.error
        assert recorder.gaps == {"uvf/v/nav/pose": 199}


def test_a_log_that_cannot_be_written_says_where(tmp_path):
    with pytest.raises(BadInput, match="choose another place"):
        Recorder(tmp_path / "missing" / "a.mcap")


def test_the_hash_depends_on_every_byte_but_not_on_the_boot(tmp_path):
    one = record(tmp_path / "a.mcap", range(1, 9)).hash.hexdigest()
    assert record(tmp_path / "b.mcap", range(1, 9)).hash.hexdigest() == one
    with Recorder(tmp_path / "c.mcap") as other:
        for n in range(1, 9):
            message = sample(n)
            other.write(message._replace(payload=DriveCommand(linear=1).SerializeToString()) if n == 4 else message)
    assert other.hash.hexdigest() != one


def test_recovering_keeps_what_is_attached(tmp_path):
    with Recorder(tmp_path / "a.mcap", {"missions/demo.yaml": b"about: x"}) as recorder:
        recorder.write(sample(1))
        recorder.flush()
        (tmp_path / "cut.mcap").write_bytes((tmp_path / "a.mcap").read_bytes())
    recover(tmp_path / "cut.mcap", tmp_path / "whole.mcap")
    assert log_attachments(tmp_path / "whole.mcap") == {"missions/demo.yaml": b"about: x"}


def latched(seq, text=b"", stamp_ns=0, epoch=0, key="uvf/v/map/grid"):
    return Sample(key, "foxglove.Grid", text, stamp_ns, seq, 5, epoch)


def test_the_next_file_begins_with_what_stands(tmp_path):
    with Recorder(tmp_path / "a.mcap") as first:
        for message in (latched(1, b"old"), latched(2, b"new"), latched(1, b"plan", key="uvf/v/mission/plan"), sample(1)):
            first.write(message)
    with Recorder(tmp_path / "b.mcap", before=first) as second:
        second.write(sample(2))
    assert sorted((s.key, s.payload) for s in read_log(tmp_path / "b.mcap") if s.key != "uvf/v/nav/pose") == [
        ("uvf/v/map/grid", b"new"),
        ("uvf/v/mission/plan", b"plan"),
    ]
    assert log_metadata(tmp_path / "b.mcap")["carried"] == "2"


def test_late_history_does_not_take_the_place_of_what_is_newer(tmp_path):
    with Recorder(tmp_path / "a.mcap") as first:
        first.write(latched(2, b"new"))
        first.write(latched(1, b"old"))
    with Recorder(tmp_path / "b.mcap", before=first):
        pass
    assert [s.payload for s in read_log(tmp_path / "b.mcap")] == [b"new"]


def test_what_an_epoch_has_left_does_not_stand_in_the_next_but_an_operators_word_does(tmp_path):
    with Recorder(tmp_path / "a.mcap") as first:
        first.write(latched(1, b"map", epoch=1))
        first.write(latched(1, b"stop", epoch=1, key="uvf/sys/cmd/gcs"))
        first.write(latched(1, b"plan", epoch=2, key="uvf/v/mission/plan"))
    with Recorder(tmp_path / "b.mcap", before=first):
        pass
    assert {s.payload for s in read_log(tmp_path / "b.mcap")} == {b"stop", b"plan"}


def test_a_change_of_file_is_no_gap_but_what_is_lost_meanwhile_is(tmp_path):
    first = record(tmp_path / "a.mcap", [1, 2, 5])
    with Recorder(tmp_path / "b.mcap", before=first) as second:
        second.write(sample(6))
    with Recorder(tmp_path / "c.mcap", before=second) as third:
        third.write(sample(10))
    gaps = [log_metadata(tmp_path / f"{name}.mcap")["gap uvf/v/nav/pose"] for name in "abc"]
    assert gaps == ["2", "2", "5"]


def test_a_log_knows_when_its_recording_began(tmp_path):
    clock = Sample("uvf/sys/time/clock", "uvf.v1.Clock", b"", 30_000_000_000, 3000, 5)
    with Recorder(tmp_path / "late.mcap") as recorder:
        recorder.write(latched(1))
        recorder.write(clock)
    with Recorder(tmp_path / "whole.mcap") as recorder:
        recorder.write(clock._replace(stamp_ns=10_000_000, seq=1))
    assert log_begin(tmp_path / "late.mcap") == 30_000_000_000
    assert log_begin(tmp_path / "whole.mcap") == 0


MAGIC = b"\x89MCAP0\r\n"
ODD = {
    "missing": (lambda path: None, "No such file"),
    "folder": (lambda path: path.mkdir(), "is a folder; and there is no log in it"),
    "folder of a run": (
        lambda path: (path.mkdir(), (path / "log-000.mcap").touch()),
        "is a folder; name the log in it, such as .*log-000.mcap",
    ),
    "empty": (lambda path: path.touch(), "is empty"),
    "text": (lambda path: path.write_text("about: a mission"), "is no MCAP log"),
    "short text": (lambda path: path.write_text("x"), "is no MCAP log"),
    "only begun": (lambda path: path.write_bytes(b"\x89MCAP"), "uvf log recover"),
    "only the magic": (lambda path: path.write_bytes(MAGIC), "cut off .* 'uvf log recover .*a.mcap'"),
    "the magic twice": (lambda path: path.write_bytes(MAGIC * 2), "cut off .* 'uvf log recover .*a.mcap'"),
    "only a header": (lambda path: path.write_bytes(MAGIC + b"\x01" + (8).to_bytes(8, "little") + bytes(8)), "cut off .* 'uvf log recover"),
    "device": (lambda path: path.symlink_to("/dev/null"), "is no file"),
    "pipe": (os.mkfifo, "is no file"),
    "link to itself": (lambda path: path.symlink_to(path), "Too many levels of symbolic links"),
}


@pytest.mark.parametrize("case", ODD)
@pytest.mark.parametrize("read", [lambda path: list(read_log(path)), log_metadata, log_begin, log_attachments])
def test_what_is_no_log_is_told_in_one_line(tmp_path, case, read):
    make, expected = ODD[case]
    make(tmp_path / "a.mcap")
    with pytest.raises(BadInput, match=expected) as caught:
        read(tmp_path / "a.mcap")
    assert "\n" not in str(caught.value)


def test_wherever_it_was_cut_off_it_is_told_in_one_line(tmp_path):
    record(tmp_path / "a.mcap", range(1, 50))
    whole = (tmp_path / "a.mcap").read_bytes()
    for length in range(1, len(whole), 97):
        (tmp_path / "cut.mcap").write_bytes(whole[:length])
        with pytest.raises(BadInput, match="uvf log recover"):
            list(read_log(tmp_path / "cut.mcap"))


def test_a_log_is_read_in_the_order_of_mcaps_own_reader_however_the_stamps_of_its_chunks_overlap(tmp_path):
    dice = random.Random(1)
    with Recorder(tmp_path / "a.mcap") as recorder:
        for n in range(1, 3000):
            key = dice.choice(("uvf/v/nav/pose", "uvf/w/nav/pose", "uvf/v/map/grid"))
            stamp_ns = dice.choice((n, n, n, 0, n // 2, dice.randrange(4000)))
            recorder.write(Sample(key, "foxglove.PoseInFrame", b"%d" % n, stamp_ns, n, 5))
            if n % 50 == 0:
                recorder.flush()
    with (tmp_path / "a.mcap").open("rb") as file:
        expected = [(c.topic[1:], m.data) for _, c, m in make_reader(file).iter_messages()]
    assert [(s.key, s.payload) for s in read_log(tmp_path / "a.mcap")] == expected
    of_v = [pair for pair in expected if pair[0].startswith("uvf/v/")]
    assert [(s.key, s.payload) for s in read_log(tmp_path / "a.mcap", ["uvf/v/nav/pose", "uvf/v/map/grid"])] == of_v


def test_a_log_is_not_saved_into_itself(tmp_path):
    record(tmp_path / "a.mcap", range(1, 9))
    (tmp_path / "same.mcap").symlink_to(tmp_path / "a.mcap")
    with pytest.raises(BadInput, match="name another file"):
        recover(tmp_path / "a.mcap", tmp_path / "same.mcap")
    assert len(list(read_log(tmp_path / "a.mcap"))) == 8


@pytest.fixture
def chunked(tmp_path, monkeypatch):
    """A log of 20 chunks, and where they begin."""
    monkeypatch.setattr("uvf.runtime.log.recording.CHUNK", 2000)
    path = tmp_path / "chunked.mcap"
    with Recorder(path) as recorder:
        for n in range(1, 401):
            recorder.write(Sample("uvf/v/sensor/imu", "uvf.v1.Imu", bytes((n * i) % 251 for i in range(100)), n * 10_000_000, n, 5))
    with path.open("rb") as file:
        return path, sorted(index.chunk_start_offset for index in make_reader(file).get_summary().chunk_indexes)


DAMAGES = {
    "one byte": lambda data, offsets: [(offsets[5] + 200, bytes((data[offsets[5] + 200] ^ 0xFF,)))],
    "the first chunk": lambda data, offsets: [(offsets[0] + 200, bytes(100))],
    "a record's head": lambda data, offsets: [(offsets[5], bytes(300))],
    "a length": lambda data, offsets: [(offsets[5] + 1, b"\xff" * 8)],
}


@pytest.mark.parametrize("damage", DAMAGES)
def test_a_damaged_chunk_costs_no_more_than_itself_and_nothing_false_is_handed_over(tmp_path, chunked, damage):
    path, offsets = chunked
    data = bytearray(path.read_bytes())
    true = {sample.seq: sample.payload for sample in read_log(path)}
    for at, new in DAMAGES[damage](data, offsets):
        data[at : at + len(new)] = new
    broken, told = tmp_path / "broken.mcap", []
    broken.write_bytes(data)
    with pytest.raises(BadInput, match="uvf log recover"):
        list(read_log(broken))
    count = recover(broken, tmp_path / "saved.mcap", told.append)
    saved = {sample.seq: sample.payload for sample in read_log(tmp_path / "saved.mcap")}
    assert len(true) - 3 * 400 // len(offsets) <= count < len(true)
    assert saved.items() <= true.items()
    assert told or damage in ("a record's head", "a length")


def test_what_it_was_made_with_is_told_by_the_run_and_not_by_who_copies_it(tmp_path):
    with Recorder(tmp_path / "a.mcap", made_with={"jsbsim": "1.0"}):
        pass
    with Recorder(tmp_path / "b.mcap"):
        pass
    assert log_metadata(tmp_path / "a.mcap")["jsbsim"] == "1.0"
    assert "jsbsim" not in log_metadata(tmp_path / "b.mcap")
