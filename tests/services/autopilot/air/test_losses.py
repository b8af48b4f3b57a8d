"""The demo's aircraft flies on when it loses satellites, pressures or both, and says what it does."""

import math

import numpy as np
import pytest

from schemas import topics
from schemas.messages import Gnss, GoalRequest, Mode, ModeRequest, Vector3
from services.autopilot.air.failsafes.table import AIR_RULES
from tests.runtime.stepping import recall
from tests.services.autopilot.air.sensing import Bench, sensors
from tests.services.autopilot.air.test_flight import Flight, distance_to_circuit
from uvf.maths.rotations import to_euler
from uvf.runtime.messages.convert import wxyz

IN_A_TURN = 14.5  # s: the demo's aircraft is banked at its first corner
RULES = {rule.name: rule for rule in AIR_RULES}
DEAD_RECKONING, BACK = RULES["gnss"].raised_text, RULES["gnss"].cleared_text


class Losing(Flight):
    """A flight whose sensors can be taken away and given back."""

    def __init__(self):
        super().__init__()
        self.events = self._record(topics.EVENTS.by("autopilot"))
        (shell,) = [s for s in self.lockstep.shells if s.type.name == "sim_air"]
        (self._craft,) = shell.service._stage.aircraft.values()
        self._fitted = {}

    def lose(self, *names):
        for name in names:
            self._fitted[name] = getattr(self._craft, name)
            setattr(self._craft, name, None)

    def give_back(self, name):
        setattr(self._craft, name, self._fitted[name])

    def banks(self, after):
        return np.array([to_euler(wxyz(m.orientation))[0] for t, m in self.truth if t >= after])

    def drift(self):
        """m, of the estimate from the truth now, horizontally."""
        true, reckoned = self.truth[-1][1].position, self.estimate[-1][1].position
        return math.hypot(true.x - reckoned.x, true.y - reckoned.y)

    @property
    def texts(self):
        return [(round(t, 1), m.text) for t, m in self.events]


@pytest.fixture(scope="module")
def without_gnss():
    flight = Losing()
    flight.lockstep.run(IN_A_TURN)
    assert abs(flight.banks(after=IN_A_TURN - 0.1)[-1]) > 0.3
    flight.lose("gnss")
    flight.lockstep.run(80.0)
    return flight


def test_a_turn_does_not_become_a_spiral_without_gnss(without_gnss):
    assert np.abs(without_gnss.banks(after=30.0)).max() < 0.9
    assert np.abs(without_gnss.positions()[:, 2] - 60.0).max() < 3.0
    assert max(abs(m.airspeed - 25.0) for _, m in without_gnss.truth) < 1.5


def test_without_gnss_it_holds_after_five_seconds(without_gnss):
    modes = {t: m.mode for t, m in without_gnss.status}
    held = min(t for t, mode in modes.items() if mode == Mode.MODE_HOLD)
    assert held == pytest.approx(IN_A_TURN + 5.0, abs=0.5)
    assert without_gnss.status[-1][1].reason == "GNSS lost: holds by dead reckoning"
    assert np.ptp(without_gnss.positions(after=40.0)[:, :2], axis=0).max() < 240.0


def test_dead_reckoning_knows_about_how_far_it_is_off(without_gnss):
    sigmas = [m.position_sigma for t, m in without_gnss.estimate if t > IN_A_TURN + 2.0]
    assert all(b > a for a, b in zip(sigmas, sigmas[100:], strict=False))
    assert without_gnss.drift() < 3 * sigmas[-1] < 90.0
    assert without_gnss.drift() < 60.0


def test_the_loss_is_one_event(without_gnss):
    said = [(t, text) for t, text in without_gnss.texts if text == DEAD_RECKONING]
    assert [t for t, _ in said] == pytest.approx([IN_A_TURN + 2.0], abs=0.5)


def test_gnss_back_is_told_and_the_mission_goes_on_when_asked_for():
    flight = Losing()
    flight.lockstep.run(IN_A_TURN)
    flight.lose("gnss")
    flight.lockstep.run(30.0)
    flight.ask(topics.SET_MODE, ModeRequest(mode=Mode.MODE_MISSION, source="test"), 30.0)
    flight.lockstep.run(30.1)
    flight.give_back("gnss")
    flight.lockstep.run(40.0)
    assert not flight.replies[0].accepted
    assert "GNSS is lost" in flight.replies[0].reason
    assert BACK in [text for _, text in flight.texts]
    assert (flight.status[-1][1].mode, flight.status[-1][1].reason) == (Mode.MODE_HOLD, "GNSS back: holds until a mode is asked for")
    assert flight.drift() < 3.0
    flight.ask(topics.SET_MODE, ModeRequest(mode=Mode.MODE_MISSION, source="test"), 40.0)
    flight.lockstep.run(80.0)
    assert flight.replies[1].accepted
    assert max(map(distance_to_circuit, flight.positions(after=65.0))) < 13.0


