"""A part of a log has the log's own bytes, opens alone, and can be taken while the log is being written."""

import pytest

from schemas import topics
from tests.golden.make import GOLDEN as LOG
from tests.runtime.log.test_recording import latched, record, sample
from uvf.models.yaml_data import BadInput
from uvf.runtime.log import recording
from uvf.runtime.log.excerpt import Span, excerpt
from uvf.runtime.log.reading import log_attachments, log_end, read_log
from uvf.runtime.log.recording import Recorder
from uvf.runtime.messages.step_times import NS


def of(log):
    return [(s.key, s.stamp_ns, s.seq, s.type_name, s.payload) for s in read_log(log)]


def test_a_part_of_a_mission_is_what_the_log_has_of_that_time(tmp_path):
    span = Span(2 * NS, 6 * NS)
    count = excerpt([LOG], tmp_path / "part.mcap", span)
    inside = [one for one in of(LOG) if span.since <= one[1] <= span.until]
    part = of(tmp_path / "part.mcap")
    assert [one for one in part if one[1] >= span.since] == inside and len(inside) == count > 1000
    assert log_end(tmp_path / "part.mcap") == span.until
    assert log_attachments(tmp_path / "part.mcap") == log_attachments(LOG)


def test_it_begins_with_the_newest_of_what_stood_then(tmp_path):
    with Recorder(tmp_path / "a.mcap") as log:
        for message in (latched(1, b"old"), latched(2, b"new"), sample(1), sample(5), latched(3, b"later", stamp_ns=NS), sample(20)):
            log.write(message)
    assert excerpt([tmp_path / "a.mcap"], tmp_path / "part.mcap", Span(500_000_000, NS)) == 2
    assert [(s.payload, s.seq) for s in read_log(tmp_path / "part.mcap") if s.key == "uvf/v/map/grid"] == [(b"new", 2), (b"later", 3)]


def test_a_log_that_is_being_written_gives_what_has_been_flushed(tmp_path):
    with Recorder(tmp_path / "a.mcap", {"missions/demo.yaml": b"about: x"}) as log:
        for n in range(1, 30):
            log.write(sample(n))
        log.flush()
        assert excerpt([log.path], tmp_path / "part.mcap", Span(0, 10 * NS)) == 29
    assert log_attachments(tmp_path / "part.mcap") == {"missions/demo.yaml": b"about: x"}


def test_by_the_recorders_own_clock_a_simulation_that_has_started_over_is_no_riddle(tmp_path, monkeypatch):
    wall = iter(range(1000, 2000))
    monkeypatch.setattr(recording.time, "time_ns", lambda: next(wall) * NS)
    record(tmp_path / "a.mcap", (1, 2, 3, 1, 2, 3))
    assert excerpt([tmp_path / "a.mcap"], tmp_path / "part.mcap", Span(1002 * NS, 1004 * NS, recorded=True)) == 3
    assert sorted(s.seq for s in read_log(tmp_path / "part.mcap")) == [1, 2, 3]


def test_the_logs_of_a_run_are_one(tmp_path):
    with Recorder(tmp_path / "log-000.mcap") as first:
        for message in (latched(1, b"map"), sample(1), sample(2)):
            first.write(message)
    with Recorder(tmp_path / "log-001.mcap", before=first) as second:
        second.write(sample(3))
    excerpt([first.path, second.path], tmp_path / "part.mcap", Span(200_000_000, NS))
    assert [s.seq for s in read_log(tmp_path / "part.mcap", ["uvf/v/nav/pose"])] == [2, 3]
    assert [s.payload for s in read_log(tmp_path / "part.mcap", [topics.MAP.at("v")])] == [b"map"]


def test_what_cannot_be_done_is_one_line(tmp_path):
    record(tmp_path / "a.mcap", range(1, 9))
    with pytest.raises(BadInput, match="holds nothing of that time"):
        excerpt([tmp_path / "a.mcap"], tmp_path / "part.mcap", Span(50 * NS, 60 * NS))
    assert not (tmp_path / "part.mcap").exists()
    with pytest.raises(BadInput, match="name another file"):
        excerpt([tmp_path / "a.mcap"], tmp_path / "a.mcap", Span(0, NS))
    with pytest.raises(BadInput, match="choose another place"):
        excerpt([tmp_path / "a.mcap"], tmp_path / "missing" / "part.mcap", Span(0, NS))
