"""The tab Graph in words and as a drawing; and through the whole service."""

import re
from xml.etree import ElementTree

import pytest

from schemas import topics
from schemas.messages import LaserScan, PoseInFrame, Vector3
from services.gcs.actions.page import FilterTopics, Join, Leave, OpenTab, ScopeTopics, ShowService, ShowTopic
from services.gcs.page.words import action_in
from services.gcs.state.graph.graph_choice import GraphChoice
from services.gcs.state.graph.node_graph import NodeGraph, ServiceState, TopicState
from services.gcs.state.graph.topic_verdicts import Grade
from services.gcs.state.graph.traffic import SHOWN_MOST, KeyTraffic
from services.gcs.view.panels.graphs.graph import listed, summary
from services.gcs.view.panels.graphs.graph_drawing import MOST_BOXES, WIDTH, drawing
from services.gcs.view.panels.graphs.message_text import MOST_LINES, message_text
from services.gcs.watch import WatchedMessage
from tests.services.gcs.fakes import ME, OTHER, Station
from tests.services.gcs.scripted import UGV
from tests.services.gcs.watches import service_tokens

SCAN, POSE = (topic.at(UGV) for topic in (topics.SCAN, topics.POSE))


def topic_state(key, writers=(), readers=(), grade=Grade.FINE, why=""):
    return TopicState(key, "t", 5.0, 5.0, 0.1, 100.0, writers, readers, grade, why)


@pytest.fixture
def graph():
    services = ("sys/sim_ground", f"{UGV}/slam", f"{UGV}/planner", "milvus/autopilot_air")
    sick = topic_state(SCAN, services[:1], services[1:2], Grade.RED, "silent <for> 9 s")
    return NodeGraph((sick, topic_state(POSE, services[1:2], services[2:3])), tuple(ServiceState(s, Grade.FINE, "") for s in services))


def test_the_first_line_counts_and_each_problem_has_its_cause(graph):
    shown = summary(graph, True)
    assert "2 topics, 4 services: <span class='g-bad'>1 problem</span>" in shown
    assert "burger/sensor/scan</button> <span>silent &lt;for&gt; 9 s" in shown
    assert "no problem" in summary(NodeGraph(), True) and "Listening" in summary(graph, False)


def test_topics_are_listed_by_scope_text_service_and_bundle(graph):
    def keys(vehicle=UGV, **choice):
        return [one.key for one in listed(graph, GraphChoice(**choice), vehicle)]

    assert keys() == [SCAN, POSE] and keys("milvus") == [] and keys("milvus", scope="all") == [SCAN, POSE]
    assert keys(scope="problems") == [SCAN]
    assert keys(text="POSE") == [POSE] and keys(text="sim_gro") == [SCAN]
    assert keys(node=f"{UGV}/slam") == [SCAN, POSE] and keys(node=f"{UGV}/slam", to=f"{UGV}/planner") == [POSE]


def test_the_drawing_flows_downwards_with_the_bad_bundle_red_and_each_part_to_be_pressed(graph):
    svg = ElementTree.fromstring(drawing(graph, GraphChoice(), UGV))
    boxes = {g.get("data-key"): float(g.find("rect").get("y")) for g in svg.findall("g") if "g-box" in g.get("class")}
    assert list(boxes) == ["box sys/sim_ground", f"box {UGV}/slam", f"box {UGV}/planner"]
    assert sorted(boxes.values()) == list(boxes.values()) and len(set(boxes.values())) == 3
    bundles = {g.get("data-key"): g.get("class") for g in svg.findall("g") if "g-bundle" in g.get("class")}
    assert bundles == {f"bundle {UGV}/slam {UGV}/planner": "g-bundle g-fine", f"bundle sys/sim_ground {UGV}/slam": "g-bundle g-bad"}
    for part in svg.findall("g"):
        assert part.get("tabindex") == "0" and isinstance(action_in(f"[1, {part.get('data-do')[1:]}", ME), ShowService)


def test_a_crowd_of_services_stays_within_the_panel():
    services = tuple(ServiceState(f"sys/s{i}", Grade.FINE, "") for i in range(3 * MOST_BOXES))
    every = tuple(topic_state(f"uvf/sys/{i}", (f"sys/s{i}",), (f"sys/s{7 * i % 40}",)) for i in range(3 * MOST_BOXES))
    svg = ElementTree.fromstring(drawing(NodeGraph(every, services), GraphChoice(), UGV))
    rects = [g.find("rect") for g in svg.findall("g") if "g-box" in g.get("class")]
    assert len(rects) == MOST_BOXES
    assert all(float(r.get("x")) >= 0 and float(r.get("x")) + float(r.get("width")) <= WIDTH for r in rects)


