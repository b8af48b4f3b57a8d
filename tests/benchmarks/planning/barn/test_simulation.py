"""A whole run: endings, clock, what the controller gets, and that a seed gives the same run."""

import numpy as np
import pytest

from benchmarks.planning.barn import simulation
from benchmarks.planning.barn.jackal import SCANNER
from benchmarks.planning.barn.many import Series, make_runs
from benchmarks.planning.barn.movers import Track, movers_of
from benchmarks.planning.barn.registry import CHECKS
from benchmarks.planning.barn.simulation import Trial, run
from benchmarks.planning.barn.worlds import World
from tests.benchmarks.planning.barn.made_up import START, Commands, ahead, world


@pytest.fixture
def drive(monkeypatch):
    """Makes a run with commands (v, w) by a function of time; returns it and the controller."""

    def of(world, at, trial=0, seed=1):
        made = []
        monkeypatch.setitem(simulation.CONTROLLERS, "commands", lambda briefing: made.append(Commands(at)) or made[-1])
        return run(world, Trial(trial, seed, "commands")), made[0]

    return of


def test_straight_on_through_the_open_succeeds_and_into_a_cylinder_collides(drive):
    free, _ = drive(world(), lambda t: (1.0, 0.0))
    hit, _ = drive(world(discs=[(3.0, 0.1, 0.075)]), lambda t: (1.0, 0.0))
    assert free.ending == "success" and free.score == 0.5 and free.clearance == np.inf
    assert hit.ending == "collision" and hit.score == 0.0 and -0.01 < hit.clearance <= 1e-4
    nose = 3.0 - 0.075 - 0.254
    assert np.hypot(*(hit.end[:2] - START[:2])) == pytest.approx(nose, abs=0.012)


def test_the_clock_begins_when_it_has_moved_a_tenth_of_a_metre(drive):
    for waits in (0.0, 7.0):
        made, _ = drive(world(), lambda t, waits=waits: (1.0 if t >= waits else 0.0, 0.0))
        # 5 m to within a metre of the goal, of which the first 0.1 m do not count, at 1 m/s
        assert made.ending == "success" and made.time == pytest.approx(4.9, abs=0.06)


def test_who_stands_or_only_turns_is_out_of_time(drive, monkeypatch):
    monkeypatch.setattr("benchmarks.planning.barn.scoring.LIMIT", 3.0)
    stood, _ = drive(world(), lambda t: (0.0, 0.5))
    crept, _ = drive(world(), lambda t: (0.2, 0.0))
    assert stood.ending == crept.ending == "timeout"
    assert stood.time == 0.0 and crept.time == pytest.approx(3.0)
    assert stood.score == crept.score == 0.0


def test_the_goal_and_the_poses_are_in_the_frame_of_the_start(drive):
    made, controller = drive(world(), lambda t: (1.0, 0.3))
    assert controller.goal == pytest.approx((6.0, 0.0, 0.0), abs=1e-9)
    assert controller.given[0][2] == (0.0, 0.0, 0.0)
    _, _, believed, velocity = controller.given[60]
    c, s = np.cos(START.yaw), np.sin(START.yaw)
    dx, dy = made.true[60, :2] - START[:2]
    assert believed[:2] == pytest.approx((c * dx + s * dy, c * dy - s * dx), abs=0.05)
    assert believed.yaw == pytest.approx(made.true[60, 2] - START.yaw, abs=0.02)
    assert velocity.linear == pytest.approx(1.0, abs=0.05)


def test_odometry_is_never_the_truth(drive):
    made, _ = drive(world(goal=12.0), lambda t: (1.0, 0.4 * np.cos(t)))
    assert made.ending == "success"
    off = np.hypot(*(made.believed[-1] - made.true[-1])[:2])
    assert 1e-4 < off < 0.3


