"""Memory and time that tools take for a log of 2 GB: pictures that do not compress, and many small messages.

Each runs in a process of its own; ``growth MB`` is what its peak of resident memory is above that of the started process.
"""

import json
import random
import sys
import tempfile
import time
from functools import partial
from pathlib import Path
from typing import Any

from benchmarks.measuring.memory import in_own_process, peak_mb
from benchmarks.measuring.timing import stopwatch
from launch.commands.bench import Figures
from launch.commands.log_tools import describe_log
from schemas import topics
from schemas.messages import Clock, CompressedImage, Imu, NavState, Vector3
from uvf.runtime.bus.interface import LocalBus, Sample
from uvf.runtime.contract.declaration import Reads, Writes, topic
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.contract.service import Service
from uvf.runtime.log.recording import Recorder
from uvf.runtime.log.recovery import recover
from uvf.runtime.log.replay import into_service, onto_bus

PICTURE, BYTES = 1_000_000, 2_000_000_000
SMALL = 200  # messages beside each picture
PERIOD = 100_000_000  # ns


class Watcher(Service):
    """Hears what is in the log, and puts out what is not."""

    name = "watcher"
    hz = 10.0

    class Inputs(Reads):
        image: CompressedImage = topic(topics.IMAGE)
        imu: Imu = topic(topics.IMU)

    class Outputs(Writes):
        state: NavState | None = topic(topics.NAV_STATE)

    def step(self, t: float, now: Inputs) -> Outputs:
        """An empty state each time."""
        return self.Outputs(state=NavState())


TOOLS = {
    "recover": lambda log: recover(log, log.with_suffix(".saved")),
    "replay onto a bus": lambda log: onto_bus(log, LocalBus(), rate=1e9),
    "replay into a service": lambda log: sum(1 for _ in into_service(log, ServiceInstance(Watcher, Watcher, "v"))),
    "info": describe_log,
}


def write_log(path: Path) -> None:
    """BYTES of noise as pictures, and SMALL messages beside each."""
    noise = random.Random(1).randbytes(PICTURE + 9973)
    imu = Imu(specific_force=Vector3(z=9.81)).SerializeToString()
    with Recorder(path) as recorder:
        for n in range(1, BYTES // PICTURE + 1):
            begin = n % 9973
            recorder.write(_sample(topics.IMAGE, noise[begin : begin + PICTURE], n * PERIOD, n))
            recorder.write(_sample(topics.CLOCK, Clock(t_ns=n * PERIOD).SerializeToString(), n * PERIOD, n))
            for k in range(SMALL):
                recorder.write(_sample(topics.IMU, imu, n * PERIOD + k * PERIOD // SMALL, n * SMALL + k))


def _sample(topic: topics.Topic[Any], payload: bytes, stamp_ns: int, seq: int) -> Sample:
    return Sample(topic.at("v"), topic.message.DESCRIPTOR.full_name, payload, stamp_ns, seq, 1)


def measure(tool: str, _: Path | None = None) -> Figures:
    """Size of the log, memory [MB] and time [s] of one tool, in a process of its own."""
    with tempfile.TemporaryDirectory() as folder:
        log = Path(folder) / "log.mcap"
        write_log(log)
        return {tool: in_own_process("benchmarks.runtime.log_memory", tool, str(log))}


CASES = {tool: partial(measure, tool) for tool in TOOLS}

if __name__ == "__main__":
    before, began = peak_mb(), time.perf_counter()
    with stopwatch() as taken:
        TOOLS[sys.argv[1]](Path(sys.argv[2]))
    row = {"log MB": Path(sys.argv[2]).stat().st_size / 1e6, "peak MB": peak_mb(), "growth MB": peak_mb() - before}
    sys.stdout.write(json.dumps(row | {"CPU s": taken[0], "wall s": taken[1]}) + "\n")
