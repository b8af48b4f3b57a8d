"""The map is saved under a plain name, and a localized vehicle is told where it is."""

import json

import msgspec
import numpy as np
import pytest

from schemas import topics
from schemas.messages import MappingRequest, PlaceRequest, RelocalizeRequest, Reply, SaveMapRequest
from services.gcs.actions.page import Point
from services.gcs.page.words import action_in
from tests.services.gcs.fakes import ME, Station, click
from tests.services.gcs.scripted import UGV, demo_site
from uvf.maths.rotations import to_euler
from uvf.models.mission.file import Maps
from uvf.runtime.messages.convert import wxyz


def localized_site():
    site = demo_site()
    entry = msgspec.structs.replace(site.members[UGV].entry, maps=Maps(known="house", localize="start"))
    object.__setattr__(site.members[UGV], "entry", entry)
    return site


def begun(site=None):
    station = Station(site=site)
    station.heard = []
    for request in (topics.SAVE_MAP, topics.PLACE, topics.RELOCALIZE):
        station.script.bus.serve(request.at(UGV), lambda query, r=request: answer(station, r, query))
    station.run(1.0)
    return station


def answer(station, request, query):
    station.heard.append(request.message.FromString(query.payload))
    query.answer(Reply(accepted=True).SerializeToString(), query.stamp_ns)


def save(station, name):
    station.press(action_in(json.dumps([1, "save-map", UGV, {"name": name}]), ME), seconds=0.4)


def test_the_map_is_saved_under_the_name_that_was_written():
    station = begun()
    assert "Save map" in station.page.now.html["mapping"] and "% of the floor" in station.page.now.html["mapping"]
    save(station, " house-1 ")
    ((request,)) = station.heard
    assert isinstance(request, SaveMapRequest) and request.name == "house-1"
    assert "save the map as house-1 – accepted" in station.page.now.html["commands"]


@pytest.mark.parametrize("name", ["../../etc/cron.d/x", "/tmp/x", "a/b", "a.yaml", "", "-x", "x" * 60])
def test_a_name_that_is_a_path_is_refused_with_the_reason(name):
    station = begun()
    save(station, name)
    assert station.heard == []
    assert "is no name of a map" in station.model.vehicles[UGV].order.reason


@pytest.mark.parametrize("form", ['"x"', '{"name": 1}', '{"other": "x"}', '{"name": "%s"}' % ("y" * 100)])
def test_a_form_of_another_shape_is_no_word(form):
    assert action_in(f'[1, "save-map", "burger", {form}]', ME) is None


def test_a_localized_vehicle_is_told_where_it_stands_and_looks():
    station = begun(localized_site())
    station.press(click(4.0, 3.0), seconds=0.3)
    station.push("It stands here and looks …", seconds=0.3)
    station.press(click(4.0, 1.0), seconds=0.3)
    ((request,)) = station.heard
    assert isinstance(request, PlaceRequest)
    assert (request.pose.position.x, request.pose.position.y) == (pytest.approx(4.0), pytest.approx(3.0))
    assert to_euler(wxyz(request.pose.orientation))[2] == pytest.approx(-np.pi / 2)
    station.push("Look for it in the whole map")
    assert isinstance(station.heard[-1], RelocalizeRequest)


def test_one_that_draws_its_map_is_not_asked_where_it_stands():
    station = begun()
    station.press(click(4.0, 3.0), seconds=0.3)
    assert "It stands here and looks …" not in station.page.now.words
    station.press(Point(ME, ""))


def mapping_station():
    station = Station()
    station.heard = []
    station.script.bus.serve(topics.MAPPING.at(UGV), lambda query: answer(station, topics.MAPPING, query))
    station.run(1.0)
    return station


def test_the_map_is_held_and_gone_on_with():
    station = mapping_station()
    station.push("❚❚ Hold the map", seconds=0.5)
    station.push("▶ Go on mapping", seconds=0.5)
    assert [request.action for request in station.heard] == [MappingRequest.HOLD, MappingRequest.GO_ON]
    assert "❚❚ Hold the map" in station.page.now.words


def test_another_map_takes_two_clicks_and_shows_its_method():
    station = mapping_station()
    station.push("hector", seconds=0.3)
    assert not station.heard
    station.push("Confirm: hector", seconds=0.6)
    ((request,)) = station.heard
    assert (request.action, request.method) == (MappingRequest.BEGIN, "hector")
    assert station.model.vehicles[UGV].mapping.method == "hector"


def test_who_is_localized_on_a_map_draws_none():
    station = begun(localized_site())
    assert "hector" not in station.page.now.words
