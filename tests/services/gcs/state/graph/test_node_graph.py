"""What is declared, joined with what is heard: what is wrong with a topic, and why."""

import pytest

from schemas import topics
from schemas.messages import Clock, DriveCommand, Health, LaserScan, PoseInFrame, Process, Processes
from services.gcs.state.graph.endpoints import MOST_SERVICES
from services.gcs.state.graph.graph_book import GraphBook
from services.gcs.state.graph.node_graph import pace_of
from services.gcs.state.graph.topic_verdicts import Grade
from services.gcs.state.graph.traffic import FORGOTTEN_AFTER, KEY_LENGTH, MOST_KEYS
from services.gcs.state.process_book import ProcessBook
from services.gcs.state.refusals import PageRefusals
from services.gcs.watch import WatchedMessage
from tests.services.gcs.watches import service_tokens

SCAN, POSE, GRID = (topic.at("burger") for topic in (topics.SCAN, topics.POSE, topics.MAP))
SIM = service_tokens("sys/sim_ground", boot=1, pub=["uvf/*/sensor/scan"])
SLAM = service_tokens("burger/slam", boot=2, pub=[topics.POSE, topics.MAP], need=[topics.SCAN])
PLANNER = service_tokens("burger/planner", boot=3, need=[topics.POSE], sub=[topics.MAP])


class Bus:
    """A book that hears what the test says, in steps of 0.1 s."""

    def __init__(self, *tokens):
        self.told = []
        self.refused = PageRefusals(self.told.append)
        self.processes = ProcessBook(self.refused)
        self.book = GraphBook(self.processes, self.refused)
        self.tokens = [token for some in tokens for token in some]
        self.t = 0.0
        self.state, self.rate = Clock.RUNNING, 1.0
        self.book.begin(0.0)

    def run(self, seconds, *sources):
        """sources: (key, message, rate [1/s], process)."""
        for _ in range(round(seconds / 0.1)):
            self.t += 0.1
            said = [
                WatchedMessage(key, kind if isinstance(kind, str) else kind.DESCRIPTOR.full_name, b"", 0.0, boot)
                for key, kind, hz, boot in sources
                for _ in range(int(self.t * hz + 1e-6) - int((self.t - 0.1) * hz + 1e-6))
            ]
            self.book.hear(self.t, said, list(self.tokens))
        return self.graph

    @property
    def graph(self):
        self.book._made = None
        return self.book.graph(self.t, Clock(state=self.state, rate=self.rate), self.t)

    def topic(self, key):
        return next(one for one in self.graph.topics if one.key == key)

    def service(self, name):
        return next(one for one in self.graph.services if one.name == name)


LIDAR, LOCALIZED = (SCAN, LaserScan, 5, 1), (POSE, PoseInFrame, topics.POSE.hz, 2)


@pytest.fixture
def bus():
    return Bus(SIM, SLAM, PLANNER)


def test_all_is_well_when_what_is_declared_is_heard(bus):
    graph = bus.run(10.0, LIDAR, LOCALIZED)
    assert graph.problems == []
    scan = bus.topic(SCAN)
    assert scan.rate == pytest.approx(5.0, rel=0.1) and scan.age < 0.3 and scan.type_name == "foxglove.LaserScan"
    assert (scan.writers, scan.readers) == (("sys/sim_ground",), ("burger/slam",))


def test_of_those_that_may_write_a_key_the_one_that_sent_it_does(bus):
    bus.tokens += service_tokens("sys/sim_air", boot=9, pub=["uvf/*/sensor/scan"])
    bus.run(6.0, LIDAR)
    assert bus.topic(SCAN).writers == ("sys/sim_ground",)


def test_the_graph_leads_from_writer_to_reader(bus):
    graph = bus.run(6.0, LIDAR, LOCALIZED)
    assert set(graph.bundles(graph.topics)) == {("sys/sim_ground", "burger/slam"), ("burger/slam", "burger/planner")}
    assert [t.key for t in graph.bundles(graph.topics)["burger/slam", "burger/planner"]] == sorted([POSE, GRID])


