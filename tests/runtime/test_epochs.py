"""When time starts over: what was simulated is forgotten, what an operator has said is not."""

import pytest

from schemas import topics
from schemas.messages import ArmRequest, NavStatus, StopCommand
from tests.runtime.toys import Pilot
from uvf.runtime.bus import LocalBus, Query, Sample
from uvf.runtime.shell import Shell
from uvf.runtime.site import Host

NS = 1_000_000_000


@pytest.fixture
def shell():
    made = Shell(Host(Pilot, Pilot, "alpha"), LocalBus())
    made.join(1)
    return made


def put(shell, topic, message, t, epoch):
    sample = Sample(topic.at("alpha"), message.DESCRIPTOR.full_name, message.SerializeToString(), round(t * NS), 1, 7, epoch)
    for name, declared in shell.type.declared_inputs().items():
        if declared.topic.message is type(message):
            shell._boxes[name].push(sample)


def value(shell, name, t):
    shell._boxes[name].take(round(t * NS))
    return shell._boxes[name].value(round(t * NS))


def test_a_stop_holds_on(shell):
    put(shell, topics.STOP.by("gcs"), StopCommand(engaged=True), 100.0, 1)
    assert value(shell, "stop", 101.0).engaged
    shell.restart(2)
    assert value(shell, "stop", 0.02).engaged


def test_a_release_in_the_new_epoch_comes_after_a_stop_of_the_old(shell):
    put(shell, topics.STOP.by("gcs"), StopCommand(engaged=True), 100.0, 1)
    shell.restart(2)
    put(shell, topics.STOP.by("gcs"), StopCommand(engaged=False), 5.0, 2)
    assert not value(shell, "stop", 6.0).engaged


def test_a_stop_said_before_that_arrives_later_is_heard_at_once(shell):
    shell.restart(2)
    put(shell, topics.STOP.by("gcs"), StopCommand(engaged=True), 100.0, 1)
    assert value(shell, "stop", 0.02).engaged


def test_what_was_simulated_is_forgotten_and_late_messages_of_it_dropped(shell):
    put(shell, topics.NAV_STATUS, NavStatus(job="old"), 0.5, 1)
    shell.restart(2)
    put(shell, topics.NAV_STATUS, NavStatus(job="late"), 0.6, 1)
    assert value(shell, "goal", 1.0) is None


def test_what_the_new_epoch_has_sent_before_the_clock_told_of_it_is_kept(shell):
    put(shell, topics.NAV_STATUS, NavStatus(job="new"), 0.01, 2)
    shell.restart(2)
    assert value(shell, "goal", 0.02).job == "new"


def test_what_was_asked_before_is_refused_and_never_done_later(shell):
    refused = []
    query = Query(
        "uvf/alpha/srv/arm", ArmRequest(arm=True).SerializeToString(), 100 * NS, lambda *a: pytest.fail("answered"), refused.append
    )
    shell._queue("arm", query)
    shell.restart(2)
    assert "time has started over" in refused[0]
    assert not shell._queries["arm"]


def test_an_older_word_that_arrives_later_does_not_undo_a_newer_one(shell):
    put(shell, topics.STOP.by("gcs"), StopCommand(engaged=True), 7.0, 1)
    assert value(shell, "stop", 8.0).engaged
    put(shell, topics.STOP.by("gcs"), StopCommand(engaged=False), 0.0, 1)
    assert value(shell, "stop", 9.0).engaged
