"""Fence, rally points and surveys are drawn on the page, compared with what is in force, put into force and kept as files."""

import time
from concurrent.futures import Future
from urllib.parse import unquote

import msgspec
import pytest
import yaml

from schemas.messages import FenceRequest, MissionItem, RallyRequest
from services.gcs.actions.areas import (
    AreaAdd,
    AreaClear,
    AreaDrop,
    AreaMove,
    AreaSet,
    AreaTake,
    AreaUpload,
    FenceActs,
    PlanPart,
    SurveyMake,
    ZoneBegin,
    ZoneChoose,
    ZoneEnd,
)
from services.gcs.actions.page import ClickGround, OpenTab, Select
from services.gcs.actions.plans import PlanLoad
from services.gcs.orders import area_orders
from services.gcs.orders.planning import LOAD_EVERY
from services.gcs.state.plans.area_draft import FenceDraft, RallyDraft
from services.gcs.state.plans.plan_file import plan_text, read_plan
from services.gcs.surveying import FieldSurvey, SurveyProcess
from tests.services.gcs.fakes import ME, OTHER, Station
from tests.services.gcs.scripted import UAV, UGV
from uvf.models.mission.file import Waypoint
from uvf.models.scenario import ROOT

SQUARE = ((0.0, 0.0), (300.0, 0.0), (300.0, 200.0), (0.0, 200.0))


@pytest.fixture
def station():
    """The aircraft's fence is open."""
    station = Station()
    station.run(0.5)
    station.press(Select(ME, UAV), OpenTab(ME, "plan"), PlanPart(ME, "Fence"), seconds=0.3)
    return station


def areas(station, name=UAV):
    return station.model.vehicles[name].areas


def panel(station):
    return station.page.now.html["plan"]


def asked(station, kind):
    return [message for _, message in station.script.asked if isinstance(message, kind)]


def draw(station, part, corners=SQUARE, vehicle=UAV):
    station.press(*(AreaAdd(ME, vehicle, part, x, y) for x, y in corners), seconds=0.3)


def test_a_fence_is_drawn_sent_and_in_force(station):
    assert "✓ fence as on milvus" in panel(station)
    station.press(ZoneBegin(ME, UAV, "keep in"))
    draw(station, "fence")
    station.press(AreaSet(ME, UAV, "fence", "ceiling", 120.0), FenceActs(ME, UAV, "hold"), seconds=0.3)
    assert "fence not as on milvus" in panel(station) and "keep in zone 1" in panel(station)
    station.push("Upload the fence", seconds=0.5)
    (request,) = asked(station, FenceRequest)
    assert [(p.x, p.y) for p in request.fence.zones[0].vertices] == list(SQUARE)
    assert request.fence.ceiling == 120.0 and not request.fence.HasField("floor") and request.fence.action == request.fence.HOLD
    station.run(0.5)
    assert "✓ fence as on milvus" in panel(station)


def test_circles_and_zones_to_keep_out_of(station):
    station.press(ZoneBegin(ME, UAV, "circle out"), AreaAdd(ME, UAV, "fence", 10.0, 20.0), AreaSet(ME, UAV, "fence", "radius", 35.0))
    station.press(ZoneBegin(ME, UAV, "keep out"))
    draw(station, "fence", SQUARE[:3])
    circle, zone = areas(station).fence.message().zones
    assert (circle.centre.x, circle.centre.y, circle.radius, circle.excludes) == (10.0, 20.0, 35.0, True)
    assert zone.excludes and len(zone.vertices) == 3


def test_corners_are_moved_and_taken_out_and_zones_too(station):
    station.press(ZoneBegin(ME, UAV, "keep in"))
    draw(station, "fence")
    station.press(
        ZoneBegin(ME, UAV, "keep out"),
        ZoneChoose(ME, UAV, 0),
        AreaMove(ME, UAV, "fence", 0, 2, 310.0, 210.0),
        AreaDrop(ME, UAV, "fence", 0, 0),
    )
    assert areas(station).fence.rings[0].corners == [(300.0, 0.0), (310.0, 210.0), (0.0, 200.0)]
    station.press(ZoneEnd(ME, UAV, 0), ZoneEnd(ME, UAV, 7))
    assert [ring.excludes for ring in areas(station).fence.rings] == [True]


def test_a_fence_that_makes_no_sense_is_refused_with_the_reason_before_it_is_sent(station):
    station.press(ZoneBegin(ME, UAV, "keep in"))
    draw(station, "fence", SQUARE[:2])
    station.push("Upload the fence", seconds=0.4)
    assert not asked(station, FenceRequest)
    assert "refused" in station.page.now.html["commands"] and areas(station).fence.touched


def test_what_the_vehicle_refuses_is_not_on_it():
    station = Station(accept=False)
    station.run(0.5)
    station.press(Select(ME, UAV), OpenTab(ME, "plan"), PlanPart(ME, "Rally"), AreaAdd(ME, UAV, "rally", 5.0, 5.0), seconds=0.3)
    station.push("Upload the rally points", seconds=0.6)
    assert asked(station, RallyRequest) and areas(station).rally.touched
    assert "rally points not as on milvus" in panel(station)


