"""Logs hold the bytes as they travelled, open elsewhere, survive a kill and a full disk."""

from pathlib import Path

import pytest
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory

from schemas import topics
from schemas.convert import planar_pose, stamp
from schemas.messages import DriveCommand, PoseInFrame
from uvf.runtime.bus import Sample
from uvf.runtime.params import BadInput
from uvf.runtime.recording import Recorder, log_metadata, read_log, recover


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


def test_a_log_that_cannot_be_written_says_where(tmp_path):
    with pytest.raises(BadInput, match="choose another with --log"):
        Recorder(tmp_path / "missing" / "a.mcap")


def test_the_hash_depends_on_every_byte_but_not_on_the_boot(tmp_path):
    one = record(tmp_path / "a.mcap", range(1, 9)).hash.hexdigest()
    assert record(tmp_path / "b.mcap", range(1, 9)).hash.hexdigest() == one
    with Recorder(tmp_path / "c.mcap") as other:
        for n in range(1, 9):
            message = sample(n)
            other.write(message._replace(payload=DriveCommand(linear=1).SerializeToString()) if n == 4 else message)
    assert other.hash.hexdigest() != one
