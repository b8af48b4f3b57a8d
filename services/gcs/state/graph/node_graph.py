"""Services and topics as a graph, each with what is wrong with it: what is declared, joined with what is heard."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from schemas import topics as table
from schemas.messages import Clock, Process
from schemas.topics import PREFIX, SYSTEM
from services.gcs.state.graph.endpoints import EndpointIndex, LivingService, ServiceBook
from services.gcs.state.graph.topic_verdicts import Grade, TopicEvidence, judged
from services.gcs.state.graph.traffic import BusTraffic, KeyTraffic
from services.gcs.state.process_book import ProcessBook
from uvf.runtime.messages.topic_lookup import is_of_table, topic_of

CLOCK_OLD_AFTER = 2.0  # s, wall
HEALTH = table.HEALTH.by("").at(SYSTEM)
PACE_AT_LEAST = 0.02
MOST_TOPICS = 1500


@dataclass(frozen=True)
class TopicState:
    """One topic, as it is declared and as it is heard."""

    key: str
    """As it is on the bus."""
    type_name: str
    nominal: float
    """Rate of the table [1/s, simulation time]; 0 = on change."""
    rate: float
    """Messages a second [1/s, wall]."""
    age: float | None
    """Of the newest message [s, wall]; None before the first."""
    bytes_per_second: float
    writers: tuple[str, ...]
    readers: tuple[str, ...]
    grade: Grade
    why: str
    gone: str = ""
    """The writer whose end explains its silence."""

    @property
    def owner(self) -> str:
        """The vehicle that it is of, or ``sys``."""
        return self.key.split("/")[1] if self.key.count("/") else ""


@dataclass(frozen=True)
class ServiceState:
    """One service; name: ``owner/service``."""

    name: str
    grade: Grade
    why: str

    @property
    def owner(self) -> str:
        """Its vehicle, or ``sys``."""
        return self.name.partition("/")[0]


@dataclass(frozen=True)
class NodeGraph:
    """The whole graph; topics and services with the worst first."""

    topics: tuple[TopicState, ...] = ()
    services: tuple[ServiceState, ...] = ()

    @property
    def problems(self) -> list[ServiceState | TopicState]:
        """All that is red or amber, the worst first; topics that are silent because a service is gone are that service's problem."""
        explained = {service.name for service in self.services if service.grade is Grade.RED}
        topics = [topic for topic in self.topics if topic.gone not in explained]
        everything: list[ServiceState | TopicState] = [*self.services, *topics]
        return sorted((one for one in everything if one.grade >= Grade.AMBER), key=lambda one: -one.grade)

    def bundles(self, topics: Iterable[TopicState]) -> dict[tuple[str, str], list[TopicState]]:
        """(writer, reader) -> the topics between these two, of those given."""
        found: dict[tuple[str, str], list[TopicState]] = {}
        for topic in topics:
            for writer in topic.writers:
                for reader in topic.readers:
                    if reader != writer:
                        found.setdefault((writer, reader), []).append(topic)
        return found


def pace_of(clock: Clock | None, heard_at: float | None, t: float) -> float:
    """Simulation time per wall time [-] at ``t`` [s, wall], at most 1; 0 while time stands still or no clock is heard."""
    if clock is None or heard_at is None or clock.state != Clock.RUNNING or t - heard_at > CLOCK_OLD_AFTER:
        return 0.0
    return min(max(clock.rate, PACE_AT_LEAST), 1.0) if clock.rate > 0 else 1.0


