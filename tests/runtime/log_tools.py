"""Programs run by tests in processes of their own, to see how much memory they take: ``python -m tests.runtime.log_tools NAME LOG``."""

import re
import sys
from pathlib import Path

from launch.commands.log_tools import describe_log
from schemas import topics
from schemas.messages import CompressedImage, NavState
from uvf.runtime.bus.interface import LocalBus
from uvf.runtime.contract.declaration import Reads, Writes, topic
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.contract.service import Service
from uvf.runtime.log.recovery import recover
from uvf.runtime.log.replay import into_service, onto_bus


class Watcher(Service):
    """Hears large messages and puts out what the log does not hold."""

    name = "watcher"
    hz = 10.0

    class Inputs(Reads):
        image: CompressedImage = topic(topics.IMAGE)

    class Outputs(Writes):
        state: NavState | None = topic(topics.NAV_STATE)

    def step(self, t: float, now: Inputs) -> Outputs:
        return self.Outputs(state=NavState())

    def stale(self, t, missing):
        return self.Outputs()


PROGRAMS = {
    "recover": lambda log: recover(log, log.with_suffix(".saved.mcap")),
    "onto_bus": lambda log: onto_bus(log, LocalBus(), rate=1e9),
    "into_service": lambda log: sum(1 for _ in into_service(log, ServiceInstance(Watcher, Watcher, "v"))),
    "describe": describe_log,
}


def peak():
    """Of the resident memory of this process [kB]."""
    return int(re.search(r"VmHWM:\s+(\d+)", Path("/proc/self/status").read_text())[1])


if __name__ == "__main__":
    before = peak()
    PROGRAMS[sys.argv[1]](Path(sys.argv[2]))
    sys.stdout.write(f"{peak() - before}\n")
