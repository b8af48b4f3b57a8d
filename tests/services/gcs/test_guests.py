"""Vehicles that no mission names are shown like all others once they say what they look like."""

import pytest

from schemas.messages import Guest, Kind, NavState, Quaternion, Vector3, VehicleStatus
from services.gcs.state import Model
from services.gcs.view import View
from tests.services.gcs.scripted import demo_site


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
