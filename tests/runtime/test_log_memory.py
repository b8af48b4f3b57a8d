"""Tools that read logs hold a few chunks of them, not all."""

import random
import subprocess
import sys

import pytest

from schemas import topics
from tests.runtime.log_tools import PROGRAMS
from uvf.runtime.bus.interface import Sample
from uvf.runtime.log.recording import Recorder

IMAGES, SIZE = 150, 1_000_000  # bytes
GROWTH = 80_000  # kB


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    """Pictures that do not compress, ten a second, and beside each a message of somebody who stamps nothing."""
    path = tmp_path_factory.mktemp("large") / "a.mcap"
    noise = random.Random(1).randbytes(SIZE + IMAGES)
    with Recorder(path) as recorder:
        for n in range(1, IMAGES + 1):
            t = n * 100_000_000
            recorder.write(Sample(topics.IMAGE.at("v"), topics.IMAGE.message.DESCRIPTOR.full_name, noise[n : n + SIZE], t, n, 5))
            recorder.write(Sample("uvf/v/stranger", "", b"hello", 0, n, 6))
            for k in range(20):
                recorder.write(Sample(topics.NAV_STATE.at("v"), topics.NAV_STATE.message.DESCRIPTOR.full_name, b"", t - k, 20 * n + k, 5))
    return path


@pytest.mark.parametrize("program", PROGRAMS)
def test_a_large_log_does_not_fill_the_memory(log, program):
    command = (sys.executable, "-m", "tests.runtime.log_tools", program, str(log))
    done = subprocess.run(command, capture_output=True, text=True, check=True, timeout=100)
    assert int(done.stdout.split()[-1]) < GROWTH
