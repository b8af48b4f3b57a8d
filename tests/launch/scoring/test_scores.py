"""Each measure against a run made by hand whose figure is known."""

import numpy as np
import pytest

from launch.scoring.scores import MEASURES, Scorer, Verdict
from schemas import topics
from schemas.messages import Contact, Mission, MissionItem, MissionProgress, NavState, PoseInFrame, Vector3
from uvf.models.mission.file import Criterion
from uvf.models.scenario import ROOT, load_scenario
from uvf.runtime.bus.interface import Sample
from uvf.runtime.messages.convert import occupancy_grid, planar_pose, stamp

SITE = load_scenario(ROOT / "missions" / "demo.yaml")
SQUARE = [(0, 0), (100, 0), (100, 100), (0, 100)]


def sample(owner, topic, message, t):
    return Sample(topic.at(owner), message.DESCRIPTOR.full_name, message.SerializeToString(), round(t * 1e9), 1, 0)


def value(owner, measure, samples):
    scorer = Scorer(SITE)
    for each in samples:
        scorer.heard(each)
    return MEASURES[measure](scorer._tracks[owner])


def truth(owner, t, x, y, z=0.0):
    return sample(owner, topics.TRUTH, NavState(timestamp=stamp(t), position=Vector3(x=x, y=y, z=z)), t)


def flight(offset, z):
    items = [MissionItem(position=Vector3(x=x, y=y, z=50)) for x, y in SQUARE]
    yield sample("milvus", topics.MISSION, Mission(items=[*items, MissionItem(kind=MissionItem.JUMP)]), 0)
    yield truth("milvus", 0.5, 1000, 1000, 500)
    yield sample("milvus", topics.PROGRESS, MissionProgress(reached=-1), 0.5)
    yield sample("milvus", topics.PROGRESS, MissionProgress(reached=0), 1)
    yield truth("milvus", 2, 50, -offset, z)
    yield truth("milvus", 3, 100 + offset / 2, 50, 50)
    for i, t in ((1, 4), (2, 5), (3, 6), (0, 7)):
        yield sample("milvus", topics.PROGRESS, MissionProgress(reached=i, laps=int(t == 7)), t)


def test_the_way_driven_is_the_length_of_the_true_track():
    assert value("burger", "distance_driven", [truth("burger", t, 3 * t, 4 * t) for t in range(5)]) == pytest.approx(20)


def test_a_contact_counts_once_however_long_it_lasts():
    touches = (False, True, True, False, True)
    assert value("burger", "contacts", [sample("burger", topics.CONTACT, Contact(touching=c), i) for i, c in enumerate(touches)]) == 2


def test_the_pose_error_compares_the_same_moment():
    pose = PoseInFrame(pose=planar_pose(1.5 + 0.3, 0.4, 0))
    samples = [truth("burger", 1, 1, 0), truth("burger", 2, 2, 0), sample("burger", topics.POSE, pose, 1.5), truth("burger", 3, 9, 9)]
    assert value("burger", "pose_error", samples) == pytest.approx(0.5)
    assert value("burger", "pose_error", []) == float("inf")


def test_a_wholly_free_map_knows_the_whole_floor_and_an_unknown_one_nothing():
    for cells, expected in ((0, 1.0), (-1, 0.0), (100, 0.0)):
        grid = occupancy_grid(np.full((800, 800), cells, dtype=np.int8), 0.05, -20, -20, "burger/map", 1.0)
        assert value("burger", "mapped_floor", [sample("burger", topics.MAP, grid, 1)]) == expected


def test_path_and_altitude_are_scored_from_the_first_waypoint_on():
    samples = list(flight(offset=7.0, z=52.5))
    assert value("milvus", "path_error", samples) == pytest.approx(7.0)
    assert value("milvus", "altitude_error", samples) == pytest.approx(2.5)
    assert value("milvus", "circuits", samples) == 1
    assert value("milvus", "legs", samples) == 5


def test_without_a_flight_nothing_is_passed():
    assert value("milvus", "path_error", []) == float("inf")
    verdicts = Scorer(SITE).judge()
    assert not any(v.passed for v in verdicts)


def test_a_verdict_holds_both_limits():
    criterion = Criterion("burger", "contacts", at_least=1, at_most=2)
    assert [Verdict(criterion, v).passed for v in (0.9, 1, 2, 2.1)] == [False, True, True, False]
    assert Verdict(criterion, 1).limits == ">= 1 and <= 2"
