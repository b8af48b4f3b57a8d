"""``uvf sim``: what it sends, and what it says when it is refused."""

import pytest
from typer.testing import CliRunner

from launch.cli import app
from launch.commands.live import sim as sim_cli
from schemas import topics
from schemas.messages import ClockRequest, Reply
from uvf.runtime.messages.convert import yaw_of


@pytest.fixture
def sent(monkeypatch):
    """What is asked, instead of asking it."""
    asked = []
    for way in ("_ask", "_ask_all"):
        monkeypatch.setattr(sim_cli, way, lambda message, *requests: asked.append((requests, message)))
    return asked


def sim(*words):
    return CliRunner().invoke(app, ["sim", *words])


def test_a_box_stands_on_the_floor(sent):
    assert sim("spawn", "crate", "box", "1", "2", "--size", "0.3,0.4,0.5", "--mass", "2").exit_code == 0
    ((request, message),) = sent
    assert request == (topics.SPAWN,)
    assert (message.object.shape, list(message.object.size), message.object.mass) == ("box", [0.3, 0.4, 0.5], 2.0)
    assert (message.object.pose.position.x, message.object.pose.position.y, message.object.pose.position.z) == (1.0, 2.0, 0.25)


def test_what_is_no_shape_is_a_vehicle(sent):
    assert sim("spawn", "guest", "burger", "1", "2", "--yaw", "0.5").exit_code == 0
    assert sent[0][0] == (topics.SPAWN, topics.AIR_SPAWN)
    assert sent[0][1].object.model == "burger"
    assert yaw_of(sent[0][1].object.pose.orientation) == pytest.approx(0.5)


@pytest.mark.parametrize(
    "words",
    [
        ("spawn", "guest", "burger", "-1.5", "-2"),
        ("pose", "burger", "-1.5", "-2", "--yaw", "-0.5"),
        ("fly", "milvus", "-1.5", "-2", "0.25", "--yaw", "-0.5"),
    ],
)
def test_a_place_may_lie_west_and_south_of_the_origin(sent, words):
    assert sim(*words).exit_code == 0
    message = sent[0][1]
    position = (message.object if words[0] == "spawn" else message).pose.position
    assert (position.x, position.y) == (-1.5, -2.0)


def test_a_mistyped_option_is_refused(sent):
    refused = sim("pose", "burger", "1", "2", "--jaw", "1")
    assert refused.exit_code == 2 and "--jaw" in refused.output and not sent


def test_too_few_sizes_are_refused_in_one_line(sent):
    refused = sim("spawn", "crate", "box", "1", "2", "--size", "0.3")
    assert refused.exit_code == 2 and not sent
    assert "--size '0.3': a box takes 3 numbers" in refused.output


@pytest.mark.parametrize("action", ["reset", "pause", "resume", "step"])
def test_time_is_asked_of_the_conductor(sent, action):
    assert sim(action).exit_code == 0
    assert sent == [((topics.CLOCK_REQUEST,), ClockRequest(action=action.upper()))]


@pytest.mark.parametrize(
    ("words", "requests"),
    [
        (("remove", "crate"), (topics.REMOVE, topics.AIR_REMOVE)),
        (("pose", "burger", "1", "2"), (topics.SET_POSE,)),
        (("fly", "bird", "1", "2", "3"), (topics.AIR_POSE,)),
        (("save", "here"), (topics.SAVE, topics.AIR_SAVE)),
        (("restore", "here"), (topics.RESTORE, topics.AIR_RESTORE)),
    ],
)
def test_each_word_asks_its_requests(sent, words, requests):
    assert sim(*words).exit_code == 0
    assert sent[0][0] == requests
    assert sent[0][1].name == words[1]


class Run:
    """Stands for a running system that answers each request in one way."""

    def __init__(self, answer):
        self._answer = answer

    def __enter__(self):
        return self

    def __exit__(self, *error):
        return None

    is_paused, time = False, 1.0

    def ask_together(self, owner, requests, message):
        return [self._answer(request, message) for request in requests]


def test_a_refusal_is_told_with_its_reason(monkeypatch):
    monkeypatch.setattr("uvf.client.connect", lambda: Run(lambda *_: Reply(reason="there is no 'crate'; there are: none")))
    refused = sim("remove", "crate")
    assert refused.exit_code == 1
    assert refused.output == "uvf: there is no 'crate'; there are: none\n"


def test_what_is_not_answered_while_time_stands_is_told_to_be_done_later(monkeypatch):
    def nothing(request, message):
        raise TimeoutError("no answer from uvf/sys/srv/sim/remove within 5 s")

    monkeypatch.setattr("uvf.client.connect", lambda: Run(nothing))
    late = sim("remove", "crate")
    assert late.exit_code == 2
    assert (
        late.output
        == "uvf: no answer from uvf/sys/srv/sim/remove within 5 s; while the clock is paused it is done, and answered, at the next step\n"
    )


def asked_of(monkeypatch, answer):
    """What ``answer`` was asked: request and whether it was only a question."""
    asked = []

    def told(request, message):
        asked.append((request, getattr(message, "only_ask", False)))
        return answer(request)

    monkeypatch.setattr("uvf.client.connect", lambda: Run(told))
    return asked


def test_a_state_that_one_simulator_lacks_is_restored_by_none(monkeypatch):
    asked = asked_of(monkeypatch, lambda request: Reply(accepted=request is topics.RESTORE, reason="no state 'here' in the air"))
    refused = sim("restore", "here")
    assert (refused.exit_code, refused.output) == (1, "uvf: no state 'here' in the air\n")
    assert asked == [(topics.RESTORE, True), (topics.AIR_RESTORE, True)]


def test_a_state_that_all_have_is_restored_by_all(monkeypatch):
    asked = asked_of(monkeypatch, lambda request: Reply(accepted=True))
    assert sim("restore", "here").exit_code == 0
    assert asked[2:] == [(topics.RESTORE, False), (topics.AIR_RESTORE, False)]


def test_without_aircraft_the_ground_alone_is_saved(monkeypatch):
    asked_of(monkeypatch, lambda request: Reply(accepted=True) if request is topics.SAVE else None)
    assert sim("save", "here").exit_code == 0


def test_what_one_simulator_takes_the_other_may_refuse(monkeypatch):
    asked_of(monkeypatch, lambda request: Reply(accepted=request is topics.AIR_SPAWN, reason="'milvus' is no ground vehicle"))
    assert sim("spawn", "guest", "milvus", "1", "2", "--z", "50").exit_code == 0


def test_where_no_simulator_runs_that_is_told(monkeypatch):
    asked_of(monkeypatch, lambda request: None)
    silent = sim("remove", "guest")
    assert (silent.exit_code, silent.output) == (2, "uvf: nobody answers uvf/sys/srv/sim/remove or uvf/sys/srv/air/remove\n")