def graph_of(book: ServiceBook, traffic: BusTraffic, processes: ProcessBook, t: float, listened: float, pace: float) -> NodeGraph:
    """The graph at ``t`` [s, wall]. listened: for how long all keys have been heard [s, wall]; pace: of simulation time [-]."""
    index = EndpointIndex(book.services.values())
    keys = sorted({*traffic.keys, *(key for key in index.named if key.startswith(f"{PREFIX}/"))})[:MOST_TOPICS]
    topics = [_topic(_evidence(key, index, book, traffic.keys.get(key), t, listened, pace)) for key in keys]
    waiting = {name: vitals.report.missing for name, vitals in processes.vitals.items() if not vitals.silence(t)}
    told = {boot: processes.told[name] for boot, name in _processes(traffic).items() if name in processes.told}
    services = [_service(one, told.get(one.boot), waiting, t) for one in book.services.values()]
    return NodeGraph(
        tuple(sorted(topics, key=lambda one: (-one.grade, one.key))), tuple(sorted(services, key=lambda one: (-one.grade, one.name)))
    )


def _processes(traffic: BusTraffic) -> dict[int, str]:
    """Which process has which name: each says its name by the key of its sign of life."""
    return {boot: key.removeprefix(HEALTH) for key, heard in traffic.keys.items() if key.startswith(HEALTH) for boot in heard.senders}


def _evidence(
    key: str, index: EndpointIndex, book: ServiceBook, heard: KeyTraffic | None, t: float, listened: float, pace: float
) -> TopicEvidence:
    topic = topic_of(key)
    known = topic is not None or (heard is not None and is_of_table(key, heard.type_name))
    e = TopicEvidence(key, topic, known, heard, t, listened, pace)
    boots = set(heard.boots(t)) - {0} if heard is not None else set()
    for service, endpoint in index.at(key):
        if endpoint.way == "pub":
            _add_writer(e, service, "*" in endpoint.key, boots)
        else:  # one that is gone keeps its place in the graph, but waits for nothing
            waits = endpoint.way == "need" and service.gone_at is None
            (e.needed_by if waits else e.readers).append(service)
    e.readers = list({s.name: s for s in (*e.needed_by, *e.readers)}.values())
    if not e.writers and not e.gone:  # what processes say of themselves is no service's output
        e.writers = [s for s in book.services.values() if s.gone_at is None and s.boot in boots]
    return e


def _add_writer(e: TopicEvidence, service: LivingService, is_wide: bool, boots: set[int]) -> None:
    """The process that a message came from tells which of those that may write do; unheard, only who names the very key counts."""
    sends = service.boot in boots
    if service.gone_at is not None:
        if sends or not is_wide:
            e.gone.append(service)
    elif sends or (not is_wide and not boots):
        e.writers.append(service)
    elif is_wide or boots:
        e.perhaps.append(service)


def _topic(e: TopicEvidence) -> TopicState:
    grade, why = judged(e)
    rate, size = e.traffic.per_second(e.t) if e.traffic is not None else (0.0, 0.0)
    declared = e.topic.message.DESCRIPTOR.full_name if e.topic is not None else ""
    type_name = e.traffic.type_name if e.traffic is not None and e.traffic.type_name else declared
    writers, readers = (tuple(sorted({s.name for s in some})) for some in ([*e.writers, *(() if e.writers else e.gone)], e.readers))
    gone = e.gone[0].name if e.gone and not e.writers and e.is_silent else ""
    return TopicState(e.key, type_name, e.topic.hz if e.topic else 0.0, rate, e.age, size, writers, readers, grade, why, gone)


def _service(one: LivingService, process: Process | None, waiting: Mapping[str, Sequence[str]], t: float) -> ServiceState:
    if one.gone_at is not None:
        if process is not None and process.state == Process.ENDED:
            return ServiceState(one.name, Grade.QUIET, f"has ended, {t - one.gone_at:.0f} s ago")
        reason = f" ({process.reason[:120]})" if process is not None and process.reason else ""
        return ServiceState(
            one.name, Grade.RED, f"gone since {t - one.gone_at:.0f} s{reason}: start it again; the table below tells of its process"
        )
    lacking = [m.partition(":")[2] for inputs in waiting.values() for m in inputs if m.partition(":")[0] == one.kind]
    if lacking:
        return ServiceState(one.name, Grade.AMBER, f"waits for {', '.join(lacking[:4])[:120]}")
    return ServiceState(one.name, Grade.FINE, "of the system" if one.owner == SYSTEM else "")