def test_rally_points_are_all_at_one_height(station):
    station.press(PlanPart(ME, "Rally"), AreaSet(ME, UAV, "rally", "height", 80.0))
    draw(station, "rally", SQUARE[:2])
    station.push("Upload the rally points", seconds=0.5)
    (request,) = asked(station, RallyRequest)
    assert [(p.x, p.y, p.z) for p in request.rally.points] == [(0.0, 0.0, 80.0), (300.0, 0.0, 80.0)]
    station.press(AreaClear(ME, UAV, "rally"), AreaTake(ME, UAV, "rally"), seconds=0.5)
    assert areas(station).rally.rings[0].corners == list(SQUARE[:2])


def test_a_click_on_the_map_offers_a_corner_and_nothing_else_while_an_area_is_drawn(station):
    station.press(ZoneBegin(ME, UAV, "keep in"), ClickGround(ME, (12.0, 3.0, 50.0), (0.0, 0.0, -1.0)), seconds=0.3)
    menu = station.page.now.html["menu"]
    assert "Add corner" in menu and "Circle here" not in menu
    station.push("Add corner")
    assert areas(station).fence.rings[0].corners == [(12.0, 3.0)]


def test_what_is_drawn_is_seen_by_who_draws_it_only(station):
    station.join_other()
    station.press(ZoneBegin(ME, UAV, "keep in"))
    draw(station, "fence")
    line = station.page.now.own["/own/area/0"]
    assert [tuple(p[:2]) for p in line.points] == [*SQUARE, SQUARE[0]]
    assert station.page.now.html["handles"].count("g-handle") == 4
    assert not [name for name in station.page.seen_by(OTHER).own if "area" in name]


def test_who_does_not_control_the_vehicle_draws_nothing_for_it(station):
    station.press(AreaUpload(ME, UAV, "fence"), seconds=0.3)
    station.join_other()
    station.press(Select(OTHER, UAV), ZoneBegin(OTHER, UAV, "keep in"), AreaUpload(OTHER, UAV, "rally"), seconds=0.3)
    assert not areas(station).fence.rings and not asked(station, RallyRequest)


@pytest.mark.parametrize(("name", "value"), (("sidelap", 2.0), ("sidelap", None), ("height", None), ("ceiling", 5.0)))
def test_numbers_that_make_no_sense_change_nothing(station, name, value):
    before = vars(areas(station).survey).copy()
    station.press(AreaSet(ME, UAV, "survey", name, value))
    assert vars(areas(station).survey) == before


def test_a_field_becomes_a_mission(station):
    station.press(PlanPart(ME, "Survey"), SurveyMake(ME, UAV), seconds=0.3)
    assert "at least three corners" in panel(station) and not station.surveys.begun
    draw(station, "survey")
    station.push("Make a mission of it", seconds=0.3)
    ((name, survey),) = station.surveys.begun
    assert name == UAV and survey.corners == list(SQUARE) and "being planned" in panel(station)
    station.surveys.done = [(UAV, [Waypoint(x=1.0, y=2.0, z=60.0), Waypoint(x=9.0, y=2.0, z=60.0)], "")]
    station.run(0.5)
    assert [item.position.x for item in station.model.vehicles[UAV].draft.items] == [1.0, 9.0]
    assert station.model.sessions[ME].plan_part == "mission" and "changes not on milvus" in panel(station)


def test_a_field_that_no_mission_can_be_made_of_says_why(station, monkeypatch):
    station.press(PlanPart(ME, "Survey"), seconds=0.3)
    draw(station, "survey")
    station.surveys.done = [(UAV, [], "survey: nothing of it is worth a swath")]
    station.run(0.5)
    assert "nothing of it is worth a swath" in panel(station)
    monkeypatch.setattr(area_orders, "MOST_ITEMS", 1)
    station.surveys.done = [(UAV, [Waypoint(), Waypoint()], "")]
    station.run(0.5)
    assert "2 items, of 1 at most" in panel(station)


def survey(corners=SQUARE, vehicle="milvus_survey"):
    return FieldSurvey(str(ROOT / "vehicles" / vehicle), str(ROOT / "worlds/house"), list(corners), 80.0, 0.6, 0.75, (0.0, 3.0))


def made(planner):
    end = time.monotonic() + 120
    while time.monotonic() < end:
        if found := planner.made():
            return found[0]
        time.sleep(0.05)
    raise AssertionError("no survey within two minutes")


def test_swaths_are_planned_by_the_librarys_own_planner():
    planner = SurveyProcess()
    planner.begin(UAV, survey())
    name, items, fault = made(planner)
    assert (name, fault) == (UAV, "") and {item.kind for item in items} == {"waypoint", "trigger_distance"}
    assert {item.z for item in items if item.kind == "waypoint"} == {80.0}
    assert all(-150 <= item.x <= 450 and -150 <= item.y <= 350 for item in items if item.kind == "waypoint")
    planner.begin(UAV, survey(((0.0, 0.0), (1.0, 0.0), (0.5, 0.0))))
    assert "survey:" in made(planner)[2]
    planner.begin(UAV, survey(vehicle="nas10"))
    assert "no camera" in made(planner)[2]