def heard(key, payload, type_name="x"):
    traffic = KeyTraffic(key, 0.0)
    traffic.hear(WatchedMessage(key, type_name, payload, 0.0, 1), 1.0)
    return traffic


def test_a_message_is_shown_by_its_fields_whatever_it_holds():
    scan = LaserScan(frame_id="lidar", ranges=[1.5] * 700)
    lines = message_text(heard(SCAN, scan.SerializeToString())).splitlines()
    assert 'frame_id: "lidar"' in lines and lines.count("ranges: 1.5") == 3 and lines[-1] == "… and 697 more"
    assert (
        len(
            message_text(
                heard(topics.PATH.at(UGV), topics.PATH.message(poses=[{"position": Vector3(x=i)} for i in range(99)]).SerializeToString())
            ).splitlines()
        )
        <= MOST_LINES + 1
    )
    assert message_text(heard(SCAN, b"\xff\xff")).startswith("broken x")
    assert message_text(heard(SCAN, bytes(SHOWN_MOST + 1))).startswith(f"{SHOWN_MOST + 1} bytes")
    assert message_text(heard("uvf/nobody/knows", b"123", "zenoh/bytes")) == "3 bytes of zenoh/bytes"
    assert "default values" in message_text(heard(SCAN, b""))


def test_words_of_the_page_are_bounded():
    assert action_in('[1, "topic", "uvf/a/b"]', ME) == ShowTopic(ME, "uvf/a/b")
    assert action_in('[1, "topics-scope", "problems"]', ME) == ScopeTopics(ME, "problems")
    for word in (f'[1, "topic", "{"x" * 201}"]', f'[1, "topics-text", "{"x" * 65}"]', '[1, "topics-scope", "x"]', '[1, "service", "a"]'):
        assert action_in(word, ME) is None


class Watched:
    """A station with the tab open and two services on the bus."""

    def __init__(self):
        self.station = Station()
        self.watch = self.station.watch
        self.slam = service_tokens(f"{UGV}/slam", 2, pub=[topics.POSE], need=[topics.SCAN])
        self.sim = service_tokens("sys/sim_ground", 1, pub=["uvf/*/sensor/scan"])
        self.watch.told = [*self.sim, *self.slam]

    def run(self, seconds, scan=True):
        for i in range(round(seconds * 10)):
            self.watch.told = list(self.watch.told)
            if scan and i % 2:
                self.watch.say(SCAN, LaserScan(frame_id="<b>lidar"), 1)
            for _ in range(5):
                self.watch.say(POSE, PoseInFrame(), 2)
            self.station.run(0.1)

    def slot(self, name, page=ME):
        return self.station.page.pictures[-1].panels[page].html[name]


@pytest.fixture
def watched():
    watched = Watched()
    watched.station.press(OpenTab(ME, "graph"))
    return watched


def test_the_bus_is_watched_only_while_a_page_has_the_tab_open():
    station = Station()
    station.run(0.5)
    assert not station.watch.on
    station.press(OpenTab(ME, "graph"), Join(OTHER), OpenTab(OTHER, "graph"))
    assert station.watch.on and station.watch.starts == 1
    station.press(OpenTab(ME, "log"))
    assert station.watch.on
    station.press(Leave(OTHER))
    assert not station.watch.on
    station.service.close()
    assert station.watch.closed


def test_a_service_that_dies_is_told_with_what_lacks_it(watched):
    watched.run(8.0)
    assert "2 services: <span class='g-good'>no problem" in watched.slot("graph")
    watched.watch.told = watched.slam
    watched.run(8.0, scan=False)
    told = re.sub("<[^>]+>", "", watched.slot("graph"))
    assert "service gone since 7 s" in told or "service gone since 8 s" in told
    assert "1 of its topics is missed" in told and "1 problem<" in watched.slot("graph")
    assert f"its writer sys/sim_ground is gone; {UGV}/slam waits for it" in watched.slot("topics")
    assert "g-bad" in watched.slot("wiring") and "<table class='g-system'>" not in watched.slot("topics")


def test_each_browser_chooses_for_itself_and_sees_it_at_once(watched):
    watched.run(6.0)
    watched.station.press(Join(OTHER), OpenTab(OTHER, "graph"), FilterTopics(OTHER, "pose"), ShowTopic(ME, SCAN))
    assert f"{UGV}/sensor/scan" not in watched.slot("topics", OTHER) and f"{UGV}/nav/pose" in watched.slot("topics", OTHER)
    assert "frame_id: &quot;&lt;b&gt;lidar&quot;" in watched.slot("topics") and "<pre" not in watched.slot("topics", OTHER)
    watched.station.press(ShowTopic(ME, SCAN), ShowService(ME, f"{UGV}/slam", ""))
    assert "<pre" not in watched.slot("topics") and f"only of <b>{UGV}/slam" in watched.slot("topics")
