"""What vehicles tell of markers, and where they have been, against those of the mission."""

import numpy as np
import pytest

from launch.scoring.scores import Scorer
from schemas import topics
from schemas.messages import Detection, Detections, NavState
from uvf.models.scenario import ROOT, load_scenario
from uvf.runtime.bus.interface import Sample
from uvf.runtime.messages.convert import quaternion, stamp, vector

SEARCH = load_scenario(ROOT / "missions" / "search.yaml")
STAND = [(m.x, m.y) for m in SEARCH.mission.markers]


def heard(scorer, topic, owner, message, t):
    scorer.heard(Sample(topic.at(owner), message.DESCRIPTOR.full_name, message.SerializeToString(), round(t * 1e9), 1, 0))


def told(*places):
    return Detections(detections=[Detection(id=k, position=vector(np.array((*place, 0.5)))) for k, place in enumerate(places)])


@pytest.mark.parametrize(
    ("places", "found", "error"),
    [
        ([], 0, np.inf),
        (STAND, len(STAND), 0.0),
        ([(STAND[0][0] + 0.4, STAND[0][1])], 1, 0.4),
        ([STAND[0], (STAND[1][0] + 5.0, STAND[1][1])], 1, 5.0),
        ([STAND[0], STAND[0]], 1, 0.0),
    ],
)
def test_markers_that_are_told_of(places, found, error):
    scorer = Scorer(SEARCH)
    if places:
        heard(scorer, topics.DETECTIONS, "eye", told(*places), 1.0)
    assert scorer.measure("eye", "markers_found").value == found
    assert scorer.measure("eye", "marker_error").value == pytest.approx(error)


def test_markers_are_reached_by_whoever_drives_there_not_by_who_flies_over():
    scorer = Scorer(SEARCH)
    for t, owner, (x, y) in [(1.0, "eye", STAND[0]), (2.0, "anne", STAND[1]), (3.0, "bert", (STAND[2][0] + 1.5, STAND[2][1]))]:
        state = NavState(timestamp=stamp(t), position=vector(np.array((x, y, 0.0))), orientation=quaternion(np.array((1.0, 0.0, 0.0, 0.0))))
        heard(scorer, topics.TRUTH, owner, state, t)
    found = scorer.measure("anne", "markers_reached")
    assert (found.value, found.t) == (2.0, 3.0)
