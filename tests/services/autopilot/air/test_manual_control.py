"""Mode Manual: surface commands are passed on while they are fresh; then the autopilot flies, or the aircraft is stopped."""

import math

import pytest

from schemas.messages import ArmRequest, Mode, ModeRequest, SurfaceCommand
from services.autopilot.air.manual_control import SOURCES, ManualSources
from tests.services.autopilot.air.sensing import Bench, resting
from tests.stops import ENGAGED
from uvf.runtime.messages.convert import stamp

MANUAL = [ModeRequest(mode=Mode.MODE_MANUAL, source="test")]
ASKED = {"aileron": 0.11, "elevator": -0.07, "rudder": 0.05, "throttle": 0.6, "flap": 0.2, "brake": 0.3}


def command(t, **fields):
    return SurfaceCommand(timestamp=stamp(t), **{**ASKED, **fields})


def is_manual(bench, cycles, source="teleop", speed=25.0, **asked):
    """Steps with a fresh command of ``source`` in each cycle."""
    for _ in range(cycles):
        bench.run(speed=speed, **{source: command(bench.n * 0.02), **asked})
        asked = {}
    return bench.outputs[-1]


def choose(t, commands, longest):
    return ManualSources().choose(t, commands, longest)


def told(surfaces):
    return {name: pytest.approx(getattr(surfaces, name)) for name in ASKED}


@pytest.fixture
def bench():
    bench = Bench()
    bench.run(cycles=10)
    is_manual(bench, 1, mode=MANUAL)
    return bench


@pytest.mark.parametrize("source", SOURCES)
def test_what_a_source_asks_for_reaches_the_surfaces_unchanged(bench, source):
    assert told(is_manual(bench, 40, source)["surfaces"]) == ASKED  # teleop counts half a second on
    assert (bench.status.mode, bench.status.command_source) == (Mode.MODE_MANUAL, source)


def test_in_other_modes_nobody_is_let_through():
    bench = Bench()
    is_manual(bench, 10)
    assert bench.outputs[-1]["surfaces"].brake == 0.0
    assert bench.status.command_source == "autopilot"


def test_a_source_that_falls_silent_in_the_air_leaves_it_to_hold_after_half_a_second(bench):
    is_manual(bench, 10)
    last = bench.n * 0.02
    for _ in range(24):
        held = bench.run(teleop=command(last - 0.02))
    assert told(held["surfaces"]) == ASKED
    bench.run(cycles=4, teleop=command(last - 0.02))
    assert bench.status.mode == Mode.MODE_HOLD
    assert bench.status.reason == "manual control lost"
    assert told(bench.outputs[-1]["surfaces"]) != ASKED
    is_manual(bench, 10)
    assert bench.status.mode == Mode.MODE_HOLD, "who comes back has to ask for the mode"


def test_the_first_command_is_waited_for_while_the_autopilot_flies():
    bench = Bench()
    bench.run(cycles=10)
    bench.run(mode=MANUAL)
    bench.run(cycles=20)
    assert bench.status.mode == Mode.MODE_MANUAL
    assert 0.2 < bench.outputs[-1]["surfaces"].throttle <= 1.0
    bench.run(cycles=6)
    assert bench.status.mode == Mode.MODE_HOLD


def test_silence_on_the_ground_stops_the_motor_and_brakes():
    bench = resting([])
    is_manual(bench, 1, speed=0.0, mode=MANUAL)
    bench.run(cycles=60, speed=0.0)
    out = bench.outputs[-1]["surfaces"]
    assert bench.status.mode == Mode.MODE_MANUAL
    assert (out.throttle, out.brake, out.elevator) == (0.0, 1.0, 0.0)


def test_it_takes_over_at_a_height_where_one_can_circle():
    bench = Bench()
    bench.run(cycles=10)
    bench.service.params = type(bench.service.params)(min_altitude=200.0)
    is_manual(bench, 10, mode=MANUAL)
    bench.run(cycles=60)
    assert bench.service._mode_manager.circle.centre.height == 200.0


def test_disarmed_the_motor_stays_off_by_hand(bench):
    is_manual(bench, 1, arm=[ArmRequest(arm=False, force=True)])
    out = is_manual(bench, 5)["surfaces"]
    assert (out.throttle, out.aileron) == (0.0, pytest.approx(ASKED["aileron"]))


def test_stop_all_comes_before_the_hand(bench):
    bench.run(teleop=command(bench.n * 0.02), stop=ENGAGED)
    (reply,) = is_manual(bench, 1, stop=ENGAGED, mode=MANUAL)["mode"]
    assert not reply.accepted
    assert bench.status.mode == Mode.MODE_HOLD


def test_flying_by_hand_needs_no_satellites(bench):
    bench.service._mode_manager.fly_blind(True)
    assert bench.service._mode_manager.mode.value == "Manual"
    assert bench.service._mode_manager.change_mode(bench.service._mode_manager.mode, "test") == ""


def test_the_order_of_the_sources_decides():
    commands = dict.fromkeys(SOURCES, command(10.0))
    for source in SOURCES:
        assert choose(10.0, commands, 0.5).source == source
        del commands[source]
    assert choose(10.0, commands, 0.5) is None


@pytest.mark.parametrize(("age", "counts"), [(0.0, True), (0.5, True), (0.52, False), (-0.02, True), (-0.1, False)])
def test_only_what_is_fresh_counts(age, counts):
    assert (choose(10.0, {"client": command(10.0 - age)}, 0.5) is not None) is counts


@pytest.mark.parametrize("name", ASKED)
@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_no_numbers_are_passed_on_and_the_next_source_counts(name, value):
    assert choose(10.0, {"teleop": command(10.0, **{name: value}), "client": command(10.0)}, 0.5).source == "client"


def test_throttle_brake_and_flap_keep_their_ranges():
    asked = choose(10.0, {"client": command(10.0, throttle=1.7, brake=-0.2, flap=-0.1)}, 0.5).surfaces
    assert (asked.throttle, asked.brake, asked.flap) == (1.0, 0.0, 0.0)


def test_a_hand_that_waits_and_a_hand_over_are_told_once(bench):
    is_manual(bench, 5)
    for _ in range(20):
        bench.run(teleop=command(bench.n * 0.02), mavlink=command(bench.n * 0.02, aileron=-0.1))
    assert told(bench.outputs[-1]["surfaces"]) == ASKED
    is_manual(bench, 40, "mavlink")
    assert [text for text in bench.texts if "by hand" in text] == [
        "commands by hand of mavlink wait",
        "commands by hand from mavlink, no longer from teleop",
    ]
