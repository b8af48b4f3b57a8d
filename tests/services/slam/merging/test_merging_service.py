"""The merging that runs beside the vehicles: sessions in, one map and the places of each in it out."""

import numpy as np
import pytest

from schemas.messages import Event, MapSession
from services.slam.merging.build import build
from services.slam.merging.merging_service import MergingService
from tests.runtime.stepping import stepped
from tests.slam.merging.offices import anne, bert, first, off_by
from uvf.maths.se2 import Pose2
from uvf.models.scenario import ROOT, load_scenario
from uvf.runtime.messages.convert import occupancy_cells, stamp, yaw_of
from uvf.slam.maps import tiles


def told(t, session):
    return MapSession(timestamp=stamp(t), data=session.encoded("on the bus"))


def run(service, sessions, steps, start=0.0):
    """Outputs of so many steps, those of the same name put together."""
    every = [stepped(service, start + 2.0 * k, session=sessions) for k in range(steps)]
    return {name: [outputs[name] for outputs in every] for name in service.outputs}


@pytest.fixture(scope="module")
def joined():
    service = MergingService()
    sessions = {"anne": told(1.0, anne().session), "bert": told(1.0, bert().session)}
    return service, sessions, run(service, sessions, 8)


def test_two_vehicles_that_have_met_have_one_map(joined):
    _, _, outputs = joined
    maps = [maps["anne"] for maps in outputs["map"] if maps]
    assert len(maps) == 1 and maps[0].frame_id == "anne/map"
    cells = occupancy_cells(maps[0])
    assert np.count_nonzero((cells >= 0) & (cells < 25)) * maps[0].cell_size.x ** 2 > 80.0
    places = next(places for places in outputs["place"] if places)
    bert_place = places["bert"]
    assert (bert_place.parent_frame_id, bert_place.child_frame_id) == ("anne/map", "bert/map")
    found = Pose2(bert_place.translation.x, bert_place.translation.y, yaw_of(bert_place.rotation))
    metres, radians = off_by(found, anne().map_from(bert()))
    assert metres < 0.1 and radians < 0.01
    assert places["anne"].translation.x == pytest.approx(0.0, abs=0.02)


def test_it_is_told_once(joined):
    service, sessions, outputs = joined
    events = [event for by_name in outputs["events"] for of_one in by_name.values() for event in of_one]
    assert [event.text for event in events] == ["the maps of anne and bert are one"]
    later = run(service, sessions, 3, 40.0)
    assert not any(later["map"]) and not any(later["place"]) and not any(later["events"])


def test_sessions_that_grow_on_are_followed():
    service, n = MergingService(), 90
    early = {"anne": told(1.0, first(anne().session, n)), "bert": told(1.0, bert().session)}
    assert any(run(service, early, 8)["map"])
    later = run(service, early | {"anne": told(30.0, anne().session)}, 2, 30.0)
    assert later["map"][0] and not later["map"][1] and not any(later["events"])


def test_a_team_that_is_no_more_has_no_map_and_is_told_of_again_when_it_is_back():
    service = MergingService()
    sessions = {"anne": told(1.0, anne().session), "bert": told(1.0, bert().session)}
    run(service, sessions, 8)
    anew = run(service, sessions | {"anne": told(20.0, first(bert(2).session, 20))}, 2, 20.0)
    assert (occupancy_cells(anew["map"][0]["anne"]) == -1).all()
    for name, place in anew["place"][0].items():
        assert place.parent_frame_id == place.child_frame_id == f"{name}/map"
        assert (place.translation.x, place.translation.y) == pytest.approx((0.0, 0.0), abs=1e-9)
    assert set(anew["place"][0]) == {"anne", "bert"} and not any(anew["map"][1:]) and not any(anew["place"][1:])
    back = run(service, sessions | {"anne": told(30.0, anne().session)}, 8, 30.0)
    assert [e.text for by_name in back["events"] for of_one in by_name.values() for e in of_one] == ["the maps of bert and anne are one"]


def test_a_team_too_large_to_be_drawn_is_told_of(monkeypatch):
    monkeypatch.setattr(tiles, "MOST_CELLS", 1000)
    service = MergingService()
    outputs = run(service, {"anne": told(1.0, anne().session), "bert": told(1.0, bert().session)}, 8)
    events = [event for by_name in outputs["events"] for event in by_name.get("anne", [])]
    assert [e.severity for e in events] == [Event.INFO, Event.WARNING] and "more than 1000 cells" in events[1].cause
    assert not any(outputs["map"]) and any(outputs["place"])


def test_vehicles_in_different_buildings_are_left_alone():
    sessions = {"anne": told(1.0, anne().session), "bert": told(1.0, bert(2).session)}
    outputs = run(MergingService(), sessions, 8)
    assert not any(outputs["map"]) and not any(outputs["place"]) and not any(outputs["events"])


def test_a_session_that_is_none_is_told_of_and_the_others_go_on():
    service = MergingService()
    broken = MapSession(timestamp=stamp(1.0), data=b"nothing")
    sessions = {"anne": told(1.0, anne().session), "carl": broken, "bert": told(1.0, bert().session)}
    outputs = run(service, sessions, 8)
    events = [event for by_name in outputs["events"] for event in by_name.get("carl", [])]
    assert [event.severity for event in events] == [Event.WARNING]
    assert any(outputs["map"])


def test_it_is_made_where_two_vehicles_draw_maps():
    assert [host.writes_for for host in build(load_scenario(ROOT / "missions" / "team.yaml"))] == [("anne", "bert")]
    assert build(load_scenario(ROOT / "missions" / "demo.yaml")) == []
