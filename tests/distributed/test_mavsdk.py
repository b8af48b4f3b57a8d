"""MAVSDK 4.1, a real client, against the MAVLink service over UDP, in real time."""

import socket
import time
from contextlib import closing, contextmanager

import pytest
from mavsdk import Autopilot, ComponentType, Configuration, Mavsdk, Vehicle
from mavsdk.plugins.action import Action, ActionError
from mavsdk.plugins.mission import Mission, MissionError, MissionItem, MissionPlan
from mavsdk.plugins.mission_raw import MissionRaw
from mavsdk.plugins.param import Param
from mavsdk.plugins.telemetry import FlightMode, Telemetry

from schemas.messages import Mission as PlanMessage
from schemas.messages import MissionItem as ItemMessage
from schemas.messages import Vector3
from tests.distributed.mavlink_vehicles import LiveVehicles
from tests.second_try import Shared
from tests.services.autopilot.mavlink.rig import PLANE, PLANE_FACTS, ROVER

POINTS = [(40.7705, 14.7900, 60.0), (40.7705, 14.7906, 70.0), (40.7700, 14.7906, 80.0)]  # deg, deg, m above home
HOLD = FlightMode.HOLD
RETURN = FlightMode.RETURN_TO_LAUNCH


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sock:
        sock.bind(("127.0.0.1", 0))
        return sock.getsockname()[1]


def wait(condition, seconds=10.0):
    """Polls a condition; fails when it does not come true in time."""
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "did not come true in time"
        time.sleep(0.02)


@contextmanager
def station():
    """The vehicles, what MAVSDK found of them by number, and their telemetry."""
    port = free_port()
    with (
        LiveVehicles([("127.0.0.1", port)]) as vehicles,
        Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION)) as sdk,
    ):
        sdk.add_any_connection(f"udpin://127.0.0.1:{port}")
        wait(lambda: len(sdk.get_systems()) == 2, 30.0)
        systems = {system.get_system_id(): system for system in sdk.get_systems()}
        yield vehicles, systems, {number: Telemetry(system) for number, system in systems.items()}


@pytest.fixture(scope="module")
def stations():
    with closing(Shared(station)) as shared:
        yield shared


@pytest.fixture
def live(stations, request):
    return stations.for_test(request)


def test_both_vehicles_are_found_as_what_they_are(live):
    _, systems, _ = live
    wanted = {PLANE: (Autopilot.PX4, Vehicle.FIXED_WING), ROVER: (Autopilot.PX4, Vehicle.ROVER)}
    wait(lambda: {number: (s.autopilot_type(), s.vehicle_type()) for number, s in systems.items()} == wanted)


def test_positions_are_read_in_degrees_and_metres_above_sea(live):
    _, _, telemetry = live
    wait(lambda: all(t.position().absolute_altitude_m > 0 for t in telemetry.values()))
    rover, plane = telemetry[ROVER].position(), telemetry[PLANE].position()
    assert (rover.latitude_deg, rover.longitude_deg) == pytest.approx((40.77, 14.79), abs=1e-4)
    assert rover.absolute_altitude_m == pytest.approx(300.0, abs=0.01)
    assert plane.absolute_altitude_m == pytest.approx(350.0, abs=0.01)


@pytest.mark.parametrize("number", [PLANE, ROVER])
def test_each_vehicle_is_healthy_enough_for_every_script(live, number):
    _, _, telemetry = live
    wait(telemetry[number].health_all_ok)
    assert telemetry[number].health().is_armable


def test_the_mission_of_the_file_comes_down_with_heights_above_home(live):
    vehicles, systems, _ = live
    for vehicle, number, z in ((vehicles.plane, PLANE, 70.0), (vehicles.rover, ROVER, 0.0)):
        vehicle.plan = PlanMessage(id=number, items=[ItemMessage(position=Vector3(x=x, y=50.0, z=z)) for x in (0.0, 100.0)])
        items = Mission(systems[number]).download_mission().mission_items
        assert [i.relative_altitude_m for i in items] == pytest.approx([z - vehicle.home[2]] * 2)


def test_a_mission_with_a_jump_comes_down_item_by_item(live):
    """MAVSDK's plugin ``mission`` knows no jumps, whoever sends them; ``mission_raw`` does."""
    vehicles, systems, _ = live
    jump = ItemMessage(kind=ItemMessage.JUMP, jump_to=0, repeat=-1)
    vehicles.plane.plan = PlanMessage(id=9, items=[ItemMessage(position=Vector3(x=1.0, y=2.0, z=70.0)), jump])
    with pytest.raises(MissionError, match="UNSUPPORTED"):
        Mission(systems[PLANE]).download_mission()
    got = MissionRaw(systems[PLANE]).download_mission()
    assert [(i.frame, i.command, i.param2) for i in got] == [(6, 16, 0.0), (2, 177, -1.0)]


def test_it_arms_and_disarms(live):
    _, systems, telemetry = live
    for number, system in systems.items():
        Action(system).arm()
        wait(telemetry[number].armed, 2.0)
    Action(systems[ROVER]).disarm()
    wait(lambda: not telemetry[ROVER].armed(), 2.0)


def test_a_mission_goes_up_comes_back_and_is_flown_to_its_end(live):
    vehicles, systems, _ = live
    mission, seen = Mission(systems[PLANE]), []
    items = [
        MissionItem(latitude_deg=lat, longitude_deg=lon, relative_altitude_m=up, is_fly_through=True, acceptance_radius_m=10.0)
        for lat, lon, up in POINTS
    ]
    mission.upload_mission(MissionPlan(items))
    back = [(i.latitude_deg, i.longitude_deg, i.relative_altitude_m) for i in mission.download_mission().mission_items]
    assert back == [pytest.approx(point, abs=1e-7) for point in POINTS]

    mission.subscribe_mission_progress(lambda progress, _: seen.append((progress.current, progress.total)))
    mission.set_current_mission_item(0)
    mission.start_mission()
    wait(mission.is_mission_finished, 20.0)
    assert seen[-1] == (3, 3) and {(1, 3), (2, 3)} <= set(seen)
    latitude, longitude, altitude = PLANE_FACTS.geodetic(vehicles.plane.position)
    assert (latitude, longitude) == pytest.approx(POINTS[-1][:2], abs=1e-6)
    assert altitude == pytest.approx(430.0, abs=0.01)


def test_modes_change_and_what_the_vehicle_cannot_do_is_refused(live):
    _, systems, telemetry = live
    action = Action(systems[PLANE])
    action.hold()
    wait(lambda: telemetry[PLANE].flight_mode() == HOLD, 2.0)
    action.return_to_launch()
    wait(lambda: telemetry[PLANE].flight_mode() == RETURN, 2.0)
    with pytest.raises(ActionError, match="DENIED"):
        action.takeoff()


def test_go_to_moves_the_vehicle_there(live):
    vehicles, systems, _ = live
    Action(systems[PLANE]).goto_location(40.77, 14.79, 400.0, 0.0)
    wait(lambda: abs(vehicles.plane.position - (0.0, 0.0, 100.0)).max() < 0.1)


def test_parameters_are_listed_and_fixed(live):
    _, systems, _ = live
    parameters = Param(systems[ROVER])
    values = {p.name: p.value for p in parameters.get_all_params().int_params}
    assert values["MAV_SYS_ID"] == ROVER and values["COM_FLTMODE1"] == -1
