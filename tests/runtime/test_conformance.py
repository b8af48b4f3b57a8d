"""What every runtime keeps, claim by claim, in one process and over Zenoh, each in lockstep and live.

Ages, requests and restarts have files of their own: ``test_ages``, ``test_requests``, ``test_restarts``.
"""

import json
import time

import pytest

from schemas import topics
from schemas.messages import ClockRequest, ParamReply, ParamRequest, WheelCommand
from tests.runtime.modes import MODES, RUNS, Distributed, run_in
from uvf.runtime.messages.step_times import step_time

UNTIL = 2.3


@pytest.fixture(scope="module", params=MODES)
def outcome(request):
    result = MODES[request.param](UNTIL)
    result.mode = request.param
    return result


def test_step_n_is_at_n_over_hz_and_none_runs_twice(outcome):
    for service, hz in (("plant", 100.0), ("pilot.alpha", 50.0)):
        times = [round(t * 1e9) for t in outcome.toys.one(service).times]
        grid = {step_time(n, hz) for n in range(1, round(UNTIL * hz) + 1)}
        assert set(times) <= grid
        assert times == sorted(set(times))


def test_simulators_and_lockstep_leave_no_step_out(outcome):
    assert len(outcome.toys.one("plant").times) == round(UNTIL * 100)
    if "live" not in outcome.mode:
        pilot = outcome.toys.one("pilot.alpha")
        assert len(pilot.times) + len(pilot.missing) == round(UNTIL * 50)


def test_what_is_stamped_t_is_read_only_later_and_in_order(outcome):
    seen = outcome.toys.one("pilot.alpha").imu_times
    assert len(seen) > 100
    assert all(stamped < t for t, stamped in seen)
    assert [stamped for _, stamped in seen] == sorted(stamped for _, stamped in seen)


def test_slow_work_is_slow_everywhere(outcome):
    seen = outcome.toys.one("pilot.alpha").goal_stamps
    assert seen
    assert all(t > stepped + 0.5 for t, stepped in seen)


def test_the_first_step_waits_for_its_inputs(outcome):
    missing = outcome.toys.one("pilot.alpha").missing
    assert all(names == ("imu",) for _, names in missing)
    assert not missing or missing[-1][0] < outcome.toys.one("pilot.alpha").times[0]


def test_a_role_reads_the_vehicle_that_the_mission_names(outcome):
    assert len(outcome.toys.one("follower.beta").seen) > 10
    assert all(stamped < t for t, stamped in outcome.toys.one("follower.beta").seen)


def test_no_object_is_shared_between_services(outcome):
    sent = [WheelCommand.FromString(s.payload).left for s in outcome.of("uvf/alpha/actuator/wheels")]
    assert sent and max(sent) < 10
    assert max(outcome.toys.one("plant").state.values()) < 10


def test_requests_are_answered_by_the_next_step_and_recorded(outcome):
    answers = outcome.toys.one("thinker.alpha").answers
    assert answers and all(accepted for _, accepted in answers)
    assert len(outcome.of("uvf/alpha/srv/arm/request")) == len(outcome.of("uvf/alpha/srv/arm/reply")) >= 1
    assert len(outcome.of("uvf/alpha/state/events/pilot")) >= 1


def test_two_runs_are_equal_to_the_byte_and_another_seed_is_not():
    first = MODES["one process"](UNTIL)
    assert MODES["one process"](UNTIL).hash == first.hash
    assert MODES["one process"](UNTIL, seed=2).hash != first.hash


def test_lockstep_over_zenoh_gives_the_same_log_as_one_process():
    local, distributed = MODES["one process"](UNTIL), MODES["zenoh, lockstep"](UNTIL)
    for key in sorted({s.key for s in local.samples}):
        assert [s[2:5] for s in distributed.of(key)] == [s[2:5] for s in local.of(key)], key
    assert distributed.hash == local.hash


def test_processes_turned_by_hand_in_lockstep_are_the_same_as_a_lockstep_run():
    assert run_in(RUNS["one process, lockstep"](), UNTIL).hash == MODES["one process"](UNTIL).hash


def test_wall_services_go_on_while_time_is_paused():
    with Distributed(False, watcher=True) as run:
        run.run(0.3)
        run.conductor.request(ClockRequest(action=ClockRequest.PAUSE))
        watcher, pilot = run.toys.one("watcher"), run.toys.one("pilot.alpha")
        before, steps = watcher.steps, len(pilot.times)
        while watcher.steps < before + 10:
            run.bus.wait(0.01)
        assert len(pilot.times) <= steps + 2
        assert watcher.vehicles == {"alpha", "beta"}


def test_time_stands_while_a_simulator_is_gone():
    with Distributed(False) as run:
        run.run(0.2)
        run.end("plant")
        stood = run.conductor.t_ns
        end = time.monotonic() + 0.3
        while time.monotonic() < end:
            run.bus.wait(0.01)
            run.bus.poll()
            run.conductor.advance(time.monotonic())
        assert run.conductor.t_ns <= stood + 2 * step_time(1, topics.CLOCK.hz)
        assert run.conductor.waiting_for() == "plant"


def test_parameters_are_read_and_set_while_running():
    with Distributed(False) as run:
        run.run(0.1)

        def ask(**fields):
            got = []
            key = topics.PARAM.by("pilot").at("alpha")
            run.bus.call(
                key, ParamRequest(**fields).SerializeToString(), 0, lambda reply, reason, at: got.append(ParamReply.FromString(reply))
            )
            run.run(run.conductor.t_ns / 1e9 + 0.2)
            return got[0]

        (param,) = ask().params
        assert (param.name, param.min, param.max, param.unit) == ("gain", 0, 10, "1/s")
        assert ask(name="gain", value=json.dumps(2.5)).accepted
        assert run.toys.one("pilot.alpha").params.gain == 2.5
        assert ask(name="gain", value="11").reason == "gain: 11 is above 10"
        assert ask(name="gain", value='"x"').reason == "gain: 'x' is not a number; give it without a unit"
        assert "not a value in JSON" in ask(name="gain", value="x").reason
        assert "did you mean 'gain'" in ask(name="gian", value="1").reason
        assert run.toys.one("pilot.alpha").params.gain == 2.5


def test_a_wrong_type_or_broken_bytes_are_refused_with_a_line_and_nothing_stops():
    with Distributed(False) as run:
        run.run(0.2)
        key = topics.STOP.by("evil").at("sys")
        run.bus.publisher(key, "uvf.v1.DriveCommand", topics.STOP.qos).put(b"\x01\x02\x03", 0)
        run.bus.publisher(topics.NAV_STATUS.at("alpha"), "uvf.v1.NavStatus", topics.NAV_STATUS.qos).put(b"\xff\xff\xff", 0)
        run.run(1.0)
        assert any("uvf.v1.DriveCommand where uvf.v1.StopCommand is due" in line for line in run.warnings)
        assert any("broken uvf.v1.NavStatus" in line for line in run.warnings)
        assert run.toys.one("pilot.alpha").times[-1] > 0.9