def test_without_air_data_the_mission_goes_on():
    flight = Losing()
    flight.lockstep.run(IN_A_TURN)
    flight.lose("pressures")
    flight.lockstep.run(80.0)
    assert flight.status[-1][1].mode == Mode.MODE_MISSION
    assert max(map(distance_to_circuit, flight.positions())) < 15.0
    assert np.abs(flight.positions()[:, 2] - 60.0).max() < 6.0
    assert max(abs(m.airspeed - 25.0) for _, m in flight.truth) < 3.0
    assert RULES["air_data"].raised_text in [text for _, text in flight.texts]


def test_with_the_imu_alone_it_stays_upright():
    flight = Losing()
    flight.lockstep.run(IN_A_TURN)
    flight.lose("gnss", "pressures")
    flight.lockstep.run(60.0)
    assert np.abs(flight.banks(after=20.0)).max() < 1.0
    assert max(abs(m.airspeed - 25.0) for _, m in flight.truth) < 5.0
    assert np.abs(flight.positions()[:, 2] - 60.0).max() < 30.0
    assert flight.status[-1][1].mode == Mode.MODE_HOLD


def test_a_receiver_that_talks_but_has_no_fix_is_lost_too():
    bench = Bench()
    bench.run(cycles=50)
    bench.run(cycles=300, gnss=Gnss(fix=Gnss.NONE))
    assert bench.texts.count(DEAD_RECKONING) == 1
    assert bench.status.mode == Mode.MODE_HOLD
    (goal,) = bench.run(gnss=None, goal=[GoalRequest(position=Vector3(x=1.0, z=60.0))])["goal"]
    assert "GNSS is lost" in goal.reason


def test_a_short_gap_is_told_and_changes_no_mode():
    bench = Bench()
    bench.run(cycles=50)
    bench.run(cycles=150, gnss=None)
    bench.run(cycles=5)
    assert (bench.texts.count(DEAD_RECKONING), bench.texts.count(BACK)) == (1, 1)
    assert bench.status.mode == Mode.MODE_MISSION


def test_a_fix_of_long_ago_is_none():
    bench = Bench()
    bench.run(cycles=50)
    for k in range(250):
        late = sensors(1.0 + k / 1000)["gnss"]
        bench.run(gnss=late)
    assert bench.texts.count(DEAD_RECKONING) == 1


@pytest.mark.parametrize("field", ["latitude", "altitude", "horizontal_accuracy"])
def test_a_fix_that_is_not_finite_is_none(field):
    bench = Bench()
    bench.run(cycles=50)
    for _ in range(150):
        bad = sensors(bench.n / 50)["gnss"]
        setattr(bad, field, math.nan)
        state = bench.run(gnss=bad)["nav_state"]
    assert math.isfinite(state.position.x)
    assert bench.texts.count(DEAD_RECKONING) == 1


@pytest.mark.parametrize("field", ["static_pressure", "differential_pressure", "temperature"])
def test_pressures_that_are_not_finite_are_none(field):
    bench = Bench()
    bench.run(cycles=50)
    bad = sensors(1.0)["air_data"]
    setattr(bad, field, math.nan)
    state = bench.run(cycles=10, air_data=bad)["nav_state"]
    assert math.isfinite(state.airspeed) and math.isfinite(state.position.z)
    assert RULES["air_data"].raised_text in bench.texts


def test_an_autopilot_started_again_without_gnss_reckons_on_from_what_was_left():
    bench, heir = Bench(), Bench()
    left = bench.run(cycles=100)["nav_state"]
    recall(heir.service, status=bench.status, nav_state=left)
    heir.n = 150
    states = [heir.run(gnss=None).get("nav_state") for _ in range(400)]
    assert states[10] is None  # GNSS might be there in a moment
    assert states[60].position.x == pytest.approx(25.0 * (3.0 + 60 / 50), abs=5.0)
    assert heir.status.mode == Mode.MODE_HOLD


def test_what_was_left_long_ago_is_not_reckoned_on_from():
    bench, heir = Bench(), Bench()
    left = bench.run(cycles=10)["nav_state"]
    recall(heir.service, status=bench.status, nav_state=left)
    heir.n = 3000
    assert "surfaces" not in heir.run(cycles=100, gnss=None)
