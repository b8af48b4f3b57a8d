"""Which command counts: mode, then priority, then age."""

from math import inf, nan

import pytest

from schemas.messages import Mode
from services.autopilot.ground.multiplexer import CLOCK_TOLERANCE, COMMAND_MAX_AGE, SOURCES, VelocityCommand, choose
from uvf.maths.kinematics import Twist

ALL = {
    name: VelocityCommand(10.0, Twist(0.1 * (i + 1), 0.0))
    for i, name in enumerate(("planner", "offboard", "executive", "client", "gcs", "mavlink", "teleop"))
}


@pytest.mark.parametrize(
    ("mode", "winner"),
    [
        (Mode.MODE_MANUAL, "teleop"),
        (Mode.MODE_MISSION, "planner"),
        (Mode.MODE_RETURN, "planner"),
        (Mode.MODE_OFFBOARD, "offboard"),
        (Mode.MODE_HOLD, ""),
    ],
)
def test_the_mode_decides_who_drives(mode, winner):
    choice = choose(10.0, mode, ALL, "")
    assert choice.source == winner
    assert choice.twist == (ALL[winner].twist if winner else Twist(0.0, 0.0))


def test_in_manual_mode_the_first_fresh_source_of_the_order_wins():
    order = list(SOURCES[Mode.MODE_MANUAL])
    commands = dict(ALL)
    for source in order:
        assert choose(10.0, Mode.MODE_MANUAL, commands, "").source == source
        commands[source] = VelocityCommand(10.0 - COMMAND_MAX_AGE - 0.01, Twist(1.0, 0.0))
    assert choose(10.0, Mode.MODE_MANUAL, commands, "").source == ""


def test_an_old_command_means_stop_and_says_so():
    choice = choose(10.6, Mode.MODE_MISSION, ALL, "")
    assert choice.twist == Twist(0.0, 0.0)
    assert choice.reason == "mode MISSION: no fresh command from planner"


def test_an_obstacle_beats_every_command():
    choice = choose(10.0, Mode.MODE_MANUAL, ALL, "disarmed")
    assert (choice.source, choice.twist, choice.reason) == ("", Twist(0.0, 0.0), "disarmed")


def test_a_command_from_the_future_does_not_count():
    ahead = {"planner": VelocityCommand(1000.0, Twist(0.3, 0.0))}
    assert choose(10.0, Mode.MODE_MISSION, ahead, "").source == ""
    a_tick_ahead = {"planner": VelocityCommand(10.0 + CLOCK_TOLERANCE / 2, Twist(0.3, 0.0))}
    assert choose(10.0, Mode.MODE_MISSION, a_tick_ahead, "").source == "planner"


@pytest.mark.parametrize("command", [(nan, 0.0), (0.0, nan), (inf, 0.0), (0.0, -inf), (0.0, 0.0, nan)])
def test_a_command_that_is_no_number_is_refused_with_the_reason(command):
    choice = choose(10.0, Mode.MODE_MISSION, {"planner": VelocityCommand(10.0, Twist(*command))}, "")
    assert (choice.source, choice.twist) == ("", Twist(0.0, 0.0))
    assert "not a velocity: planner" in choice.reason


def test_behind_a_refused_command_the_next_source_counts():
    sent = {"teleop": VelocityCommand(10.0, Twist(nan, 0.0)), "client": VelocityCommand(10.0, Twist(0.2, 0.1))}
    choice = choose(10.0, Mode.MODE_MANUAL, sent, "")
    assert (choice.source, choice.twist) == ("client", Twist(0.2, 0.1))
    assert choice.refused == "teleop (nan m/s, 0 rad/s)"


def test_in_offboard_equals_do_not_alternate_and_a_program_on_board_comes_first():
    client, mavlink, board = (VelocityCommand(10.0, Twist(speed, 0.0)) for speed in (0.1, 0.2, 0.3))
    both = {"client": client, "mavlink": mavlink}
    for held in both:
        assert choose(10.0, Mode.MODE_OFFBOARD, both, "", held).source == held
    assert choose(10.0, Mode.MODE_OFFBOARD, {**both, "offboard": board}, "", "mavlink").source == "offboard"
    assert choose(10.0, Mode.MODE_MANUAL, {**both, "teleop": board}, "", "mavlink").source == "teleop"
