"""Which item comes next: speeds and jumps are passed on the way."""

import pytest

from uvf.guidance.flight_plan import NO_JUMPS, ItemKind, PlanItem, following, next_stop
from uvf.guidance.route import Place

HERE = Place(0.0, 0.0, 60.0)


def waypoint():
    return PlanItem(ItemKind.WAYPOINT, HERE)


def jump(to, repeat):
    return PlanItem(ItemKind.JUMP, HERE, jump_to=to, repeat=repeat)


def visited(items, most=20):
    """The indices flown one after the other."""
    stop, seen = next_stop(items, 0, NO_JUMPS), []
    while stop.index is not None and len(seen) < most:
        seen.append(stop.index)
        stop = next_stop(items, stop.index + 1, stop.jumps)
    return seen


def test_items_follow_one_another_and_end():
    assert visited([waypoint(), waypoint()]) == [0, 1]


@pytest.mark.parametrize(("repeat", "rounds"), [(0, 1), (1, 2), (3, 4)])
def test_a_jump_is_taken_as_often_as_it_says(repeat, rounds):
    assert visited([waypoint(), waypoint(), jump(0, repeat)]) == [0, 1] * rounds


def test_a_negative_repeat_is_for_ever():
    assert visited([waypoint(), waypoint(), jump(0, -1)], most=20) == [0, 1] * 10


def test_after_its_repeats_a_jump_lets_the_mission_go_on():
    assert visited([waypoint(), jump(0, 1), waypoint()]) == [0, 0, 2]


def test_a_jump_counts_as_a_lap_when_it_is_taken():
    items = [waypoint(), jump(0, 1)]
    first = next_stop(items, 1, NO_JUMPS)
    assert (first.index, first.laps) == (0, 1)
    assert next_stop(items, 1, first.jumps).laps == 0


def test_looking_ahead_changes_nothing():
    jumps = {}
    next_stop([waypoint(), jump(0, 1)], 1, jumps)
    assert jumps == {}


def test_a_speed_is_passed_and_kept():
    stop = next_stop([PlanItem(ItemKind.SPEED, HERE, speed=22.0), waypoint()], 0, NO_JUMPS)
    assert (stop.index, stop.speed) == (1, 22.0)


def test_jumps_with_nothing_between_them_end_the_mission():
    assert next_stop([jump(1, -1), jump(0, -1)], 0, NO_JUMPS).index is None


def test_waypoints_at_one_place_are_passed_together():
    far = PlanItem(ItemKind.WAYPOINT, Place(500.0, 0.0, 60.0))
    items = [waypoint(), PlanItem(ItemKind.SPEED, HERE, speed=21.0), waypoint(), far, jump(0, 1)]
    stop = following(items, next_stop(items, 0, NO_JUMPS))
    assert (stop.index, stop.speed) == (3, 21.0)
    closed = [waypoint(), far, waypoint(), jump(0, -1)]
    last = following(closed, next_stop(closed, 2, NO_JUMPS))
    assert (last.index, last.laps) == (1, 1)


def test_a_course_is_asked_for_even_at_the_place_just_passed():
    items = [waypoint(), PlanItem(ItemKind.WAYPOINT, HERE, course=1.0)]
    assert following(items, next_stop(items, 0, NO_JUMPS)).index == 1


def test_triggers_are_passed_and_kept():
    items = [waypoint(), PlanItem(ItemKind.TRIGGER, HERE), PlanItem(ItemKind.TRIGGER_DISTANCE, HERE, distance=20.0), waypoint()]
    stop = next_stop(items, 1, NO_JUMPS)
    assert (stop.index, stop.deeds) == (3, (1, 2))


def test_home_is_set_and_marks_are_passed_on_the_way():
    items = [waypoint(), PlanItem(ItemKind.SET_HOME, HERE, here=True), PlanItem(ItemKind.LAND_START, HERE), waypoint()]
    stop = next_stop(items, 1, NO_JUMPS)
    assert (stop.index, stop.deeds) == (3, (1,))


def test_a_speed_of_0_is_cruise_again_and_none_is_unchanged():
    items = [PlanItem(ItemKind.SPEED, HERE, speed=22.0), PlanItem(ItemKind.SPEED, HERE), waypoint(), waypoint()]
    assert [next_stop(items, k, NO_JUMPS).speed for k in (0, 1, 2)] == [0.0, 0.0, None]
