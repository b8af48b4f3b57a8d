"""Each measure against a run made by hand whose figure is known."""

from math import cos, sin

import numpy as np
import pytest

from launch.scoring.finding import Finding
from launch.scoring.scores import Scorer, Verdict
from schemas import topics
from schemas.messages import (
    Contact,
    Event,
    Mission,
    MissionItem,
    MissionProgress,
    NavState,
    NavStatus,
    PoseInFrame,
    Quaternion,
    Vector3,
)
from uvf.models.mission.file import Criterion
from uvf.models.scenario import ROOT, load_scenario
from uvf.runtime.bus.interface import Sample
from uvf.runtime.messages.convert import occupancy_grid, planar_pose, stamp

SITE = load_scenario(ROOT / "missions" / "demo.yaml")
SQUARE = [(0, 0), (100, 0), (100, 100), (0, 100)]


def sample(owner, topic, message, t):
    return Sample(topic.at(owner), message.DESCRIPTOR.full_name, message.SerializeToString(), round(t * 1e9), 1, 0)


def found(owner, measure, samples):
    scorer = Scorer(SITE)
    for each in samples:
        scorer.heard(each)
    return scorer.measure(owner, measure)


def value(owner, measure, samples):
    return found(owner, measure, samples).value


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


def test_a_contact_counts_once_however_long_it_lasts_and_says_when_where_and_against_what():
    touched = ("", "box", "box", "", "door")
    samples = [truth("burger", 0, 0, 0), truth("burger", 4, 4, 8)]
    samples += [sample("burger", topics.CONTACT, Contact(touching=bool(other), other=other), i) for i, other in enumerate(touched)]
    assert found("burger", "contacts", samples) == Finding(2, 1.0, (1.0, 2.0), "against box, door")


def test_the_pose_error_is_the_largest_of_the_whole_run_and_compares_the_same_moment():
    poses = [sample("burger", topics.POSE, PoseInFrame(pose=planar_pose(x, y, 0)), t) for t, x, y in ((1.5, 1.8, 0.4), (3, 9, 9))]
    samples = [truth("burger", 1, 1, 0), truth("burger", 2, 2, 0), truth("burger", 3, 9, 9), *poses]
    largest = found("burger", "pose_error", samples)
    assert (largest.value, largest.t, largest.place) == (pytest.approx(0.5), 1.5, pytest.approx((1.5, 0.0)))
    assert value("burger", "pose_error_rms", samples) == pytest.approx(0.5 / 2**0.5)
    assert value("burger", "pose_error", []) == float("inf")


def going(t, state, x=3.0, job="goal", reason=""):
    return sample("burger", topics.NAV_STATUS, NavStatus(state=state, job=job, goal=Vector3(x=x), reason=reason), t)


def test_the_time_to_a_goal_is_that_of_the_slowest_one():
    drives = [going(1, NavStatus.DRIVING), going(2, NavStatus.DRIVING), going(6, NavStatus.REACHED)]
    drives += [going(10, NavStatus.DRIVING, 5.0), going(21, NavStatus.REACHED, 5.0)]
    assert found("burger", "goal_time", drives) == Finding(11.0, 21.0, (5.0, 0.0), "reached")
    assert value("burger", "goal_time", []) == float("inf")


@pytest.mark.parametrize(
    ("last", "note"),
    [
        (going(7, NavStatus.BLOCKED, reason="walls"), "goal (3.0, 0.0): walls"),
        (going(7, NavStatus.DRIVING, job="explore"), "goal (3.0, 0.0) was given up"),
        (going(7, NavStatus.RECOVERING), "was not reached before the run ended"),
    ],
)
def test_a_goal_that_is_not_reached_has_no_time_and_says_why(last, note):
    told = found("burger", "goal_time", [going(1, NavStatus.DRIVING), last])
    assert (told.value, told.note) == (float("inf"), note)


def test_a_rover_that_tips_over_and_an_aircraft_that_its_simulator_says_so_of_have_crashed():
    lies = NavState(position=Vector3(x=1.0), orientation=Quaternion(w=cos(0.6), x=sin(0.6)))
    upright = truth("burger", 1, 0, 0)
    assert value("burger", "crashed", [upright]) == 0
    assert found("burger", "crashed", [upright, sample("burger", topics.TRUTH, lies, 2)]) == Finding(
        1.0, 2.0, (1.0, 0.0), "tilted by 69 deg"
    )
    event = sample("milvus", topics.EVENTS.by("sim_air"), Event(text="crashed", cause="nose touched the ground"), 3)
    assert found("milvus", "crashed", [truth("milvus", 3, 5, 6), event]) == Finding(1.0, 3.0, (5.0, 6.0), "nose touched the ground")


@pytest.mark.parametrize("measure", ["touchdown_sink", "touchdown_error", "speed_at_end"])
def test_a_wreck_has_not_landed_however_gently_it_lies(measure):
    landed = [truth("milvus", k / 10, 25.0 * k / 10, max(10.0 - 2.5 * k / 10, 0.0) if k < 60 else 0.0) for k in range(200)]
    crash = sample("milvus", topics.EVENTS.by("sim_air"), Event(text="crashed", cause="the nose touched the ground"), 4)
    told = found("milvus", measure, [*landed, crash])
    assert (told.value, told.t, told.note) == (float("inf"), 4.0, "it crashed: the nose touched the ground")


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
    criterion = Criterion("contacts", "burger", at_least=1, at_most=2)
    assert [Verdict(criterion, Finding(v)).passed for v in (0.9, 1, 2, 2.1)] == [False, True, True, False]
    assert Verdict(criterion, Finding(1)).limits == ">= 1 and <= 2"