def saved(station):
    text = panel(station).split("charset=utf-8,")[1].split("'")[0]
    return unquote(text)


def test_a_plan_that_was_kept_is_the_same_when_it_is_loaded(station):
    station.press(ZoneBegin(ME, UAV, "keep in"))
    draw(station, "fence")
    station.press(ZoneBegin(ME, UAV, "circle out"), AreaAdd(ME, UAV, "fence", 10.0, 20.0), AreaSet(ME, UAV, "fence", "floor", 10.0))
    draw(station, "rally", SQUARE[:1])
    station.press(PlanPart(ME, "Mission"), seconds=0.3)
    text = saved(station)
    before = (areas(station).fence.message(), areas(station).rally.message(True), list(station.model.vehicles[UAV].draft.items))
    assert set(yaml.safe_load(text)) == {"mission", "fence", "rally"}
    station.press(AreaClear(ME, UAV, "fence"), AreaClear(ME, UAV, "rally"), seconds=0.2)
    station.press(PlanLoad(ME, UAV, "a.yaml", text), seconds=0.3)
    after = (areas(station).fence.message(), areas(station).rally.message(True), list(station.model.vehicles[UAV].draft.items))
    assert after[:2] == before[:2]
    assert [(i.kind, i.position, i.repeat) for i in after[2]] == [(i.kind, i.position, i.repeat) for i in before[2]]


@pytest.mark.parametrize(
    ("text", "why"),
    (
        ("", "the file is empty"),
        ("mission: [", "not valid YAML"),
        ("misson: []", "did you mean 'mission'"),
        ("mission: [{kind: waypont, x: 1}]", "waypont"),
        ("fence: {zones: [{polygon: [[0, 0], [1, 1]]}]}", "fence"),
        ("rally: [[1, 2]]", "rally"),
        ("x" * 48_001, "longer than"),
        ("a: &a [*a]", "not valid YAML"),
    ),
)
def test_a_file_that_is_none_changes_nothing_and_says_why(station, text, why):
    station.press(PlanPart(ME, "Mission"), seconds=0.3)
    before = list(station.model.vehicles[UAV].draft.items)
    station.press(PlanLoad(ME, UAV, "../../etc/passwd", text), seconds=0.3)
    assert station.model.vehicles[UAV].draft.items == before
    assert why in panel(station).replace("&#x27;", "'").replace("&#39;", "'")


def test_a_rover_has_a_fence_and_no_survey():
    station = Station()
    station.run(0.5)
    station.press(Select(ME, UGV), OpenTab(ME, "plan"), PlanPart(ME, "Fence"), ZoneBegin(ME, UGV, "circle in"), seconds=0.3)
    assert areas(station, UGV).fence.rings[0].radius == 1.0
    assert "Survey" not in station.page.now.words and "ceiling" not in panel(station)


def test_items_of_a_survey_keep_their_trigger_in_a_file():
    text = plan_text([MissionItem(kind=MissionItem.TRIGGER_DISTANCE, distance=7.5)], FenceDraft(), RallyDraft())
    (item,) = read_plan(text, "a.yaml").items
    assert (item.kind, item.distance) == (MissionItem.TRIGGER_DISTANCE, 7.5)


def test_what_only_aircraft_have_is_not_drawn_for_a_rover(station):
    station.press(PlanPart(ME, "Survey"), Select(ME, UGV), seconds=0.3)
    assert station.model.sessions[ME].plan_part == "mission"
    draw(station, "survey", vehicle=UGV)
    station.press(SurveyMake(ME, UGV), FenceActs(ME, UGV, "land"), seconds=0.3)
    assert not station.surveys.begun and not areas(station, UGV).survey.rings[0].corners
    assert areas(station, UGV).fence.action == "return"


def test_a_field_is_planned_once_at_a_time(station):
    draw(station, "survey")
    station.press(*[SurveyMake(ME, UAV)] * 50)
    assert len(station.surveys.begun) == 1


def test_items_that_no_mission_can_hold_are_told():
    planner = SurveyProcess()
    planner._jobs[UAV] = Future()
    planner._jobs[UAV].set_exception(msgspec.ValidationError("Expected `float` <= 1000000.0 - at `$[3].x`"))
    ((name, items, why),) = planner.made()
    assert (name, items) == (UAV, []) and "nearer to the world's origin" in why
    planner.close()


def test_plan_files_are_read_one_after_the_other(station):
    station.press(PlanPart(ME, "Mission"), *[PlanLoad(ME, UAV, f"{n}.yaml", "mission: [{x: 1.0}]") for n in (1, 2)], seconds=0.3)
    assert len(station.model.vehicles[UAV].draft.items) == 1 and "another one has just been read" in panel(station)
    station.run(LOAD_EVERY)
    station.press(PlanLoad(ME, UAV, "3.yaml", "mission: [{x: 1.0}, {x: 2.0}]"), seconds=0.3)
    assert len(station.model.vehicles[UAV].draft.items) == 2 and "just been read" not in panel(station)