def test_what_a_reader_needs_and_nobody_sends_is_red_and_comes_first(bus):
    graph = bus.run(6.0, LOCALIZED)
    assert graph.topics[0].key == SCAN and graph.topics[0].grade is Grade.RED
    assert graph.topics[0].why.startswith("never heard, and burger/slam waits for it: see why sys/sim_ground does not send it")


def test_what_is_needed_and_published_by_no_service_says_so():
    bus = Bus(SLAM)
    bus.run(6.0)
    assert "nobody publishes it: start the service that does" in bus.topic(SCAN).why


def test_a_topic_ages_against_its_own_period_and_latched_ones_never_do(bus):
    bus.run(6.0, LIDAR, LOCALIZED, (GRID, "foxglove.Grid", 1, 2))
    bus.run(topics.SCAN.max_age + 3.0, LOCALIZED)
    assert bus.topic(SCAN).why.startswith(f"silent for {topics.SCAN.max_age + 3.0:.0f} s, and burger/slam waits for it")
    bus.run(60.0, LIDAR, LOCALIZED)
    assert bus.graph.problems == [] and bus.topic(GRID).age > 60.0


def test_old_without_a_reader_that_needs_it_is_amber_and_a_command_that_pauses_is_neither():
    bus = Bus(service_tokens("burger/tracker", 4, pub=[topics.NAV_REPORT, topics.DRIVE.by("planner")]))
    report, drive = topics.NAV_REPORT.at("burger"), topics.DRIVE.by("planner").at("burger")
    bus.run(6.0, (report, topics.NAV_REPORT.message, 10, 4), (drive, DriveCommand, 20, 4))
    bus.run(6.0)
    assert bus.topic(report).grade is Grade.AMBER and "see what burger/tracker does" in bus.topic(report).why
    assert bus.topic(drive).grade is Grade.QUIET


def test_below_half_the_nominal_rate_is_slow_and_a_slow_simulation_is_no_fault(bus):
    half = (SCAN, LaserScan, 2, 1)
    bus.run(12.0, half, LOCALIZED)
    assert bus.topic(SCAN).grade is Grade.AMBER and bus.topic(SCAN).why.startswith("slow: 2.0 of 5 messages a second; sys/sim_ground")
    bus.rate = 0.4
    assert bus.topic(SCAN).grade is Grade.FINE


def test_while_time_stands_still_nothing_is_missing(bus):
    bus.state = Clock.PAUSED
    assert bus.run(60.0).problems == []
    assert bus.topic(SCAN).why == "simulation time stands still"


def test_right_after_the_tab_was_opened_nothing_is_missing(bus):
    assert bus.run(3.0).problems == []


def test_a_wrong_type_is_told_with_both_types(bus):
    bus.run(6.0, (SCAN, DriveCommand, 5, 1))
    assert bus.topic(SCAN).grade is Grade.RED
    assert "messages of uvf.v1.DriveCommand, the table says foxglove.LaserScan; look at sys/sim_ground" in bus.topic(SCAN).why


def test_two_processes_on_one_key_are_told_and_one_that_follows_another_is_not(bus):
    bus.run(6.0, LIDAR, LOCALIZED)
    bus.run(6.0, (SCAN, LaserScan, 5, 7), LOCALIZED)
    assert "two processes" not in bus.topic(SCAN).why
    bus.run(6.0, LIDAR, (SCAN, LaserScan, 5, 7), LOCALIZED)
    assert bus.topic(SCAN).why.startswith("two processes write it at once")


def test_a_key_that_no_table_has_is_told_with_who_sends_it(bus):
    bus.run(6.0, ("uvf/burger/nav/poze", PoseInFrame, 5, 2))
    assert bus.topic("uvf/burger/nav/poze").why.startswith("no such topic in the table; sent by burger/slam")


def test_what_nobody_reads_and_what_nobody_needs_is_no_problem():
    bus = Bus(service_tokens("burger/slam", 2, pub=[topics.MAP], sub=[topics.KEEP_OUT]))
    bus.run(6.0, (GRID, "foxglove.Grid", 1, 2))
    assert (bus.topic(GRID).grade, bus.topic(GRID).why) == (Grade.QUIET, "nobody reads it")
    assert bus.topic(topics.KEEP_OUT.at("burger")).why.startswith("read, but nobody publishes it")


