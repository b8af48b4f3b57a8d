"""Flights with the simulator: thrown by a catapult and by hand; return, approaches given up by request and by itself, and landings."""

import dataclasses
import shutil

import msgspec
import numpy as np
import pytest

from launch.scoring import touchdown
from schemas import topics
from schemas.messages import ArmRequest, GoAroundRequest, Mode, ModeRequest
from tests.services.autopilot.air.test_flight import Flight, site
from uvf.maths.rotations import to_euler
from uvf.models.mission.file import JobFile, StartPose, Waypoint
from uvf.models.scenario import ROOT, MissionVehicle
from uvf.models.vehicle.file import load_vehicle
from uvf.models.world.file import Strip
from uvf.runtime.messages.convert import wxyz

POUND = 4.4482216  # N
ARMED, SHOT = 4.0, 6.0  # s
REACTION = """<external_reactions><force name="push" frame="BODY"><location unit="M"><x>{}</x><y>0</y><z>0</z></location>
<direction><x>{}</x><y>{}</y><z>{}</z></direction></force></external_reactions></fdm_config>"""
CENTRES = {"milvus": 0.0, "stick25": 0.222}  # m, of mass, aft in the models' frames
CATAPULT, ARM, GUST = (0.97, 0.0, -0.24), (0.85, 0.0, -0.53), (0.0, 1.0, 0.0)
STRIP = Strip("strip", (0.0, 0.0, 0.0), 0.0, 300.0, 12.0)
GIVEN_UP, GUSTY = 12.0, 11.0  # m

pytestmark = pytest.mark.timeout(400)


def on_site(start, job, folder=None, **params):
    made = site(job, wind=(-4.0, 2.0, 0.0))
    folder = folder or made.members["milvus"].folder
    entry = msgspec.structs.replace(made.members["milvus"].entry, model=folder.name, start=start)
    file = load_vehicle(folder.parent, folder.name)
    file = msgspec.structs.replace(file, params={"autopilot_air": {**file.params["autopilot_air"], **params}})
    member = MissionVehicle("milvus", entry, file, folder)
    mission = msgspec.structs.replace(made.mission, vehicles={"milvus": entry})
    world = msgspec.structs.replace(made.world, strips=[STRIP])
    return dataclasses.replace(made, mission=mission, world=world, members={"milvus": member})


def pushed(tmp, model, along):
    """A copy of a vehicle's folder that can be pushed at its centre of mass in this direction of its body."""
    folder = tmp / model
    shutil.copytree(ROOT / "vehicles" / model, folder)
    xml = folder / model / f"{model}.xml"
    xml.write_text(xml.read_text().replace("</fdm_config>", REACTION.format(CENTRES[model], *along)))
    return folder


def specific_force_x(flight, newtons):
    craft(flight).body._fdm["external_reactions/push/magnitude"] = newtons / POUND


def craft(flight):
    (stage,) = (s.service._stage for s in flight.lockstep.shells if s.service.name == "sim_air")
    return stage.aircraft["milvus"]


@dataclasses.dataclass(frozen=True)
class Throw:
    """Of an aircraft that stands at ``start`` [m east of the strip's middle] against the wind."""

    model: str
    along: tuple[float, float, float]  # of the push, body
    newtons: float
    gone: float  # s, when it is let go
    start: float = -140.0


THROWS = {"catapult": Throw("milvus", CATAPULT, 275.0, 6.9), "arm": Throw("stick25", ARM, 75.0, 6.3)}


@pytest.fixture(scope="module", params=list(THROWS))
def thrown(request, tmp_path_factory):
    throw = THROWS[request.param]
    folder = pushed(tmp_path_factory.mktemp("thrown"), throw.model, throw.along)
    job = JobFile(mission=[Waypoint(kind="takeoff", z=30.0), Waypoint(x=600.0, z=40.0)])
    flight = Flight(on_site(StartPose(throw.start, 0.0), job, folder, launch_push=15.0))
    flight.gone = throw.gone

    def watch(t):
        if t == pytest.approx(ARMED):
            flight.ask(topics.ARM, ArmRequest(arm=True, source="test"), t)
        specific_force_x(flight, throw.newtons if SHOT < t < throw.gone else 0.0)
        return True

    flight.lockstep.run(24.0, watch)
    return flight


