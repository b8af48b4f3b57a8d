"""A service that waits for an input is told of in the terminal, once."""

from launch.waits import PATIENCE, Waits
from schemas.messages import Health


class Desk:
    def __init__(self) -> None:
        self.now = 0.0
        self.lines: list[str] = []
        self.waits = Waits(self.lines.append, ("planner", "slam"), lambda: self.now)

    def hear(self, at: float, *missing: str) -> list[str]:
        self.now = at
        self.waits.hear(Health(service="planner", missing=list(missing)))
        said, self.lines[:] = list(self.lines), []
        return said


def test_a_wait_is_told_of_once_when_it_lasts() -> None:
    desk = Desk()
    assert desk.hear(0.0, "planner:map") == []
    assert desk.hear(PATIENCE / 2, "planner:map") == []
    (line,) = desk.hear(PATIENCE + 0.1, "planner:map")
    assert "planner: input 'map'" in line
    assert desk.hear(PATIENCE + 5.0, "planner:map") == []


def test_what_has_come_after_all_is_told_of_and_may_be_missed_anew() -> None:
    desk = Desk()
    desk.hear(0.0, "planner:map")
    desk.hear(10.0, "planner:map")
    assert desk.hear(11.0) == ["planner: input 'map' is there"]
    assert desk.hear(12.0, "planner:map") == []
    assert len(desk.hear(20.0, "planner:map")) == 1


def test_the_short_waits_of_the_start_are_passed_over() -> None:
    desk = Desk()
    desk.hear(0.0, "planner:map", "planner:pose")
    assert desk.hear(PATIENCE - 1.0, "planner:pose") == []
    assert desk.hear(PATIENCE + 1.0) == []


def test_one_process_does_not_answer_for_another() -> None:
    desk = Desk()
    desk.hear(0.0, "planner:map")
    desk.waits.hear(Health(service="slam", missing=[]))
    assert len(desk.hear(PATIENCE + 0.1, "planner:map")) == 1


def test_who_is_no_process_of_the_run_is_not_heard() -> None:
    desk = Desk()
    for at in (0.0, PATIENCE + 1.0):
        desk.now = at
        desk.waits.hear(Health(service="stranger", missing=["stranger:everything"]))
    assert desk.lines == []
