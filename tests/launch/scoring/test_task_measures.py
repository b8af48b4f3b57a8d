"""Measures of tasks: from what the executive tells while it goes on."""

from math import inf

from launch.scoring.task_measures import RecordedTask, RecordedTasks, done, time_taken
from schemas.messages import Tasks, TaskStatus


def tasks(*told):
    recorded = RecordedTasks({"go": RecordedTask(), "never": RecordedTask()})
    for t, state, since, whole in told:
        status = TaskStatus(name="go", state=state, since=since, reason="walls" if state == TaskStatus.FAILED else "")
        recorded.heard(t, Tasks(state=whole, tasks=[status, TaskStatus(name="other")]))
    return recorded


def test_the_time_of_a_task_is_that_from_its_beginning_to_its_end():
    told = tasks((1.0, TaskStatus.RUNNING, 0.9, TaskStatus.RUNNING), (7.0, TaskStatus.DONE, 6.9, TaskStatus.DONE))
    go = told.tasks["go"]
    assert (done(go).value, time_taken(go).value, time_taken(go).t) == (1.0, 6.0, 6.9)
    assert (told.state, told.ended) == (TaskStatus.DONE, 7.0)


def test_a_task_that_failed_has_no_time_but_a_reason():
    go = tasks((1.0, TaskStatus.RUNNING, 0.9, TaskStatus.RUNNING), (7.0, TaskStatus.FAILED, 6.9, TaskStatus.FAILED)).tasks["go"]
    assert (done(go).value, time_taken(go).value, time_taken(go).note, time_taken(go).t) == (0.0, inf, "walls", 6.9)


def test_a_task_that_never_began_says_so():
    never = tasks((1.0, TaskStatus.RUNNING, 0.9, TaskStatus.RUNNING)).tasks["never"]
    assert (done(never).value, time_taken(never).note) == (0.0, "not begun")
