"""The table of modes: every refusal, every loss and every end, as the documentation tells them."""

import itertools

import pytest

from services.autopilot.air.mode_manager import ModeManager
from services.autopilot.air.mode_table import TABLE, FlightMode, Need, Situation, lost, refusal
from services.autopilot.air.setpoints import FlightContext, ManualCommand
from tests.services.autopilot.air.states import PARAMS, cruising
from uvf.control.commands import Surfaces
from uvf.guidance.flight_plan import ItemKind, PlanItem
from uvf.guidance.route import Circle, Place
from uvf.models.scenario import ROOT

M = FlightMode
SITUATIONS = [
    Situation(airborne, known, mission, setpoint, stopped, led, wheels)
    for airborne, known, mission, setpoint, led, wheels in itertools.product((False, True), repeat=6)
    for stopped in ("", "gcs")
]
MET = {
    Need.RELEASED: lambda s: not s.stopped,
    Need.POSITION: lambda s: s.position_known,
    Need.AIRBORNE: lambda s: s.airborne,
    Need.GROUND: lambda s: not s.airborne,
    Need.MISSION: lambda s: s.has_mission,
    Need.SETPOINT: lambda s: s.setpoint,
    Need.LEADER: lambda s: s.led,
    Need.WHEELS: lambda s: s.wheels,
}
FAR = [PlanItem(ItemKind.WAYPOINT, Place(900.0, 0.0, 70.0)), PlanItem(ItemKind.WAYPOINT, Place(900.0, 900.0, 70.0))]


def test_every_mode_is_in_the_table():
    assert set(TABLE) == set(FlightMode)


@pytest.mark.parametrize("mode", FlightMode)
def test_a_mode_is_refused_exactly_when_a_need_is_not_met_and_names_the_first(mode):
    for situation in SITUATIONS:
        missing = [need for need in TABLE[mode].needs if not MET[need](situation)]
        told = refusal(mode, situation)
        assert told == (missing[0].value.format(stopped=situation.stopped) if missing else ""), situation


@pytest.mark.parametrize("mode", FlightMode)
def test_what_a_mode_lives_on_is_looked_at(mode):
    for situation in SITUATIONS:
        assert lost(mode, situation) == next((n for n in TABLE[mode].keeps if not MET[n](situation)), None)


def flying(items=FAR, airborne=True, armed=True, **now):
    mode_manager = ModeManager(items)
    mode_manager.hear(FlightContext(airborne=airborne, armed=armed), 0.02)
    mode_manager.step(cruising(**now), PARAMS, 0.02)
    return mode_manager


STANDING = {"airspeed": 0.5, "ground_speed": 0.1, "height": 0.4}


@pytest.mark.parametrize("mode", [m for m in FlightMode if Need.AIRBORNE in TABLE[m].needs])
def test_on_the_ground_a_mode_of_the_air_is_refused_and_nothing_changes(mode):
    mode_manager = flying([], airborne=False, **STANDING)
    assert "on the ground" in mode_manager.change_mode(mode, "test")
    assert mode_manager.mode is M.HOLD


def airship():
    mode_manager = flying()
    mode_manager.has_wheels = False
    return mode_manager


@pytest.mark.parametrize("mode", [M.TAKEOFF, M.LAND])
def test_an_airship_neither_takes_off_nor_lands(mode):
    mode_manager = airship()
    assert "an airship" in mode_manager.change_mode(mode, "test")
    assert mode_manager.mode is M.MISSION


def test_an_airship_that_has_returned_circles_on():
    mode_manager = airship()
    assert mode_manager.change_mode(M.RETURN, "test") == ""
    mode_manager.step(cruising(), PARAMS, 0.02)
    mode_manager._phase.ended = "return: lands"
    mode_manager.step(cruising(), PARAMS, 0.02)
    assert (mode_manager.mode, mode_manager.reason) == (M.HOLD, Need.WHEELS.value)


def test_in_the_air_a_take_off_is_refused():
    assert "flying" in flying().change_mode(M.TAKEOFF, "test")


@pytest.mark.parametrize("mode", [m for m in FlightMode if m is not M.HOLD])
def test_while_it_is_stopped_only_hold_is_taken(mode):
    mode_manager = flying()
    mode_manager.stop("gcs")
    assert "stopped by gcs" in mode_manager.change_mode(mode, "test")
    assert mode_manager.change_mode(M.HOLD, "test") == ""


