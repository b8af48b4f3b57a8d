"""Who holds: all orders in which two senders start, stop, fall silent and come back; and what is told of it."""

import pytest

from services.autopilot.multiplexing import OFFBOARD, SAME_WITHIN, Multiplexer, holder, in_turn

BOARD, CLIENT, MAVLINK = "offboard", "client", "mavlink"
TWO_EQUALS = (CLIENT, MAVLINK)


def heard(*phases):
    """Who holds in each phase, of which each names who is fresh in it."""
    multiplexer = Multiplexer("setpoints", OFFBOARD)
    return [multiplexer.pick(fresh) for fresh in phases]


@pytest.mark.parametrize(
    ("what", "phases", "holders"),
    [
        ("nobody", [()], [""]),
        ("one alone", [(CLIENT,)], [CLIENT]),
        ("one that stops", [(CLIENT,), ()], [CLIENT, ""]),
        ("one that comes back", [(CLIENT,), (), (CLIENT,)], [CLIENT, "", CLIENT]),
        ("equals: the first keeps it", [(CLIENT,), TWO_EQUALS, TWO_EQUALS], [CLIENT] * 3),
        ("equals: the first keeps it, the other way round", [(MAVLINK,), TWO_EQUALS, TWO_EQUALS], [MAVLINK] * 3),
        ("equals: the second stops", [(MAVLINK,), TWO_EQUALS, (MAVLINK,)], [MAVLINK] * 3),
        ("equals: the first stops", [(MAVLINK,), TWO_EQUALS, (CLIENT,)], [MAVLINK, MAVLINK, CLIENT]),
        ("equals: the first comes back", [(MAVLINK,), TWO_EQUALS, (CLIENT,), TWO_EQUALS], [MAVLINK, MAVLINK, CLIENT, CLIENT]),
        ("equals: one after the other", [(MAVLINK,), (CLIENT,), (MAVLINK,)], [MAVLINK, CLIENT, MAVLINK]),
        (
            "equals: both stop, the other one is first",
            [(MAVLINK,), TWO_EQUALS, (), (CLIENT,), TWO_EQUALS],
            [MAVLINK, MAVLINK, "", *[CLIENT] * 2],
        ),
        ("equals at the same time: the first of the table", [TWO_EQUALS], [CLIENT]),
        ("the higher one is first", [(BOARD,), (BOARD, CLIENT)], [BOARD] * 2),
        ("the higher one comes", [(CLIENT,), (BOARD, CLIENT)], [CLIENT, BOARD]),
        ("the higher one comes and goes", [(CLIENT,), (BOARD, CLIENT), (CLIENT,)], [CLIENT, BOARD, CLIENT]),
        ("the lower one goes meanwhile", [(CLIENT,), (BOARD, CLIENT), (BOARD,), ()], [CLIENT, BOARD, BOARD, ""]),
        ("the higher one goes, of two equals the first of the table", [(BOARD, *TWO_EQUALS), TWO_EQUALS], [BOARD, CLIENT]),
        ("a stranger", [("evil",), ("evil", CLIENT), ("evil",)], ["", CLIENT, ""]),
        ("a stranger by an empty name", [("",), (CLIENT, "")], ["", CLIENT]),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_who_holds(what, phases, holders):
    assert heard(*phases) == holders


def test_in_turn_the_first_always_wins_whoever_held():
    order = in_turn(("teleop", "mavlink"))
    assert holder(("teleop", "mavlink"), order, "mavlink") == "teleop"
    assert holder(("mavlink",), order, "teleop") == "mavlink"


def told(*phases, seconds=1.0):
    multiplexer, texts = Multiplexer("setpoints", OFFBOARD), []
    for n, fresh in enumerate(phases):
        multiplexer.pick(fresh)
        texts += multiplexer.news(n * seconds)
    return texts


def test_one_sender_is_no_news():
    assert told((CLIENT,), (CLIENT,), (), (CLIENT,)) == []


def test_a_hand_over_is_told_with_its_reason_and_who_waits_too():
    assert told((CLIENT,), (BOARD, CLIENT)) == [("setpoints from offboard, no longer from client", "offboard comes before client")]
    assert told((CLIENT,), (MAVLINK,)) == [("setpoints from mavlink, no longer from client", "client is silent")]
    assert told((CLIENT,), TWO_EQUALS) == [("setpoints of mavlink wait", "client was there first")]
    assert told((BOARD,), (BOARD, CLIENT)) == [("setpoints of client wait", "offboard comes before")]


def test_two_that_alternate_are_told_of_once_and_again_after_a_calm():
    to_and_fro = [(CLIENT,), (MAVLINK,)] * 50
    assert len(told(*to_and_fro, seconds=0.6)) == 2
    calm = [(MAVLINK,)] * round(SAME_WITHIN + 2)
    assert len(told(*[(CLIENT,), (MAVLINK,)], *calm, (CLIENT,), (MAVLINK,))) == 3
