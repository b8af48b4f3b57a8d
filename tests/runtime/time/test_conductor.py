"""Simulation time: never ahead of the simulators, scaled, paused, stepped, and taken up again."""

import pytest

from schemas.messages import Clock, ClockRequest, Done
from uvf.runtime.time.conductor import Conductor

NS = 1_000_000_000


def ready(conductor, *names):
    for name in names:
        conductor.done(Done(participant=name), boot=1)


def run(conductor, wall, until, speed=None):
    """Asks every millisecond; the simulator reports at once, or at most ``speed`` s of simulation per wall second."""
    ticks, begun = [], wall
    while wall < until:
        tick = conductor.advance(wall)
        reached = conductor.t_ns if speed is None else min(conductor.t_ns, int((wall - begun) * speed * NS))
        conductor.done(Done(participant="sim", t_ns=reached, epoch=conductor.epoch), boot=1)
        ticks += [tick] if tick else []
        wall += 0.001
    return ticks


def test_time_begins_when_everybody_is_ready():
    conductor = Conductor(["sim"], ["slam"])
    ready(conductor, "sim")
    assert conductor.advance(0.0) is None
    assert conductor.waiting_for() == "slam"
    ready(conductor, "slam")
    assert run(conductor, 0.0, 0.1)


@pytest.mark.parametrize("rate", [0.5, 1.0, 3.0])
def test_time_runs_at_the_rate_asked(rate):
    conductor = Conductor(["sim"], [], rate)
    ready(conductor, "sim")
    run(conductor, 0.0, 2.0)
    assert conductor.t_ns / NS == pytest.approx(2.0 * rate, rel=0.02)


def test_a_slow_simulator_lowers_the_rate_and_time_never_runs_ahead():
    conductor = Conductor(["sim"], [])
    ready(conductor, "sim")
    ticks = run(conductor, 0.0, 4.0, speed=0.5)
    assert conductor.t_ns / NS == pytest.approx(2.0, rel=0.03)
    assert ticks[-1].rate == pytest.approx(0.5, rel=0.05)


def test_paused_time_stands_and_steps_one_by_one():
    conductor = Conductor(["sim"], [])
    ready(conductor, "sim")
    run(conductor, 0.0, 0.5)
    assert conductor.request(ClockRequest(action=ClockRequest.PAUSE)).accepted
    before = conductor.t_ns
    assert run(conductor, 0.5, 1.0) == []
    conductor.request(ClockRequest(action=ClockRequest.STEP))
    (tick,) = run(conductor, 1.0, 1.2)
    assert tick.t_ns == before + NS // 100
    assert tick.state == Clock.PAUSED
    conductor.request(ClockRequest(action=ClockRequest.RESUME))
    run(conductor, 1.2, 1.7)
    assert (conductor.t_ns - before) / NS == pytest.approx(0.51, abs=0.03)


def test_a_step_is_refused_while_time_runs():
    reply = Conductor(["sim"], []).request(ClockRequest(action=ClockRequest.STEP))
    assert not reply.accepted and "pause" in reply.reason


def test_lockstep_waits_for_each_participant_and_names_it():
    conductor = Conductor(["sim"], ["slam"], lockstep=True)
    ready(conductor, "sim", "slam")
    first = conductor.advance(0.0)
    assert first.tick == 1
    conductor.done(Done(participant="sim", tick=1, t_ns=first.t_ns, epoch=1, published={"uvf/v/sensor/imu": 7}), boot=1)
    assert conductor.advance(0.001) is None
    assert conductor.waiting_for() == "slam"
    conductor.done(Done(participant="slam", tick=1, t_ns=first.t_ns, epoch=1), boot=1)
    assert dict(conductor.advance(0.002).published) == {"uvf/v/sensor/imu": 7}


def test_a_simulator_that_comes_back_starts_a_new_epoch():
    conductor = Conductor(["sim"], [])
    ready(conductor, "sim")
    run(conductor, 0.0, 0.5)
    line = conductor.done(Done(participant="sim"), boot=2)
    assert "afresh" in line
    assert (conductor.epoch, conductor.t_ns) == (2, 0)


def test_a_simulator_that_is_slow_to_hear_the_first_clock_has_not_started_again():
    conductor = Conductor(["sim"], [])
    ready(conductor, "sim")
    assert conductor.advance(0.0) is None
    assert conductor.advance(0.02) is not None
    assert conductor.done(Done(participant="sim"), boot=1) == ""
    assert conductor.epoch == 1
    assert conductor.waiting_for() == "sim"
    assert run(conductor, 0.02, 0.1)


def test_a_conductor_that_comes_back_takes_time_up_where_it_was():
    conductor = Conductor(["sim"], ["slam"])
    conductor.done(Done(participant="sim", tick=3700, t_ns=37 * NS, epoch=2), boot=1)
    tick = run(conductor, 0.0, 0.1)[0]
    assert (tick.tick, tick.epoch) == (3701, 2)


def test_a_reset_asked_for_starts_time_over_in_a_new_epoch():
    conductor = Conductor(["sim"], [])
    ready(conductor, "sim")
    run(conductor, 0.0, 0.5)
    assert conductor.request(ClockRequest(action=ClockRequest.RESET)).accepted
    tick = run(conductor, 0.5, 0.6)[0]
    assert (tick.tick, tick.epoch) == (1, 2)


def test_a_ghost_does_not_hold_time_whatever_it_is_called():
    conductor = Conductor(["sim"], ["slam"], lockstep=True, vehicles=["anne"])
    ready(conductor, "sim", "slam")
    assert run(conductor, 0.0, 0.01)
    for name in ("sim.ghost", "slam.typo", "nobody", "sim.anne.x", *(f"slam.x{n}" for n in range(1000))):
        conductor.done(Done(participant=name, epoch=1), boot=9)
    assert conductor.missing() == [] and len(conductor._participants) == 2


def test_a_kind_may_have_a_process_for_each_vehicle_of_the_mission():
    conductor = Conductor(["sim"], ["slam"], lockstep=True, vehicles=["anne"])
    ready(conductor, "sim", "slam.anne")
    assert conductor.waiting_for() == ""