def test_armed_it_waits_for_the_throw_with_its_motor_off(thrown):
    assert thrown.replies[0].accepted
    assert max(m.throttle for t, m in thrown.surfaces if ARMED < t < SHOT) == 0.0


def test_thrown_it_starts_its_motor_and_climbs_away_without_touching_again(thrown):
    assert craft(thrown).wreck is None
    assert min(m.throttle for t, m in thrown.surfaces if SHOT + 0.3 < t < thrown.gone + 1.0) == 1.0
    heights = thrown.positions(after=thrown.gone)[:, 2]
    assert heights.min() > 0.5 and heights[-1] > 28.0
    rolls = [to_euler(wxyz(m.orientation))[0] for t, m in thrown.truth if SHOT < t < thrown.gone + 3.0]
    assert max(map(abs, rolls)) < 0.5
    assert thrown.progress[-1][1].current == 1


@pytest.fixture(scope="module")
def landed():
    """Returns from 500 m away; told to land it is told to go around at 12 m, and lands."""
    flight = Flight(on_site(StartPose(200.0, 150.0, 60.0, 3.1, 25.0), JobFile(mission=[Waypoint(kind="return")])))
    flight.given_up = None

    def watch(t):
        if t == pytest.approx(12.0):
            flight.ask(topics.SET_MODE, ModeRequest(mode=Mode.MODE_LAND, source="test"), t)
        if t > 20.0 and flight.given_up is None and flight.truth[-1][1].position.z < GIVEN_UP:
            flight.given_up = t
            flight.ask(topics.GO_AROUND, GoAroundRequest(source="test"), t)
        return flight.given_up is None or t < flight.given_up + 5.0 or flight.status[-1][1].armed

    flight.lockstep.run(300.0, watch)
    return flight


def test_return_circles_until_it_is_told_to_land(landed):
    modes = [m.mode for t, m in landed.status if t < 11.9]
    assert modes[-1] == Mode.MODE_RETURN
    assert [r.accepted for r in landed.replies] == [True, True]


def test_an_approach_that_is_given_up_by_request_does_not_come_near_the_ground(landed):
    after = landed.positions(landed.given_up, landed.given_up + 25.0)[:, 2]
    assert after.min() > 0.6 * GIVEN_UP
    assert after.max() > 30.0
    assert any("go-around: asked by test" in m.reason for _, m in landed.status)


def test_it_lands_on_the_strip_afterwards_and_is_disarmed(landed):
    assert craft(landed).wreck is None
    assert not landed.status[-1][1].armed
    track = np.array([(t, m.position.x, m.position.y, m.position.z) for t, m in landed.truth])
    assert touchdown.sink(track) < 1.0
    assert touchdown.error(track, [STRIP]) < 12.0
    assert abs(track[-1, 2]) < STRIP.width / 2


@pytest.fixture(scope="module")
def swept_aside(tmp_path_factory):
    """On its approach a gust from the left, felt below 11 m, carries it beside the strip."""
    folder = pushed(tmp_path_factory.mktemp("gust"), "milvus", GUST)
    flight = Flight(on_site(StartPose(200.0, 150.0, 60.0, 3.1, 25.0), JobFile(mission=[Waypoint(kind="land")]), folder))
    flight.gusts = []

    def watch(t):
        low = t > 5.0 and flight.truth[-1][1].position.z < GUSTY
        if low and (not flight.gusts or t < flight.gusts[0] + 3.0):
            flight.gusts.append(t)
        specific_force_x(flight, 80.0 if flight.gusts and flight.gusts[-1] == t else 0.0)
        return t < 20.0 or flight.status[-1][1].armed

    flight.lockstep.run(300.0, watch)
    return flight


def test_blown_beside_the_strip_it_goes_around_by_itself_and_lands_at_the_next_approach(swept_aside):
    (why,) = {m.reason for _, m in swept_aside.status if "go-around" in m.reason}
    assert "m aside" in why
    around = next(t for t, m in swept_aside.status if "go-around" in m.reason)
    assert swept_aside.positions(around, around + 25.0)[:, 2].min() > 1.0
    assert craft(swept_aside).wreck is None
    assert not swept_aside.status[-1][1].armed
    assert abs(swept_aside.truth[-1][1].position.y) < STRIP.width / 2
