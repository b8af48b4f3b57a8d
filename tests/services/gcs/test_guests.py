"""Vehicles that no mission names are shown like all others once they say what they look like."""

import pytest

from schemas.messages import (
    Event,
    Guest,
    Health,
    Kind,
    NavState,
    Process,
    Processes,
    Quaternion,
    SimObject,
    SimObjects,
    Vector3,
    VehicleStatus,
)
from services.gcs.state import MOST_VEHICLES, Model
from services.gcs.view import View
from tests.services.gcs.scripted import UAV, UGV, demo_site


@pytest.fixture
def model():
    return Model(demo_site())


@pytest.mark.parametrize(("body", "kind"), [("milvus", Kind.KIND_FIXED_WING), ("burger", Kind.KIND_GROUND)])
def test_a_guest_is_drawn_where_it_says_and_can_be_chosen(model, body, kind):
    view = View(model)
    nav = NavState(position=Vector3(x=7.0, z=20.0), orientation=Quaternion(w=1))
    model.hear(0.0, "nav", {"plane2": nav})
    assert "plane2" not in model.vehicles, "nobody knows what it looks like"
    model.hear_guests({"plane2": Guest(model=body, about="MAVLink system 3")})
    model.hear_newest(0.1, {"nav": {"plane2": nav}, "status": {"plane2": VehicleStatus(kind=kind)}}, {})
    assert model.vehicles["plane2"].flies == (kind == Kind.KIND_FIXED_WING)
    assert any(name.startswith("/vehicles/plane2/") for name in view.nodes(0.2))
    assert view.places()["/vehicles/plane2"].position[0] == 7.0
    assert any("MAVLink system 3" in line.text for line in model.log)


def test_its_colour_is_its_own_and_a_mission_s_vehicle_is_no_guest(model):
    before = dict(model.vehicles)
    model.hear_guests({"plane2": Guest(model="milvus"), "milvus": Guest(model="burger")})
    assert model.vehicles["milvus"] is before["milvus"]
    assert len({v.colour for v in model.vehicles.values()}) == 3


def test_one_of_a_model_that_this_host_has_not_is_told_of_once(model):
    for _ in range(3):
        model.hear_guests({"plane2": Guest(model="saucer")})
    assert "plane2" not in model.vehicles and len([line for line in model.log if "plane2" in line.text]) == 1
    model.hear_guests({"plane2": Guest(model="milvus")})
    assert "plane2" in model.vehicles


@pytest.mark.parametrize("body", ["../../etc", "/etc", "common/../milvus", "milvus/", "..", "", "Milvus", "<b>"])
def test_a_model_is_the_name_of_a_folder_in_vehicles_and_never_a_path(model, body):
    model.hear_guests({"plane2": Guest(model=body)})
    assert "plane2" not in model.vehicles
    model.hear_objects((SimObjects(objects=[SimObject(name="scout", model=body, shape="box", size=[1, 1, 1])]), None), {})
    drawn = View(model).nodes(0.0)
    assert not body or not any(name.startswith("/spawned") for name in drawn)


EVIL = "<img src=x onerror=alert(1)>"


@pytest.mark.parametrize("name", [EVIL, "x/../y", "sys", "Plane", "a" * 41, "", "a'b"])
def test_who_has_no_name_is_refused_counted_and_told_of_once(model, name):
    for _ in range(3):
        model.hear_guests({name: Guest(model="milvus"), f"{name}.": Guest(model="milvus")})
        model.hear_events(0.0, {f"{name}.": [Event(text="hello", severity=Event.WARNING)]})
        model.hear_objects((SimObjects(objects=[SimObject(name=name, shape="box", size=[1, 1, 1])]), None), {})
    assert set(model.vehicles) == {UGV, UAV} and not model.spawned
    (line,) = list(model.log)
    assert "is no name" in line.text and line.severity == Event.WARNING
    assert str(model.refused) == ("1 names" if name[:64] == f"{name}."[:64] else "2 names")


def test_a_flood_of_guests_fills_neither_the_page_nor_its_log(model):
    for i in range(3 * MOST_VEHICLES):
        model.hear_guests({f"plane{i}": Guest(model="burger" if i % 2 else f"saucer{i}")})
    assert len(model.vehicles) <= MOST_VEHICLES and len(model._turned_away) <= MOST_VEHICLES
    assert len([line for line in model.log if "more than 64 vehicles" in line.text]) == 1
    assert str(model.refused) == "130 vehicles"


def test_a_flood_of_processes_and_objects_is_bounded_too(model):
    model.hear_processes([Processes(processes=[Process(name=f"p{i}") for i in range(1000)])])
    model.hear_health(0.0, [Health(service=f"p{i}") for i in range(1000)])
    model.hear_objects((SimObjects(objects=[SimObject(name=f"o{i}") for i in range(1000)]), None), {})
    assert max(len(model.processes), len(model.health), len(model.spawned)) <= 256


def test_a_long_text_is_cut(model):
    model.hear_events(0.0, {UGV: [Event(text="x" * 10**6)]})
    assert len(next(iter(model.log)).text) == 500
