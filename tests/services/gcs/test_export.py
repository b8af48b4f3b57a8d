"""A minute of the run becomes a file: the log's own bytes, or a page that plays them; what goes wrong is told."""

import os
import re
import time

import pytest

from services.gcs.log_exporter import PATH, LogExporter
from services.gcs.page.viser_replay import write_replay
from tests.runtime.log.test_recording import latched, sample
from tests.services.gcs.recorded import demo_log
from uvf.models.yaml_data import BadInput
from uvf.runtime.log.reading import read_log
from uvf.runtime.log.recording import Recorder


def made(exporter, kind, ended=0.0, length=60.0):
    """The state when the file is made or cannot be."""
    exporter.begin(kind, ended, length)
    assert exporter.state.making == kind
    end = time.monotonic() + 120
    while exporter.state.making and time.monotonic() < end:
        time.sleep(0.02)
    return exporter.state


@pytest.fixture
def recorded(tmp_path):
    """A run that is being recorded."""
    with Recorder(tmp_path / "log-000.mcap") as log:
        for message in (latched(1, b"map"), *map(sample, range(1, 100))):
            log.write(message)
        log.flush()
        yield tmp_path


def test_the_log_that_is_taken_away_is_the_log(recorded):
    exporter = LogExporter(recorded)
    state = made(exporter, "mcap")
    assert state.path == PATH + state.name and state.size == exporter.files[state.path].stat().st_size
    assert [s._replace(boot=5) for s in read_log(exporter.files[state.path], ["uvf/v/nav/pose"])] == [sample(n) for n in range(1, 100)]
    exporter.close()
    assert not exporter.files[state.path].exists()


def test_one_file_takes_the_place_of_the_one_before(recorded):
    exporter = LogExporter(recorded)
    first = exporter.files[made(exporter, "mcap").path]
    time.sleep(1.1)  # files are named by the second
    assert made(exporter, "mcap").name != first.name
    assert not first.exists() and len(exporter.files) == 1


def test_two_at_a_time_are_one(recorded):
    exporter = LogExporter(recorded)
    exporter.begin("mcap", 0.0, 60.0)
    exporter.begin("html", 0.0, 60.0)
    assert exporter.state.making == "mcap"


def test_what_cannot_be_made_is_told(recorded, tmp_path):
    exporter = LogExporter(recorded)
    assert "no clock" in made(exporter, "html").fault
    assert "holds nothing of that time" in made(exporter, "mcap", ended=50.0, length=10.0).fault
    os.utime(recorded / "log-000.mcap", (0, 0))
    assert "holds no log of that time" in made(exporter, "mcap").fault
    assert "is no folder" in made(LogExporter(tmp_path / "missing"), "mcap").fault


def test_a_page_plays_a_log_of_the_real_thing_and_needs_nothing_else(tmp_path):
    write_replay(demo_log(tmp_path), tmp_path / "page.html")
    page = (tmp_path / "page.html").read_text(encoding="utf-8")
    assert len(page) > 1_000_000 and "__VISER_EMBED_DATA__" in page and "const CAPTIONS = [[0" in page
    assert not re.search(r"<(script|link)[^>]+(src|href)=\"(?!data:)", page)


def test_a_log_without_a_mission_is_told(recorded, tmp_path):
    with pytest.raises(BadInput, match=r"no clock|still being written"):
        write_replay(recorded / "log-000.mcap", tmp_path / "page.html")
