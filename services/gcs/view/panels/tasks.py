"""The tasks of the mission as a list, indented by their place in the tree, with what each does now or why it has failed."""

from schemas.messages import Tasks, TaskStatus
from services.gcs.view.markup import Html, html, joined

SIGNS = {
    TaskStatus.WAITING: ("○", "idle", "waiting"),
    TaskStatus.RUNNING: ("▶", "warn", "running"),
    TaskStatus.DONE: ("✓", "good", "done"),
    TaskStatus.FAILED: ("✖", "bad", "failed"),
    TaskStatus.STOPPED: ("■", "idle", "stopped"),
}
DEEPEST = 8


def tasks_section(tasks: Tasks | None) -> Html:
    """The section of the tab Run; empty where the mission has no tasks."""
    if tasks is None or not tasks.tasks:
        return html("")
    done = sum(task.state == TaskStatus.DONE for task in tasks.tasks)
    rows = joined(_row(task) for task in tasks.tasks)
    return html("<h2 class='g-h'>Tasks<span>{} of {} done</span></h2><ol class='g-tasks'>{}</ol>", done, len(tasks.tasks), rows)


def _row(task: TaskStatus) -> Html:
    sign, style, word = SIGNS.get(task.state, SIGNS[TaskStatus.WAITING])
    since = f", since {task.since:.0f} s" if task.since else ""
    why = html("<i>{}</i>", task.reason) if task.reason else html("")
    depth = min(task.depth, DEEPEST)
    return html("<li class='g-{}' style='--depth:{}' title='{}{}'><b>{}</b> {} {}</li>", style, depth, word, since, sign, task.name, why)
