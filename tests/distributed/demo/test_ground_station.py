"""MAVSDK 4.1 against the whole system: both vehicles, positions, a mission flown by the real autopilot."""

import math

import numpy as np
import pytest
from mavsdk import ComponentType, Configuration, Mavsdk
from mavsdk.plugins.action import Action, ActionError
from mavsdk.plugins.mission import Mission, MissionItem, MissionPlan
from mavsdk.plugins.telemetry import FlightMode, Telemetry

from schemas import topics
from tests.distributed.test_mavsdk import wait
from uvf.maths.geodesy import LocalTangent
from uvf.models.scenario import ROOT, load_scenario
from uvf.runtime.messages.convert import array

PLANE, ROVER = 1, 2
DEGREE = math.radians(1.0)
POINTS = [(150.0, -150.0, 70.0), (250.0, 0.0, 70.0), (100.0, 100.0, 80.0)]  # m: east, north, up


SLOWEST = 15.0  # m/s


def now(system):
    """Time of the simulation [s], which a busy machine slows down."""
    return system.client.read("sys", topics.CLOCK).t_ns / 1e9


@pytest.fixture(scope="module")
def sdk():
    with Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION)) as sdk:
        yield sdk


@pytest.fixture(scope="module")
def ports():
    """Those at which MAVSDK listens: a second try has a system of its own."""
    return set()


@pytest.fixture
def vehicles(system, sdk, ports):
    """What MAVSDK has found, by number."""
    if system.mavlink not in ports:
        sdk.add_any_connection(f"udpin://127.0.0.1:{system.mavlink}")
        ports.add(system.mavlink)
    wait(lambda: len(sdk.get_systems()) == 2, 30.0)
    return {each.get_system_id(): each for each in sdk.get_systems()}


@pytest.fixture(scope="module")
def tangent():
    origin = load_scenario(ROOT / "missions" / "demo.yaml").world.origin
    return LocalTangent.from_degrees(origin.latitude, origin.longitude, origin.altitude)


def test_positions_are_those_of_the_simulators(system, vehicles, tangent):
    for number, name in ((PLANE, "milvus"), (ROVER, "burger")):
        telemetry = Telemetry(vehicles[number])
        wait(lambda t=telemetry: math.isfinite(t.position().latitude_deg))
        seen = telemetry.position()
        reported = tangent.enu(seen.latitude_deg * DEGREE, seen.longitude_deg * DEGREE, seen.absolute_altitude_m)
        true = array(system.client.read(name, topics.TRUTH).position)
        assert abs(reported - true).max() < (30.0 if number == PLANE else 0.5)


def test_a_mission_goes_up_and_is_flown(system, vehicles, tangent):
    home = Telemetry(vehicles[PLANE])
    wait(lambda: math.isfinite(home.home().latitude_deg))
    items = []
    for point in POINTS:
        latitude, longitude, altitude = tangent.geodetic(point)
        above = altitude - home.home().absolute_altitude_m
        items.append(MissionItem(latitude / DEGREE, longitude / DEGREE, above, is_fly_through=True))
    mission, seen = Mission(vehicles[PLANE]), []
    mission.upload_mission(MissionPlan(items))
    mission.subscribe_mission_progress(lambda progress, _: seen.append((progress.current, progress.total)))
    here = array(system.client.read("milvus", topics.TRUTH).position)
    mission.start_mission()
    route = np.linalg.norm(np.diff([here, *POINTS], axis=0), axis=1).sum()
    limit = now(system) + 20.0 + route / SLOWEST
    wait(lambda: (2, 3) in seen or now(system) > limit, 240.0)
    assert (2, 3) in seen, (route, seen)
    assert system.client.read("milvus", topics.MISSION).items[0].position.x == pytest.approx(POINTS[0][0], abs=0.1)


def test_modes_and_arming_reach_the_autopilots(system, vehicles):
    action, telemetry = Action(vehicles[PLANE]), Telemetry(vehicles[PLANE])
    action.hold()
    wait(lambda: telemetry.flight_mode() == FlightMode.HOLD, 5.0)
    with pytest.raises(ActionError):
        action.disarm()
    rover, rover_telemetry = Action(vehicles[ROVER]), Telemetry(vehicles[ROVER])
    rover.disarm()
    wait(lambda: not rover_telemetry.armed(), 5.0)
    rover.arm()
    wait(rover_telemetry.armed, 5.0)
