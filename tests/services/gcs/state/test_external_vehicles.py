"""Vehicles that no mission names are shown like all others once they say what they look like."""

import pytest

from schemas.messages import (
    Event,
    ExternalVehicle,
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
from services.gcs.state.external_vehicles import FORGOTTEN_AFTER
from services.gcs.state.process_book import MOST_PROCESSES
from services.gcs.state.state import MOST_VEHICLES, Model
from services.gcs.view.scene.scene_view import SceneView
from tests.services.gcs.scripted import UAV, UGV, demo_site
from uvf.runtime.contract.inbox import OWNERS_MOST


@pytest.fixture
def model():
    return Model(demo_site())


@pytest.mark.parametrize(("body", "kind"), [("milvus", Kind.KIND_FIXED_WING), ("burger", Kind.KIND_GROUND)])
def test_a_guest_is_drawn_where_it_says_and_can_be_chosen(model, body, kind):
    view = SceneView(model)
    nav = NavState(position=Vector3(x=7.0, z=20.0), orientation=Quaternion(w=1))
    model.hear(0.0, "nav", {"plane2": nav})
    assert "plane2" not in model.vehicles, "nobody knows what it looks like"
    model.hear_external_vehicles(0.0, {"plane2": ExternalVehicle(model=body, about="MAVLink system 3")})
    model.hear_newest(0.1, {"nav": {"plane2": nav}, "status": {"plane2": VehicleStatus(kind=kind)}}, {})
    assert model.vehicles["plane2"].flies == (kind == Kind.KIND_FIXED_WING)
    assert any(name.startswith("/vehicles/plane2/") for name in view.nodes(0.2))
    assert view.places()["/vehicles/plane2"].position[0] == 7.0
    assert any("MAVLink system 3" in line.text for line in model.log)


def test_its_colour_is_its_own_and_a_mission_s_vehicle_is_no_guest(model):
    before = dict(model.vehicles)
    model.hear_external_vehicles(0.0, {"plane2": ExternalVehicle(model="milvus"), "milvus": ExternalVehicle(model="burger")})
    assert model.vehicles["milvus"] is before["milvus"]
    assert len({v.colour for v in model.vehicles.values()}) == 3


def test_one_of_a_model_that_this_host_has_not_is_told_of_once(model):
    for _ in range(3):
        model.hear_external_vehicles(0.0, {"plane2": ExternalVehicle(model="saucer")})
    assert "plane2" not in model.vehicles and len([line for line in model.log if "plane2" in line.text]) == 1
    model.hear_external_vehicles(0.0, {"plane2": ExternalVehicle(model="milvus")})
    assert "plane2" in model.vehicles


@pytest.mark.parametrize("body", ["../../etc", "/etc", "common/../milvus", "milvus/", "..", "", "Milvus", "<b>"])
def test_a_model_is_the_name_of_a_folder_in_vehicles_and_never_a_path(model, body):
    model.hear_external_vehicles(0.0, {"plane2": ExternalVehicle(model=body)})
    assert "plane2" not in model.vehicles
    model.hear_objects((SimObjects(objects=[SimObject(name="scout", model=body, shape="box", size=[1, 1, 1])]), None), {})
    drawn = SceneView(model).nodes(0.0)
    assert not body or not any(name.startswith("/spawned") for name in drawn)


EVIL = "<img src=x onerror=alert(1)>"


@pytest.mark.parametrize("name", [EVIL, "x/../y", "sys", "Plane", "a" * 41, "", "a'b"])
def test_who_has_no_name_is_refused_counted_and_told_of_once(model, name):
    for _ in range(3):
        model.hear_external_vehicles(0.0, {name: ExternalVehicle(model="milvus"), f"{name}.": ExternalVehicle(model="milvus")})
        model.hear_events(0.0, {f"{name}.": [Event(text="hello", severity=Event.WARNING)]})
        model.hear_objects((SimObjects(objects=[SimObject(name=name, shape="box", size=[1, 1, 1])]), None), {})
    assert set(model.vehicles) == {UGV, UAV} and not model.spawned
    (line,) = list(model.log)
    assert "is no name" in line.text and line.severity == Event.WARNING
    assert str(model.refused) == ("1 names" if name[:64] == f"{name}."[:64] else "2 names")


def test_a_flood_of_guests_fills_neither_the_page_nor_its_log(model):
    for i in range(3 * MOST_VEHICLES):
        model.hear_external_vehicles(0.0, {f"plane{i}": ExternalVehicle(model="burger" if i % 2 else f"saucer{i}")})
    assert len(model.vehicles) == MOST_VEHICLES and len(model._external._undrawable) <= OWNERS_MOST
    assert len([line for line in model.log if "more than 64 vehicles" in line.text]) == 1
    assert str(model.refused) == "68 vehicles"


MOVING, GHOSTS = Quaternion(w=1), [f"ghost{i}" for i in range(MOST_VEHICLES - 2)]


def fly(model, t, *names):
    model.hear(t, "nav", {name: NavState(orientation=MOVING) for name in names})


@pytest.fixture
def haunted(model):
    """As many external vehicles as can be shown, silent since t = 0, whose words of themselves stay on the bus for ever."""
    model.left = {name: ExternalVehicle(model="burger") for name in GHOSTS}
    model.hear_external_vehicles(0.0, model.left)
    fly(model, 0.0, *GHOSTS)
    return model


def come(model, t, *names):
    model.left |= {name: model.left.get(name) or ExternalVehicle(model="milvus") for name in names}
    model.hear_external_vehicles(t, model.left)


def test_a_guest_that_is_lost_for_long_makes_room_for_another(haunted):
    view = SceneView(haunted)
    view.nodes(0.0)
    come(haunted, FORGOTTEN_AFTER - 1.0, "plane9")
    assert "plane9" not in haunted.vehicles
    for t in (FORGOTTEN_AFTER + 1.0, FORGOTTEN_AFTER + 2.0):
        come(haunted, t, "plane9")
    assert "plane9" in haunted.vehicles and len(haunted.vehicles) == MOST_VEHICLES
    fly(haunted, FORGOTTEN_AFTER + 2.0, "plane9")
    shown = {name.split("/")[2] for name in view.nodes(70.0) if name.startswith("/vehicles/")}
    assert shown == haunted.vehicles.keys() - {UGV, UAV}


def test_nobody_is_forgotten_while_there_is_room(model):
    model.hear_external_vehicles(0.0, {"ghost": ExternalVehicle(model="burger")})
    model.hear_external_vehicles(1000.0, {"plane9": ExternalVehicle(model="milvus")})
    assert {"ghost", "plane9"} <= model.vehicles.keys()


def test_who_is_chosen_is_heard_or_belongs_to_the_mission_is_not_forgotten(haunted):
    haunted.join(1)
    haunted.sessions[1].vehicle = "ghost0"
    fly(haunted, 50.0, "ghost1")
    come(haunted, 100.0, *(f"plane{i}" for i in range(100)))
    assert haunted.vehicles.keys() & {UGV, UAV, *GHOSTS} == {UGV, UAV, "ghost0", "ghost1"}


@pytest.mark.parametrize("sign", ["it moves", "it says again what it is"])
def test_who_was_forgotten_and_comes_back_is_shown_again(haunted, sign):
    come(haunted, 100.0, "plane9")
    (gone,) = set(GHOSTS) - haunted.vehicles.keys()
    come(haunted, 101.0, "plane9")
    assert gone not in haunted.vehicles
    if sign == "it moves":
        fly(haunted, 102.0, gone)
    else:
        haunted.left[gone] = ExternalVehicle(model="milvus")
    come(haunted, 102.1, "plane9")
    assert gone in haunted.vehicles and "plane9" in haunted.vehicles


def test_names_turned_away_take_no_room_from_those_that_can_be_drawn(model):
    for i in range(MOST_VEHICLES):
        model.hear_external_vehicles(0.0, {f"ghost{i}": ExternalVehicle(model="saucer")})
    model.hear_external_vehicles(0.1, {"plane9": ExternalVehicle(model="milvus")})
    assert "plane9" in model.vehicles


def test_a_process_of_which_nobody_speaks_makes_room_for_another(model):
    book = model.processes
    book.hear(0.0, [Processes(processes=[Process(name=f"p{i}", state=Process.FAILED) for i in range(MOST_PROCESSES)])])
    book.hear_health(1.0, [Health(service="p0")])
    book.hear_health(FORGOTTEN_AFTER - 1.0, [Health(service="slam")])
    assert "slam" not in book.vitals
    book.hear_health(FORGOTTEN_AFTER + 0.5, [Health(service="slam")])
    assert "slam" in book.vitals and "p0" in book.vitals and len(book.told) == MOST_PROCESSES - 1


def test_a_flood_of_processes_and_objects_is_bounded_too(model):
    model.processes.hear(0.0, [Processes(processes=[Process(name=f"p{i}") for i in range(1000)])])
    model.processes.hear_health(0.0, [Health(service=f"p{i}") for i in range(1000)])
    model.hear_objects((SimObjects(objects=[SimObject(name=f"o{i}") for i in range(1000)]), None), {})
    assert max(len(model.processes.told), len(model.processes.vitals), len(model.spawned)) <= 256


def test_a_long_text_is_cut(model):
    model.hear_events(0.0, {UGV: [Event(text="x" * 10**6)]})
    assert len(next(iter(model.log)).text) == 500
