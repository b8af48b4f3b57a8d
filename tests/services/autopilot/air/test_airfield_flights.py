"""Flights with the simulator: thrown by a catapult; return, an approach given up by request, and a landing."""

import dataclasses
import shutil

import msgspec
import numpy as np
import pytest

from schemas import topics
from schemas.convert import wxyz
from schemas.messages import ArmRequest, GoAroundRequest, Mode, ModeRequest
from tests.services.autopilot.air.test_flight import Flight, site
from uvf.launch import touchdown
from uvf.maths.rotations import to_euler
from uvf.runtime.mission_file import Job, Start, Waypoint
from uvf.runtime.site import ROOT
from uvf.runtime.world_file import Strip

POUND = 4.4482216  # N
PUSH = 275.0  # N on 11 kg, forwards and a little up
ARMED, SHOT, GONE = 4.0, 6.0, 6.9  # s
CATAPULT = """<external_reactions><force name="catapult" frame="BODY"><location unit="M"><x>0</x><y>0</y><z>0</z></location>
<direction><x>0.97</x><y>0</y><z>-0.24</z></direction></force></external_reactions></fdm_config>"""
STRIP = Strip("strip", (0.0, 0.0, 0.0), 0.0, 300.0, 12.0)
GIVEN_UP = 12.0  # m

pytestmark = pytest.mark.timeout(400)


def on_site(start, job, folder=None, **params):
    made = site(job, wind=(-4.0, 2.0, 0.0))
    member = made.members["milvus"]
    entry = msgspec.structs.replace(member.entry, start=start)
    file = msgspec.structs.replace(member.file, params={"autopilot_air": {**member.file.params["autopilot_air"], **params}})
    member = dataclasses.replace(member, entry=entry, file=file, folder=folder or member.folder)
    mission = msgspec.structs.replace(made.mission, vehicles={"milvus": entry})
    world = msgspec.structs.replace(made.world, strips=[STRIP])
    return dataclasses.replace(made, mission=mission, world=world, members={"milvus": member})


def craft(flight):
    (stage,) = (s.service._stage for s in flight.lockstep.shells if s.service.name == "sim_air")
    return stage.aircraft["milvus"]


@pytest.fixture(scope="module")
def thrown(tmp_path_factory):
    folder = tmp_path_factory.mktemp("catapult") / "milvus"
    shutil.copytree(ROOT / "vehicles" / "milvus", folder)
    model = folder / "milvus" / "milvus.xml"
    model.write_text(model.read_text().replace("</fdm_config>", CATAPULT))
    job = Job(mission=[Waypoint(kind="takeoff", z=30.0), Waypoint(x=600.0, z=40.0)])
    flight = Flight(on_site(Start(-140.0, 0.0), job, folder, launch_push=15.0))

    def watch(t):
        if t == pytest.approx(ARMED):
            flight.ask(topics.ARM, ArmRequest(arm=True, source="test"), t)
        craft(flight).body._fdm["external_reactions/catapult/magnitude"] = PUSH / POUND if SHOT < t < GONE else 0.0
        return True

    flight.lockstep.run(20.0, watch)
    return flight


def test_armed_it_waits_for_the_catapult_with_its_motor_off(thrown):
    assert thrown.replies[0].accepted
    assert max(m.throttle for t, m in thrown.surfaces if ARMED < t < SHOT) == 0.0


def test_thrown_it_starts_its_motor_and_climbs_away_without_touching_again(thrown):
    assert craft(thrown).wreck is None
    assert min(m.throttle for t, m in thrown.surfaces if SHOT + 0.3 < t < GONE + 2.0) == 1.0
    heights = thrown.positions(after=GONE)[:, 2]
    assert heights.min() > 0.5 and heights[-1] > 30.0
    rolls = [to_euler(wxyz(m.orientation))[0] for t, m in thrown.truth if SHOT < t < GONE + 3.0]
    assert max(map(abs, rolls)) < 0.3
    assert thrown.progress[-1][1].current == 1


@pytest.fixture(scope="module")
def landed():
    """Returns from 500 m away; told to land it is told to go around at 12 m, and lands."""
    flight = Flight(on_site(Start(200.0, 150.0, 60.0, 3.1, 25.0), Job(mission=[Waypoint(kind="return")])))
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
