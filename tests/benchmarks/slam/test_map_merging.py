"""``uvf bench merge``: its cases come from the data; wherever a map is laid, the readings come out where they were taken."""

from types import SimpleNamespace

import numpy as np
import pytest

from benchmarks.slam import map_merging
from tests.slam.merging.offices import anne, bert
from tests.slam.room_log import write_room_log
from uvf.maths.se2 import IDENTITY
from uvf.maths.se2_arrays import composed
from uvf.models.yaml_data import BadInput
from uvf.slam.reading import Reading


@pytest.fixture(scope="module")
def data(tmp_path_factory):
    """Two folders with a log each, one of them without relations."""
    folder = tmp_path_factory.mktemp("data")
    for name in ("room", "bare"):
        (folder / "slam" / name).mkdir(parents=True)
        write_room_log(folder / "slam" / name).rename(folder / "slam" / name / f"{name}.clf")
    (folder / "slam" / "bare" / "room.relations").unlink()
    return folder


def test_logs_with_relations_are_cut_and_two_buildings_are_held_against_each_other(data):
    assert set(map_merging.cases(data)) == {"room:cut 50", "room:cut 25", "bare+room"}
    with pytest.raises(BadInput, match="--data"):
        map_merging.cases(None)


def test_a_single_room_is_too_little_to_be_sure(data):
    row = map_merging.cases(data)["room:cut 50"](data)["room:cut 50"]
    assert row["joined"] == 0.0 and row["CPU s"] >= 0.0 and "m" not in row


def test_readings_are_where_they_were_taken_however_the_second_map_is_laid():
    found = map_merging.merged({"first": anne().session, "second": map_merging.laid_anywhere(bert().session, 3)})
    assert found.figures["joined"] == 1.0
    keyframes = bert().session.keyframes
    final = np.array([k.map_from_base for k in keyframes])
    readings = [Reading(k.reading.t, k.reading.ranges, k.reading.beams, IDENTITY) for k in keyframes]
    run = SimpleNamespace(keyframes=keyframes, final=final, log=readings)
    laid = found.team.groups[0].joint.poses["second"]
    away = map_merging.team_from_readings(run, laid) - composed(np.array(anne().map_from(bert())), final)
    assert np.hypot(away[:, 0], away[:, 1]).max() < 0.15