def test_a_service_that_has_vanished_is_red_with_what_it_wrote_until_it_is_back(bus):
    bus.run(6.0, LIDAR, LOCALIZED)
    bus.tokens = [*SIM, *PLANNER]
    bus.run(8.0, LIDAR)
    assert bus.service("burger/slam").grade is Grade.RED and bus.service("burger/slam").why.startswith("gone since 8 s")
    assert "its writer burger/slam is gone; burger/planner waits for it; start it again" in bus.topic(POSE).why
    assert bus.graph.problems[0].name == "burger/slam"
    bus.tokens += SLAM
    bus.run(8.0, LIDAR, LOCALIZED)
    assert bus.graph.problems == []


def test_one_look_that_finds_nothing_makes_nobody_vanish(bus):
    bus.run(6.0, LIDAR, LOCALIZED)
    tokens, bus.tokens = bus.tokens, []
    bus.run(0.1, LIDAR, LOCALIZED)
    bus.tokens = tokens
    assert bus.run(0.1, LIDAR, LOCALIZED).problems == []


def test_why_its_process_failed_stands_beside_a_service_that_is_gone_and_one_that_has_ended_is_no_problem(bus):
    bus.run(6.0, LIDAR, LOCALIZED, (topics.HEALTH.by("localizer").at("sys"), Health, 2, 2))
    bus.tokens = [*SIM, *PLANNER]
    bus.processes.hear(bus.t, [Processes(processes=[Process(name="localizer", state=Process.FAILED, reason="exit code 3")])])
    bus.run(2.0, LIDAR, LOCALIZED)
    assert "(exit code 3)" in bus.service("burger/slam").why
    bus.processes.hear(bus.t, [Processes(processes=[Process(name="localizer", state=Process.ENDED)])])
    assert bus.service("burger/slam").grade is Grade.QUIET


def test_a_writer_that_was_started_again_is_not_called_slow_for_the_pause(bus):
    bus.run(8.0, LIDAR, LOCALIZED)
    bus.run(3.0, LIDAR)
    bus.tokens = [token.replace("slam/2", "slam/5") for token in bus.tokens]
    bus.run(1.0, LIDAR, (POSE, PoseInFrame, 50, 5))
    assert bus.graph.problems == [] and bus.topic(POSE).rate == pytest.approx(50.0, rel=0.15)


def test_a_service_that_says_that_it_waits_is_amber(bus):
    bus.processes.hear_health(0.0, [Health(service="slam", pid=4, missing=["slam:scan"])])
    bus.run(1.0)
    assert bus.service("burger/slam").why == "waits for scan"


def test_a_hostile_bus_fills_no_memory_and_its_names_are_turned_away(bus):
    bus.tokens += [f"@node/v{i}/intruder/1" for i in range(5 * MOST_SERVICES)] + [
        "@node/<b>/x/1",
        "@ep/a/b/pub/\x1b/x",
        "@ep",
        "@node/a/b/zz",
    ]
    flood = [WatchedMessage(f"uvf/v/{i}", "", b"", 0.0, i) for i in range(3 * MOST_KEYS)]
    flood += [WatchedMessage("uvf/" + "x" * KEY_LENGTH, "", b"", 0.0, 1), WatchedMessage("uvf/a\u202eb", "", b"", 0.0, 1)]
    bus.book.hear(0.0, flood, bus.tokens)
    graph = bus.run(0.2)
    assert len(bus.book.traffic.keys) == MOST_KEYS and len(graph.services) == MOST_SERVICES
    assert str(bus.refused) == "1000+ keys, 516+ services, 4 tokens".replace("516+", str(len(bus.refused._seen["services"])))
    assert len(bus.told) == 3 and all(line.isprintable() for line in bus.told)
    bus.t += FORGOTTEN_AFTER
    bus.run(0.3, LIDAR)
    assert SCAN in bus.book.traffic.keys


def test_simulation_time_goes_on_at_no_more_than_its_pace():
    running = Clock(state=Clock.RUNNING, rate=8.0)
    assert (pace_of(running, 1.0, 1.5), pace_of(running, 1.0, 9.0), pace_of(None, None, 1.0)) == (1.0, 0.0, 0.0)
    assert pace_of(Clock(state=Clock.RUNNING, rate=0.3), 1.0, 1.5) == pytest.approx(0.3)
