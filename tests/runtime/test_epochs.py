"""When time starts over: what was simulated is forgotten, what an operator has said is not."""

import pytest

from schemas import topics
from schemas.messages import ArmRequest, NavStatus
from tests.runtime.toys import Pilot
from uvf.runtime.bus.interface import LocalBus, Query, Sample
from uvf.runtime.contract.declaration import Input
from uvf.runtime.contract.inbox import OWNERS_MOST, InputBox
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.contract.service_runner import ServiceRunner

NS = 1_000_000_000


@pytest.fixture
def shell():
    made = ServiceRunner(ServiceInstance(Pilot, Pilot, "alpha"), LocalBus())
    made.join(1)
    return made


def put(shell, topic, message, t, epoch):
    sample = Sample(topic.at("alpha"), message.DESCRIPTOR.full_name, message.SerializeToString(), round(t * NS), 1, 7, epoch)
    for name, declared in shell.type.declared_inputs().items():
        if declared.topic.message is type(message) and name in shell._boxes:
            shell._boxes[name].push(sample)


def value(shell, name, t):
    shell._boxes[name].take(round(t * NS))
    return shell._boxes[name].value(round(t * NS))


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
    shell._desk.queue("arm", query)
    shell.restart(2)
    assert "time has started over" in refused[0]
    assert not shell._desk.waiting("arm")


def test_an_older_message_that_arrives_later_does_not_undo_a_newer_one(shell):
    put(shell, topics.NAV_STATUS, NavStatus(job="new"), 1.0, 1)
    assert value(shell, "goal", 1.5).job == "new"
    put(shell, topics.NAV_STATUS, NavStatus(job="old"), 0.5, 1)
    assert value(shell, "goal", 1.6).job == "new"


@pytest.mark.parametrize("epoch", (2, 3, 2**32 - 1))
def test_an_epoch_counts_only_from_the_clock(shell, epoch):
    """One message with a larger epoch used to deafen its input for the rest of the run."""
    put(shell, topics.NAV_STATUS, NavStatus(job="poison"), 0.5, epoch)
    put(shell, topics.NAV_STATUS, NavStatus(job="true"), 0.6, 1)
    assert value(shell, "goal", 1.0).job == "true"
    value(shell, "goal", 4.0)
    (line,) = shell._boxes["goal"].malformed()
    assert line == f"uvf/alpha/nav/status: of epoch {epoch}, which the clock has not begun"


def test_what_many_vehicles_send_before_the_clock_is_heard_of_is_all_kept_and_none_of_it_refused():
    box = InputBox(Input(topics.NAV_STATUS, each_vehicle=True, required=False), ageless=True, epoch=0)
    for owner in range(30):
        for seq in range(1, 21):
            payload = NavStatus(job=f"{seq}").SerializeToString()
            box.push(Sample(topics.NAV_STATUS.at(f"v{owner}"), "uvf.v1.NavStatus", payload, seq, seq, 7, 1))
    box.begin(1)
    box.take(NS)
    assert {message.job for message in box.value(NS).values()} == {"20"} and len(box.value(NS)) == 30
    assert box.malformed() == []


def test_a_flood_of_messages_ahead_of_the_clock_is_bounded_and_counted(shell):
    for n in range(1000):
        put(shell, topics.NAV_STATUS, NavStatus(), 0.001 * n, 2)
    value(shell, "goal", 1.0)
    value(shell, "goal", 4.0)
    assert len(shell._boxes["goal"].malformed()) == 1000
    assert not shell._boxes["goal"]._next


def test_what_is_stamped_far_ahead_is_refused_and_hides_nothing(shell):
    for n in range(300):
        put(shell, topics.NAV_STATUS, NavStatus(job="future"), 1e6 + n, 1)
    assert value(shell, "goal", 0.9) is None
    put(shell, topics.NAV_STATUS, NavStatus(job="true"), 0.95, 1)
    assert value(shell, "goal", 1.0).job == "true"
    assert len(shell._boxes["goal"].malformed()) == 256  # the older ones were pushed out by the newer


def test_a_flood_of_vehicles_is_bounded_and_strange_names_are_refused():
    box = InputBox(Input(topics.NAV_STATUS, each_vehicle=True, required=False), ageless=True, epoch=0)
    for owner in (*(f"v{n}" for n in range(1000)), "<img src=x>", "..", "Sys", "A" * 1000):
        box.push(Sample(topics.NAV_STATUS.at(owner), "uvf.v1.NavStatus", b"", 1, 1, 7, 0))
    box.take(NS)
    assert len(box.value(NS)) == OWNERS_MOST
    assert len(box.malformed()) == 1004 - OWNERS_MOST
