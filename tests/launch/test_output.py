"""What processes print is kept line by line, in files that never grow beyond their share."""

import os
import subprocess
import sys

import pytest

from launch.output import LONGEST_LINE, Output, RotatingLog

KEPT = 10_000


def lines(*paths):
    return [line for path in paths if path.exists() for line in path.read_bytes().splitlines()]


def test_a_log_keeps_its_newest_lines_whole_in_order_and_within_its_share(tmp_path):
    path, older = tmp_path / "x.log", tmp_path / "x.log.1"
    log = RotatingLog(path, KEPT)
    written = [f"line {n}".encode() for n in range(5000)]
    for n, line in enumerate(written):
        log.write(line + b"\n")
        kept = lines(older, path)
        assert path.stat().st_size + (older.stat().st_size if older.exists() else 0) <= KEPT
        assert kept == written[n + 1 - len(kept) : n + 1]
    assert sum(len(line) + 1 for line in kept) > 0.45 * KEPT


def test_nothing_is_lost_between_a_process_and_its_rotating_log(tmp_path):
    """As much output as one rotation keeps, written by a real process in one go."""
    script = "import sys\nfor n in range(1200): sys.stdout.write(f'{n:06}\\n')"
    process = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE)
    output = Output(process.stdout, RotatingLog(tmp_path / "x.log", KEPT).write)
    process.wait()
    output.finish()
    assert lines(tmp_path / "x.log.1", tmp_path / "x.log") == [f"{n:06}".encode() for n in range(1200)]
    assert (tmp_path / "x.log.1").exists()


def test_every_byte_is_kept_and_counted_as_it_is(tmp_path):
    """Also what is no text, two bytes a letter, or looks like a place for an argument."""
    log = RotatingLog(tmp_path / "x.log", KEPT)
    line = bytes(n for n in range(256) if n not in b"\r\n") + "%s %d é".encode() + b"\r\n"
    for _ in range(100):
        log.write(line)
        assert (tmp_path / "x.log").stat().st_size <= KEPT / 2
    kept = b"".join(path.read_bytes() for path in (tmp_path / "x.log.1", tmp_path / "x.log"))
    assert kept == line * (len(kept) // len(line))


def test_a_log_on_a_full_disk_says_so_and_goes_on_when_there_is_room_again(tmp_path):
    """A process that may write files of no more than 4 kB, and later of any size."""
    script = f"""
import resource
from pathlib import Path
from launch.output import RotatingLog
unlimited = resource.getrlimit(resource.RLIMIT_FSIZE)
log = RotatingLog(Path({str(tmp_path / "x.log")!r}), {KEPT})
refused = 0
for n in range(3000):
    resource.setrlimit(resource.RLIMIT_FSIZE, (4000, unlimited[1]) if n < 1000 else unlimited)
    try:
        log.write(b"line %06d\\n" % n)
    except OSError:
        refused += 1
print(refused)
"""
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stderr == ""
    assert 600 < int(done.stdout) < 1000 - 4000 / 12 + 2
    kept = lines(tmp_path / "x.log.1", tmp_path / "x.log")
    assert kept == [b"line %06d" % n for n in range(3000 - len(kept), 3000)]
    assert len(kept) > 0.45 * KEPT / 12


def test_a_run_that_is_started_again_goes_on_in_its_log(tmp_path):
    RotatingLog(tmp_path / "x.log").write(b"one\n")
    RotatingLog(tmp_path / "x.log").write(b"two\n")
    assert lines(tmp_path / "x.log") == [b"one", b"two"]


def read(written, write):
    reading, writing = os.pipe()
    output = Output(os.fdopen(reading, "rb"), write)
    with os.fdopen(writing, "wb") as file:
        file.write(written)
    output.finish()
    return output


@pytest.mark.parametrize(
    ("printed", "last"),
    [(b"one\nTraceback\nValueError: two\n\n", "ValueError: two"), (b"", ""), (b"no end", "no end"), (b"\xff\n", "\ufffd")],
)
def test_the_last_line_that_says_something_is_known(printed, last):
    assert read(printed, lambda line: None).last == last


def test_a_line_without_end_is_handed_on_in_pieces():
    pieces = []
    read(b"x" * (3 * LONGEST_LINE), pieces.append)
    assert [len(piece) for piece in pieces] == [LONGEST_LINE] * 3


def test_a_full_disk_loses_lines_but_holds_nobody_up():
    def full(line):
        raise OSError(28, "No space left on device")

    assert read(b"a line\n" * 50_000 + b"the last", full).last == "the last"
