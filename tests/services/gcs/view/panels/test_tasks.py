"""The tab Run shows how far the tasks of the mission are."""

import pytest

from schemas import topics
from schemas.messages import Tasks, TaskStatus
from services.gcs.actions.page import OpenTab
from tests.services.gcs.fakes import ME, Station


@pytest.fixture
def station():
    station = Station()
    station.press(OpenTab(ME, "run"), seconds=0.5)
    return station


def test_a_mission_without_tasks_shows_none(station):
    assert "g-tasks" not in station.page.now.html["run"]


def test_each_task_is_shown_with_its_state_its_depth_and_why(station):
    told = Tasks(
        tasks=[
            TaskStatus(name="meet", state=TaskStatus.RUNNING, since=3.0),
            TaskStatus(name="<b>go</b>", depth=1, state=TaskStatus.FAILED, reason="anne: walls & doors"),
            TaskStatus(name="later", depth=40),
        ]
    )
    station.script.put("sys", topics.TASKS, told, station.t)
    station.run(0.8)
    shown = station.page.now.html["run"]
    assert "0 of 3 done" in shown and "title='running, since 3 s'" in shown
    assert "&lt;b&gt;go&lt;/b&gt; <i>anne: walls &amp; doors</i>" in shown
    assert "--depth:1" in shown and "--depth:8" in shown and "--depth:40" not in shown
