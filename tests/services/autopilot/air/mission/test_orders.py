"""Orders of failsafes that come at a bad moment: in the roll of a take-off, on the last metres of a landing."""

import pytest

from schemas.messages import Battery, SpeedCommand, VehicleCommandRequest
from services.autopilot.air.failsafes.monitor import FailsafeMonitor, VehicleCondition
from services.autopilot.air.mission.orders import carry_out
from services.autopilot.air.mode_manager import ModeManager
from services.autopilot.air.mode_table import FlightMode
from services.autopilot.air.modes.mission_flight import MissionMode
from services.autopilot.air.setpoints import FlightContext
from tests.services.autopilot.air.modes.test_landing import on_final
from tests.services.autopilot.air.states import PARAMS, cruising
from uvf.control.servos import SERVOS
from uvf.guidance.flight_plan import ItemKind, PlanItem
from uvf.guidance.plan_follower import PlanFollower
from uvf.guidance.route import Place

STANDS = cruising(airspeed=0.5, ground_speed=0.1, height=0.4)
ROLLS = cruising(airspeed=14.0, ground_speed=14.0, height=0.4)


class Start:
    """A take-off under a watch whose battery is nearly empty."""

    def __init__(self):
        self.mode_manager = ModeManager([], 0.0)
        self.mode_manager.mode = FlightMode.TAKEOFF
        self.safety = FailsafeMonitor(self.mode_manager, SERVOS)
        self.t = 0.0

    def fly(self, now, seconds, charge=1.0, airborne=True):
        for _ in range(round(seconds * 50)):
            self.t += 0.02
            self.mode_manager.hear(FlightContext(airborne=airborne, armed=True), 0.02)
            self.safety.hear(self.t, None, Battery(remaining=charge))
            self.safety.step(self.t, VehicleCondition(now, 0.0, airborne), PARAMS, 0.02)
            self.mode_manager.step(now, PARAMS, 0.02)
        return self.mode_manager.mode


def test_a_battery_that_is_critical_in_the_roll_is_landed_with_once_it_flies():
    start = Start()
    start.fly(STANDS, 0.5, airborne=False)
    assert start.fly(ROLLS, 5.0, charge=0.03) is FlightMode.TAKEOFF
    assert start.fly(cruising(height=5.0, airspeed=20.0), 0.5, charge=0.03) is FlightMode.TAKEOFF
    assert start.fly(cruising(height=14.0, airspeed=20.0), 0.5, charge=0.03) is FlightMode.LAND


def test_an_order_whose_cause_is_over_when_it_flies_is_none():
    start = Start()
    start.fly(STANDS, 0.5, airborne=False)
    start.fly(ROLLS, 5.0, charge=0.03)
    start.fly(ROLLS, 5.0, charge=0.9)
    assert start.fly(cruising(height=14.0, airspeed=20.0), 0.5, charge=0.9) is FlightMode.TAKEOFF


@pytest.mark.parametrize(("height", "mode"), [(30.0, FlightMode.RETURN), (8.0, FlightMode.MISSION)])
def test_a_landing_of_a_mission_is_given_up_for_a_failsafe_only_while_there_is_height(height, mode):
    landing, now = on_final(height / 0.08, height)
    landing.step(now, PARAMS, 0.02)
    start = Start()
    start.fly(now, 0.5)
    flight = MissionMode(start.mode_manager.navigator, start.mode_manager._field, start.mode_manager.home, start.mode_manager.context)
    flight.part = landing
    start.mode_manager.mode, start.mode_manager._phase = FlightMode.MISSION, flight
    for _ in range(400):  # the pilot stands still: this is one moment of the approach
        start.t += 0.02
        start.safety.hear(start.t, None, Battery(remaining=0.1))
        start.safety.step(start.t, VehicleCondition(now, 0.0, True), PARAMS, 0.02)
    assert start.safety.texts == ["battery low"]
    assert start.mode_manager.mode is mode


@pytest.mark.parametrize(("height", "goes_on"), [(30.0, False), (8.0, True)])
def test_a_landing_goes_on_without_satellites_only_near_the_ground(height, goes_on):
    landing, now = on_final(height / 0.08, height)
    landing.step(now, PARAMS, 0.02)
    assert landing.committed is goes_on
    mode_manager = ModeManager([], 0.0)
    mode_manager.step(now, PARAMS, 0.02)
    mode_manager.mode, mode_manager._phase = FlightMode.LAND, landing
    mode_manager.fly_blind(True)
    assert mode_manager.mode is (FlightMode.LAND if goes_on else FlightMode.HOLD)


def test_on_the_approach_of_a_mission_the_speed_is_the_landings_and_the_fence_lets_it_down():
    landing, now = on_final(375.0, 30.0)
    landing.step(now, PARAMS, 0.02)
    start = Start()
    start.fly(now, 0.5)
    manager = start.mode_manager
    slower = VehicleCommandRequest(speed=SpeedCommand(speed=PARAMS.trim_airspeed), source="test")
    manager.mode = FlightMode.MISSION
    manager.navigator = PlanFollower([PlanItem(ItemKind.LAND, Place(0.0, 0.0, 0.0))])
    assert carry_out(slower, manager, now, PARAMS) == ""
    flight = MissionMode(manager.navigator, manager._field, manager.home, manager.context)
    flight.part, manager._phase = landing, flight
    assert "but for take-off and landing" in carry_out(slower, manager, now, PARAMS)
    start.safety.step(start.t, VehicleCondition(now, 0.0, True), PARAMS, 0.02)
    assert manager.fence.grounds
