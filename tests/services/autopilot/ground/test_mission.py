"""The mission engine: order, holding, jumps, speeds, pauses, and what is refused."""

import pytest

from schemas.messages import MissionItem, MissionProgress, Vector3
from services.autopilot.ground.mission import MissionEngine, mission_of, refusal
from uvf.runtime.messages.convert import stamp

HOME = (9.0, 9.0)


def waypoint(x, y=0.0, **fields):
    return MissionItem(position=Vector3(x=x, y=y), **fields)


def engine(*items):
    made = MissionEngine(HOME, 0.25)
    made.load(mission_of(items, stamp(0.0)))
    return made


def visit(made, steps):
    """Puts the vehicle on each target in turn; the targets."""
    seen = []
    for i in range(steps):
        target = made.target
        if target is None:
            break
        seen.append(target)
        made.advance(float(i), target, True)
    return seen


def test_waypoints_are_visited_in_order_and_then_it_is_complete():
    made = engine(waypoint(1.0), waypoint(2.0), MissionItem(kind=MissionItem.RETURN))
    assert visit(made, 9) == [(1.0, 0.0), (2.0, 0.0), HOME]
    assert made.progress(stamp(9.0)).state == MissionProgress.COMPLETE
    assert made.reached == 2


def test_an_item_counts_only_within_its_radius():
    made = engine(waypoint(1.0), waypoint(2.0, acceptance_radius=0.05))
    assert made.advance(0.0, (0.7, 0.0), True) is None
    assert made.advance(0.1, (0.8, 0.0), True) == 0
    assert made.advance(0.2, (1.9, 0.0), True) is None
    assert made.advance(0.3, (1.96, 0.0), True) == 1


def test_holds_at_a_waypoint_for_its_time():
    made = engine(waypoint(1.0, hold=2.0), waypoint(5.0))
    assert made.advance(10.0, (1.0, 0.0), True) is None
    assert made.advance(11.9, (1.0, 0.0), True) is None
    assert made.advance(12.0, (1.0, 0.0), True) == 0


def test_a_jump_is_taken_as_often_as_it_says():
    made = engine(waypoint(1.0), waypoint(2.0), MissionItem(kind=MissionItem.JUMP, jump_to=0, repeat=2))
    assert [x for x, _ in visit(made, 20)] == [1.0, 2.0] * 3
    assert made.laps == 2


def test_a_jump_without_end_goes_round_for_ever():
    made = engine(waypoint(1.0), waypoint(2.0), MissionItem(kind=MissionItem.JUMP, jump_to=0, repeat=-1))
    assert len(visit(made, 50)) == 50


def test_a_ring_of_jumps_alone_ends():
    ring = [MissionItem(kind=MissionItem.JUMP, jump_to=2, repeat=-1), MissionItem(kind=MissionItem.JUMP, jump_to=1, repeat=-1)]
    made = engine(waypoint(1.0), *ring)
    assert visit(made, 5) == [(1.0, 0.0)]
    assert made.state == MissionProgress.COMPLETE


def test_a_change_of_speed_counts_from_there_on():
    made = engine(waypoint(1.0), MissionItem(kind=MissionItem.SPEED, speed=0.2), waypoint(2.0))
    assert made.speed == 0.0
    made.advance(0.0, (1.0, 0.0), True)
    assert made.speed == 0.2


def test_pauses_while_another_mode_drives():
    made = engine(waypoint(1.0), waypoint(2.0))
    made.advance(0.0, (0.0, 0.0), True)
    assert made.advance(1.0, (1.0, 0.0), False) is None
    assert (made.state, made.current) == (MissionProgress.PAUSED, 0)


def test_without_a_pose_nothing_is_reached():
    made = engine(waypoint(0.0))
    assert made.advance(0.0, None, True) is None
    assert made.state == MissionProgress.ACTIVE


def test_jumping_to_an_item_restarts_a_finished_mission():
    made = engine(waypoint(1.0), waypoint(2.0))
    visit(made, 5)
    assert made.jump_to(1) == ""
    assert made.target == (2.0, 0.0)
    assert made.jump_to(2) == "there is no item 2; the mission has 2"


def test_another_engine_goes_on_where_the_first_one_was():
    first = engine(waypoint(1.0), MissionItem(kind=MissionItem.SPEED, speed=0.2), waypoint(2.0), waypoint(3.0))
    visit(first, 2)
    second = engine()
    second.resume(first.mission, first.progress(stamp(3.0)))
    assert (second.target, second.reached, second.speed, second.state) == ((3.0, 0.0), 2, 0.2, MissionProgress.ACTIVE)


def test_progress_in_another_mission_is_not_taken_over():
    second = engine()
    second.resume(mission_of([waypoint(5.0)], stamp(0.0)), MissionProgress(mission_id=1, current=0, state=MissionProgress.COMPLETE))
    assert (second.target, second.state) == ((5.0, 0.0), MissionProgress.NOT_STARTED)


def test_what_a_ground_vehicle_cannot_do_is_refused():
    assert refusal([waypoint(1.0), MissionItem(kind=MissionItem.ORBIT)]) == "item 1: ORBIT is not for a ground vehicle"
    assert refusal([waypoint(1.0), MissionItem(kind=MissionItem.JUMP, jump_to=7)]) == "item 1: jump to 7, but the last item is 1"
    assert refusal([MissionItem(kind=MissionItem.SPEED)]) == "there is no waypoint in it"
    assert refusal([]) == ""


@pytest.mark.parametrize("wrong", [float("nan"), float("inf"), float("-inf")])
def test_numbers_that_are_not_finite_are_refused_with_the_item(wrong):
    items = [
        waypoint(wrong),
        waypoint(1.0, y=wrong),
        MissionItem(position=Vector3(z=wrong)),
        waypoint(1.0, acceptance_radius=wrong),
        waypoint(1.0, hold=wrong),
        MissionItem(kind=MissionItem.SPEED, speed=wrong),
    ]
    names = ("x", "y", "z", "acceptance_radius", "hold", "speed")
    for name, item in zip(names, items, strict=True):
        assert refusal([waypoint(0.0), item]).startswith(f"item 1: {name} is {wrong:g}; it must be finite")


def test_negative_speeds_times_and_radii_are_refused():
    slow = MissionItem(kind=MissionItem.SPEED, speed=-0.2)
    assert refusal([waypoint(1.0), slow]) == "item 1: speed is -0.2; it must be finite and not negative"
    assert refusal([waypoint(1.0, hold=-1.0)]) == "item 0: hold is -1; it must be finite and not negative"
    assert refusal([waypoint(1.0, acceptance_radius=-1.0)]) == "item 0: acceptance_radius is -1; it must be finite and not negative"


def test_an_item_of_a_kind_nobody_knows_is_refused():
    strange = MissionItem.FromString(bytes((0x08, 99)))
    assert refusal([waypoint(1.0), strange]) == "item 1: kind 99 is not for a ground vehicle"


@pytest.mark.parametrize("wrong", [{"x": float("nan")}, {"x": 1.0, "acceptance_radius": float("nan")}])
def test_a_waypoint_that_is_no_number_is_never_reached(wrong):
    made = engine(waypoint(**wrong))
    assert [made.advance(float(i), (1.0, 0.0), True) for i in range(5)] == [None] * 5


def test_missions_differ_by_their_id():
    assert mission_of([], stamp(0.0)).id == 0
    assert mission_of([waypoint(1.0)], stamp(0.0)).id != mission_of([waypoint(2.0)], stamp(0.0)).id
