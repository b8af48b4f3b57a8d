"""Runs a mission in one process as fast as it goes: every due step in order of time, none skipped."""

from collections.abc import Callable, Sequence

from schemas import topics
from schemas.messages import Clock
from uvf.runtime.bus.interface import LocalBus
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.contract.service_runner import ServiceRunner, Warn
from uvf.runtime.messages.step_times import NS, step_time


class Lockstep:
    """Runs all sim-clock services of a mission on one LocalBus.

    Steps due at the same time may run in any order: what one puts out at t is read only by steps later than t.
    """

    def __init__(
        self, hosts: Sequence[ServiceInstance], bus: LocalBus | None = None, warn: Warn = lambda line: None, contains: bool = False
    ) -> None:
        """contains: as of ``ServiceRunner``; without it a test sees what is raised."""
        self.bus = bus or LocalBus()
        self.shells = [ServiceRunner(host, self.bus, warn, contains) for host in hosts if host.service.clock == "sim"]
        self._clock = self.bus.publisher(topics.CLOCK.at("sys"), Clock.DESCRIPTOR.full_name, topics.CLOCK.qos)
        self._tick = 1
        self._tick_ns = step_time(self._tick, topics.CLOCK.hz)

    def run(self, until: float, watch: Callable[[float], bool] = lambda t: True) -> None:
        """Runs up to ``until`` [s, simulation time], or until ``watch(t)``, asked at each tick, is False."""
        end_ns = round(until * NS)
        while True:
            t_ns = min((shell.due_ns for shell in self.shells), default=end_ns + 1)
            if min(t_ns, self._tick_ns) > end_ns:
                return
            if self._tick_ns <= t_ns:
                if not self._publish_tick(watch):
                    return
                continue
            for shell in self.shells:
                if shell.due_ns == t_ns:
                    shell.advance()

    def _publish_tick(self, watch: Callable[[float], bool]) -> bool:
        message = Clock(tick=self._tick, t_ns=self._tick_ns, lockstep=True)
        self._clock.put(message.SerializeToString(deterministic=True), self._tick_ns)
        t = self._tick_ns / NS
        self._tick += 1
        self._tick_ns = step_time(self._tick, topics.CLOCK.hz)
        return watch(t)

    def failures(self) -> list[str]:
        """A line for each instance that has failed."""
        failed = [shell for shell in self.shells if shell.counters.failures]
        return [f"{shell.type.name} of {shell.owner} failed: {shell.counters.failures} of its steps" for shell in failed]

    def close(self) -> None:
        """Closes all services."""
        for shell in self.shells:
            shell.service.close()