def test_scans_come_at_20_hz_from_where_the_scanner_is(drive):
    made, controller = drive(world(discs=[(3.0, 0.0, 0.5)]), lambda t: (0.0, 0.0) if t < 1.0 else (1.0, 0.0))
    times = np.array([t for t, *_ in controller.given])
    assert np.diff(times) == pytest.approx(0.05)
    first = controller.given[0][1]
    assert len(first) == SCANNER.beams and made.ending == "collision"
    middle = first[SCANNER.beams // 2 - 3 : SCANNER.beams // 2 + 3]
    assert middle == pytest.approx(3.0 - 0.5 - SCANNER.forward, abs=0.01) and middle.std() > 1e-5
    assert first[0] == first[-1] == 0.0  # no return
    assert np.hypot(*(made.seen - ahead(3.0)).T) == pytest.approx(0.5, abs=0.01)


def test_a_command_reaches_the_wheels_after_25_ms(drive):
    simulated = []
    monkeypatched = simulation.Drive.step

    class Spy(simulation.Drive):
        def step(self, command):
            simulated.append(command.linear)
            monkeypatched(self, command)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(simulation, "Drive", Spy)
        drive(world(), lambda t: (1.0 if t >= 0.5 else 0.0, 0.0))
    assert simulated.index(1.0) * simulation.DT == pytest.approx(0.525)


def test_what_is_no_velocity_is_refused(drive):
    with pytest.raises(ValueError, match=r"controller commands: commands v nan m/s.*at 0.00 s"):
        drive(world(), lambda t: (float("nan"), 0.0))


def test_a_moving_disc_runs_into_a_robot_that_stands(drive):
    across = np.array([(0.0, *ahead(0.0, 4.0)), (10.0, *ahead(0.0, -4.0))])
    made, _ = drive(world(movers=movers_of([Track(0.5, 10.0, across)], "linear")), lambda t: (0.0, 0.0))
    assert made.ending == "collision" and made.time == 0.0
    assert np.hypot(*(made.movers[0, :2] - START[:2])) < 0.5 + 0.254 + 0.02


def test_the_truth_and_the_world_are_told_to_checks_alone(monkeypatch):
    told = {}

    def keep(name):
        return lambda briefing: told.setdefault(name, briefing) and Commands(lambda t: (1.0, 0.0))

    monkeypatch.setitem(simulation.CONTROLLERS, "stack", keep("stack"))
    monkeypatch.setitem(CHECKS, "check", keep("check"))
    for name in ("stack", "check"):
        run(world(), Trial(0, 1, name))
    assert told["stack"].world is None and told["check"].world is not None
    assert told["stack"].robot.footprint.tolist() == [[-0.254, -0.216], [0.254, -0.216], [0.254, 0.216], [-0.254, 0.216]]


def slalom(number):
    """A world to follow a path in, that another process can make too."""
    discs = np.array([(x, 0.35 * (-1) ** i, 0.1) for i, x in enumerate(np.arange(2.0, 6.0, 1.0 + 0.1 * number))])
    path = np.array([(x, -0.35 * (-1) ** i) for i, x in enumerate(np.arange(2.0, 6.0, 1.0 + 0.1 * number))])
    start = START._replace(x=0.0, y=0.0, yaw=0.0)
    return World(f"slalom_{number}", start, (7.0, 0.0), discs, optimal_time=3.5, path=path)


def figures(made):
    return [(r.world, r.trial, r.ending, r.time, r.clearance, *r.end.tolist(), *r.believed[-1].tolist(), *r.seen[0].tolist()) for r in made]


def test_runs_are_the_same_whatever_the_number_of_processes(capsys):
    series = Series("slalom", slalom, (2, 3), 2, 5, "path")
    alone, two = make_runs(series, 1), make_runs(series, 2)
    assert figures(alone) == figures(two)
    assert [(r.world, r.trial) for r in alone] == [("slalom_2", 0), ("slalom_2", 1), ("slalom_3", 0), ("slalom_3", 1)]
    assert all(r.ending == "success" for r in alone)
    assert "uvf: slalom 4 of 4 runs, 0 failed" in capsys.readouterr().err


def test_trials_and_seeds_differ_in_noise_and_where_moving_discs_are():
    movers = movers_of([Track(0.5, 10.0, np.array([(0.0, 30.0, 5.0), (10.0, 40.0, 5.0)]))])
    where = world(discs=[(9.0, 0.0, 1.0)], movers=movers)
    made = [run(where, Trial(trial, seed, "straight")) for trial, seed in ((0, 1), (0, 1), (1, 1), (0, 2))]
    same, again, *others = [(tuple(r.movers[0]), tuple(r.seen[0]), tuple(r.believed[-1])) for r in made]
    assert same == again
    for other in others:
        assert all(a != b for a, b in zip(same, other, strict=True))