def test_a_mode_may_be_changed_to_with_a_reason_of_its_own():
    mode_manager = flying()
    assert mode_manager.change_mode(M.RETURN, "failsafe", "battery low") == ""
    assert (mode_manager.mode, mode_manager.reason) == (M.RETURN, "battery low")


def holding_the_stick(mode_manager):
    hand = ManualCommand("teleop", Surfaces(0.0, 0.0, 0.0, 0.5))
    mode_manager.hear(FlightContext(hand=hand), 0.02)
    mode_manager.step(cruising(), PARAMS, 0.02)


@pytest.mark.parametrize("mode", [m for m in FlightMode if Need.POSITION in TABLE[m].keeps])
def test_without_satellites_a_mode_over_ground_falls_where_the_table_says(mode):
    mode_manager = flying()
    mode_manager.mode = mode
    holding_the_stick(mode_manager)
    mode_manager.fly_blind(True)
    assert mode_manager.mode is TABLE[mode].without
    assert "GNSS lost" in mode_manager.reason


@pytest.mark.parametrize("mode", [M.MANUAL, M.STABILIZED, M.ALTITUDE, M.TAKEOFF])
def test_modes_through_the_air_need_no_satellites(mode):
    mode_manager = flying()
    mode_manager.mode = mode
    mode_manager.fly_blind(True)
    assert mode_manager.mode is mode


@pytest.mark.parametrize("mode", [m for m in FlightMode if TABLE[m].is_manual])
def test_a_stick_that_is_let_go_is_told_and_meanwhile_it_circles(mode):
    mode_manager = flying()
    assert mode_manager.change_mode(mode, "test") == ""
    holding_the_stick(mode_manager)
    for _ in range(30):
        mode_manager.hear(FlightContext(), 0.02)
        mode_manager.step(cruising(), PARAMS, 0.02)
    assert mode_manager.is_manual_control_lost and mode_manager.mode is mode and mode_manager.circle is not None
    holding_the_stick(mode_manager)
    mode_manager.step(cruising(), PARAMS, 0.02)
    assert not mode_manager.is_manual_control_lost and mode_manager.circle is None


@pytest.mark.parametrize("mode", [m for m in FlightMode if not TABLE[m].on_ground])
def test_on_the_ground_such_a_mode_keeps_motor_off_and_brakes_on(mode):
    mode_manager = flying([], airborne=False, **STANDING)
    mode_manager.mode = mode
    surfaces = mode_manager.step(cruising(**STANDING), PARAMS, 0.02).surfaces
    assert (surfaces.throttle, surfaces.brake) == (0.0, 1.0)


def test_an_orbit_is_flown_as_asked():
    mode_manager = flying()
    assert mode_manager.orbit(Circle(Place(200.0, 100.0, 80.0), -120.0), 22.0, "test", PARAMS) == ""
    mode_manager.step(cruising(), PARAMS, 0.02)
    assert (mode_manager.mode, mode_manager.circle) == (M.ORBIT, Circle(Place(200.0, 100.0, 80.0), -120.0))


@pytest.mark.parametrize(
    ("radius", "airspeed", "why"),
    [(10.0, 0.0, "too tight"), (100.0, 60.0, "cannot be flown"), (float("nan"), 0.0, "not finite")],
)
def test_an_orbit_that_cannot_be_flown_is_refused(radius, airspeed, why):
    mode_manager = flying()
    assert why in mode_manager.orbit(Circle(Place(0.0, 0.0, 80.0), radius), airspeed, "test", PARAMS)
    assert mode_manager.mode is M.MISSION


def test_without_an_approach_there_is_nothing_to_go_around_from():
    assert "no approach" in flying().go_around("test")


def test_the_documentation_holds_the_table():
    text = (ROOT / "docs" / "reference" / "modes.md").read_text()
    for mode, row in TABLE.items():
        needs = ", ".join(need.name.lower() for need in row.needs) or "-"
        without = row.without.value if row.keeps or row.is_manual else "-"
        done = row.done.value if row.done else "-"
        assert f"| {mode.value} | {needs} | {without} | {done} |" in text
