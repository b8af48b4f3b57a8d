"""A log put to use again: onto the bus at its own pace, or into one service whose outputs are compared."""

import contextlib
import functools
import tempfile
import time
from collections import deque
from collections.abc import Callable, Container, Iterable, Iterator
from pathlib import Path

from schemas.topics import SYSTEM, Qos
from uvf.models.scenario import Scenario, load_scenario
from uvf.models.yaml_data import BadInput
from uvf.runtime.bus.interface import Bus, LocalBus, Publisher, Query, Sample, matches
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.contract.service_runner import ServiceRunner, Warn
from uvf.runtime.log.comparison import TOLERANCE, Comparison, Difference
from uvf.runtime.log.reading import log_attachments, log_begin, log_end, read_log
from uvf.runtime.messages.step_times import NS, first_step_after
from uvf.runtime.messages.topic_lookup import topic_of

PAUSE_MOST = 3600 * NS
"""Simulation time in which nothing at all is recorded."""


@contextlib.contextmanager
def logged_site(log: Path) -> Iterator[Scenario]:
    """The mission that a log was recorded of, with its world and vehicles as they were then. Raises BadInput."""
    files = log_attachments(log)
    mission = next((name for name in files if name.startswith("missions/")), None)
    if mission is None:
        raise BadInput(f"log {log}: no mission is attached to it; name the one that it was recorded of with --mission")
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        for name, data in files.items():
            path = (root / name).resolve()
            if path.is_relative_to(root.resolve()):
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_bytes(data)
        try:
            site = load_scenario(root / mission, root)
        except BadInput as error:
            why = str(error).replace(f"{folder}/", "")
            raise BadInput(f"log {log}: the mission in it is of another version ({why}); name one with --mission") from error
        yield site


def _run_in(log: Path, begin: int, warn: Warn) -> Iterator[Sample]:
    """Without what is stamped long after everything else: somebody had another clock, and nobody can wait for that."""
    now = begin
    samples = read_log(log)
    for n, sample in enumerate(samples):
        if n and sample.stamp_ns > now + PAUSE_MOST:
            count = 1 + sum(1 for _ in samples)
            warn(f"log {log}: {count} messages are stamped more than {PAUSE_MOST // NS} s after all others and are left out")
            return
        now = max(now, sample.stamp_ns)
        yield sample


def onto_bus(log: Path, bus: Bus, rate: float = 1.0, go_on: Callable[[], bool] = lambda: True, warn: Warn = lambda line: None) -> int:
    """Publishes a log's messages at ``rate`` times real time [-]; returns how many. Raises BadInput.

    What stands at the head of a log that did not begin with the run is said at once.
    """
    publishers: dict[str, Publisher] = {}
    begin, begun = log_begin(log), time.monotonic()
    count = 0
    for sample in _run_in(log, begin, warn):
        while go_on() and (wait := begun + (sample.stamp_ns - begin) / NS / rate - time.monotonic()) > 0:
            time.sleep(min(wait, 0.1))
        if not go_on():
            break
        if sample.key not in publishers:
            topic = topic_of(sample.key)
            publishers[sample.key] = bus.publisher(sample.key, sample.type_name, topic.qos if topic else Qos.SENSOR)
        publishers[sample.key].put(sample.payload, sample.stamp_ns)
        count += 1
    return count


def into_service(log: Path, host: ServiceInstance, tolerance: float = TOLERANCE, warn: Warn = lambda line: None) -> Iterator[Difference]:
    """Feeds inputs, requests and answers of a log to one service and yields each field that it puts out otherwise.

    tolerance: of floats, absolute [unit of the field]. The log is read while the service runs, and held nowhere. Raises BadInput.
    """
    owners = (host.vehicle,) if host.vehicle else host.writes_for or (SYSTEM,)
    served = [request.at(owner) for request in host.service.requests.values() for owner in owners]
    asked = [request.at(owner) for request in host.service.calls.values() for owner in owners]
    writes = [topic.at(owner) for topic in host.service.outputs.values() for owner in owners if topic.logged]
    writes += [f"{key}/{half}" for key in served for half in ("request", "reply")]
    begin = log_begin(log)
    # Of the steps before, whose outputs may come late, none has been run here.
    comparison = Comparison(begin + round(host.service.latency * NS) if begin else -1, tolerance)
    bus = LocalBus()
    for key in writes:
        bus.subscribe(key, Qos.STATE, comparison.add_made)
    for key in asked:
        bus.serve(key, _answers(log, key))
    shell = ServiceRunner(host, bus)
    if begin:
        _take_up(shell, log, begin)

    @functools.cache
    def is_own(key: str) -> bool:
        return any(matches(own, key) for own in writes)

    def take(sample: Sample) -> None:
        if is_own(sample.key):
            comparison.add_logged(sample)
        if not is_own(sample.key) or sample.key.endswith("/request"):
            hand_over(bus, sample, asked)

    for _ in play(shell, _run_in(log, begin, warn), take, log_end(log)):
        yield from comparison.differences(shell.due_ns)
    shell.service.close()
    yield from comparison.rest()


def _take_up(shell: ServiceRunner, log: Path, begin: int) -> None:
    """In a log that begins within a run, the service begins like one that is started again there."""

    def newest(key: str) -> bytes | None:
        found = None
        for sample in read_log(log, [key]):
            if sample.stamp_ns > begin:
                break
            found = sample.payload
        return found

    shell.recall(newest)
    shell.n = first_step_after(begin, shell.type.hz)


def _answers(log: Path, key: str) -> Callable[[Query], None]:
    """Whatever the service asks is answered as it was then: the n-th question with the n-th reply."""
    replies = read_log(log, [f"{key}/reply"])

    def answer(query: Query) -> None:
        reply = next(replies, None)
        if reply is not None:
            query.answer(reply.payload, reply.stamp_ns)
        else:
            query.refuse("the log holds no answer")

    return answer


def play(shell: ServiceRunner, samples: Iterable[Sample], take: Callable[[Sample], None], end_ns: int | None = None) -> Iterator[None]:
    """Steps a service up to ``end_ns`` [ns], or to the last of ``samples``, which come by stamp; yields after each step.

    take: called with each sample before the first step that may read it. A recorded request carries the stamp of the step that
    answered it: it was there before that step.
    """
    last, at_step = 0, deque[Sample]()

    def take_waiting() -> None:
        while at_step:
            take(at_step.popleft())

    for sample in samples:
        while shell.due_ns < sample.stamp_ns and (end_ns is None or shell.due_ns <= end_ns):
            shell.advance()
            take_waiting()
            yield
        last = sample.stamp_ns
        if sample.stamp_ns == shell.due_ns and not sample.key.endswith("/request"):
            at_step.append(sample)
        else:
            take(sample)
    while shell.due_ns <= (last if end_ns is None else min(end_ns, last)):
        shell.advance()
        take_waiting()
        yield
    take_waiting()


def hand_over(bus: LocalBus, sample: Sample, asked: Container[str] = ()) -> None:
    """Puts a recorded message onto the bus, or sends a recorded request; asked: keys of requests that the service makes itself."""
    key, _, half = sample.key.rpartition("/")
    if half == "request":
        if key not in asked:
            bus.call(key, sample.payload, sample.stamp_ns - 1, lambda *reply: None)
    elif half != "reply":
        topic = topic_of(sample.key)
        bus.deliver(sample.key, sample.type_name, topic.qos if topic else Qos.STATE, sample.payload, sample.stamp_ns)
