"""``uvf sim``: what it sends, and what it says when it is refused."""

import pytest
from typer.testing import CliRunner

from schemas import topics
from schemas.convert import yaw_of
from schemas.messages import ClockRequest, Reply
from uvf.launch import sim_cli
from uvf.launch.cli import app


@pytest.fixture
def sent(monkeypatch):
    """What is asked, instead of asking it."""
    asked = []
    monkeypatch.setattr(sim_cli, "_ask", lambda request, message: asked.append((request, message)))
    return asked


def sim(*words):
    return CliRunner().invoke(app, ["sim", *words])


def test_a_box_stands_on_the_floor(sent):
    assert sim("spawn", "crate", "box", "1", "2", "--size", "0.3,0.4,0.5", "--mass", "2").exit_code == 0
    ((request, message),) = sent
    assert request is topics.SPAWN
    assert (message.object.shape, list(message.object.size), message.object.mass) == ("box", [0.3, 0.4, 0.5], 2.0)
    assert (message.object.pose.position.x, message.object.pose.position.y, message.object.pose.position.z) == (1.0, 2.0, 0.25)


def test_what_is_no_shape_is_a_vehicle(sent):
    assert sim("spawn", "guest", "burger", "1", "2", "--yaw", "0.5").exit_code == 0
    assert sent[0][1].object.model == "burger"
    assert yaw_of(sent[0][1].object.pose.orientation) == pytest.approx(0.5)


def test_too_few_sizes_are_refused_in_one_line(sent):
    refused = sim("spawn", "crate", "box", "1", "2", "--size", "0.3")
    assert refused.exit_code == 2 and not sent
    assert "--size '0.3': a box takes 3 numbers" in refused.output


@pytest.mark.parametrize("action", ["reset", "pause", "resume", "step"])
def test_time_is_asked_of_the_conductor(sent, action):
    assert sim(action).exit_code == 0
    assert sent == [(topics.CLOCK_REQUEST, ClockRequest(action=action.upper()))]


@pytest.mark.parametrize(
    ("words", "request_"),
    [
        (("remove", "crate"), topics.REMOVE),
        (("pose", "burger", "1", "2"), topics.SET_POSE),
        (("save", "here"), topics.SAVE),
        (("restore", "here"), topics.RESTORE),
    ],
)
def test_each_word_asks_its_request(sent, words, request_):
    assert sim(*words).exit_code == 0
    assert sent[0][0] is request_
    assert sent[0][1].name == words[1]


def test_a_refusal_is_told_with_its_reason(monkeypatch):
    class Refusing:
        def __enter__(self):
            return self

        def __exit__(self, *error):
            return None

        def ask(self, owner, request, message):
            return Reply(accepted=False, reason="there is no 'crate'; there are: none")

    monkeypatch.setattr("uvf.client.connect", Refusing)
    refused = sim("remove", "crate")
    assert refused.exit_code == 1
    assert refused.output == "uvf: there is no 'crate'; there are: none\n"
