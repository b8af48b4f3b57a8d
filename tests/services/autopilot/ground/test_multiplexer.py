"""Which command counts: mode, then priority, then age."""

import pytest

from schemas.messages import Mode
from services.autopilot.ground.multiplexer import COMMAND_MAX_AGE, SOURCES, Velocity, choose

ALL = {name: Velocity(10.0, 0.1 * (i + 1), 0.0) for i, name in enumerate(("planner", "offboard", "client", "gcs", "mavlink", "teleop"))}


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
    assert choice.linear == (ALL[winner].linear if winner else 0.0)


def test_in_manual_mode_the_first_fresh_source_of_the_order_wins():
    order = list(SOURCES[Mode.MODE_MANUAL])
    commands = dict(ALL)
    for source in order:
        assert choose(10.0, Mode.MODE_MANUAL, commands, "").source == source
        commands[source] = Velocity(10.0 - COMMAND_MAX_AGE - 0.01, 1.0, 0.0)
    assert choose(10.0, Mode.MODE_MANUAL, commands, "").source == ""


def test_an_old_command_means_stop_and_says_so():
    choice = choose(10.6, Mode.MODE_MISSION, ALL, "")
    assert (choice.linear, choice.angular) == (0.0, 0.0)
    assert choice.reason == "mode MISSION: no fresh command from planner"


def test_an_obstacle_beats_every_command():
    choice = choose(10.0, Mode.MODE_MANUAL, ALL, "disarmed")
    assert (choice.source, choice.linear, choice.reason) == ("", 0.0, "disarmed")
