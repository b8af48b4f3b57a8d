"""Which items of a mission are told as reached: each once, with what is carried out in passing."""

from schemas.messages import MissionItem, MissionProgress
from services.autopilot.mavlink.missions.reached import ReachedItems

ACTIVE, COMPLETE, WAITING = MissionProgress.ACTIVE, MissionProgress.COMPLETE, MissionProgress.NOT_STARTED
PLAN = [MissionItem(kind=kind) for kind in ("SPEED", "TAKEOFF", "WAYPOINT", "TRIGGER", "WAYPOINT", "JUMP", "LAND", "TRIGGER")]


def told(*looks):
    """The items told by looks at (state, current, reached, laps)."""
    items = ReachedItems()
    return [list(items.look(MissionProgress(state=s, current=c, reached=r, laps=laps), PLAN)) for s, c, r, laps in looks]


def test_with_an_item_reached_comes_what_is_carried_out_after_it():
    assert told((WAITING, 0, -1, 0), (ACTIVE, 1, -1, 0), (ACTIVE, 2, 1, 0), (ACTIVE, 4, 2, 0)) == [[], [0], [1], [2, 3]]


def test_a_jump_is_told_with_the_item_before_it():
    assert told((ACTIVE, 4, 2, 0), (ACTIVE, 2, 4, 1), (ACTIVE, 4, 2, 1), (ACTIVE, 6, 4, 1)) == [[], [4, 5], [2, 3], [4, 5]]


def test_waypoints_passed_as_one_are_told_together():
    assert told((ACTIVE, 2, 1, 0), (ACTIVE, 6, 2, 0)) == [[], [2, 3, 4, 5]]


def test_two_that_are_reached_between_two_looks_are_both_told():
    assert told((ACTIVE, 2, 1, 0), (ACTIVE, 2, 4, 1)) == [[], [2, 3, 4, 5]]


def test_at_the_end_the_last_item_is_told_whatever_it_is():
    assert told((ACTIVE, 6, 4, 1), (COMPLETE, 7, 6, 1), (COMPLETE, 7, 6, 1)) == [[], [6, 7], []]


def test_what_was_reached_before_the_link_came_up_is_not_told():
    assert told((ACTIVE, 4, 2, 0), (ACTIVE, 4, 2, 0)) == [[], []]


def test_an_item_chosen_by_hand_is_not_reached():
    assert told((ACTIVE, 2, 1, 0), (ACTIVE, 6, 1, 0)) == [[], []]
