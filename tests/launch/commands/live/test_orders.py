"""``uvf joints``: what it asks, and what it says when a word is wrong or the vehicle refuses."""

import pytest
from typer.testing import CliRunner

from launch.cli import app
from schemas import topics
from schemas.messages import JointTarget, Reply


class Run:
    """Stands for a running system whose vehicles answer in one way."""

    def __init__(self, reply):
        self.reply, self.asked = reply, []

    def __enter__(self):
        return self

    def __exit__(self, *error):
        return None

    def ask(self, vehicle, request, message):
        self.asked.append((vehicle, request, message))
        return self.reply


@pytest.fixture
def run(monkeypatch):
    made = Run(Reply(accepted=True))
    monkeypatch.setattr("uvf.client.connect", lambda: made)
    return made


def joints(*words):
    return CliRunner().invoke(app, ["joints", *words])


def test_each_word_is_a_joint_and_where_it_goes(run):
    assert joints("porter", "lift_joint=0.3", "pan_joint=-1.5").exit_code == 0
    ((vehicle, request, message),) = run.asked
    assert (vehicle, request) == ("porter", topics.MOVE_JOINTS)
    assert list(message.joints) == [JointTarget(name="lift_joint", position=0.3), JointTarget(name="pan_joint", position=-1.5)]


@pytest.mark.parametrize("word", ["lift_joint", "lift_joint=", "lift_joint=up"])
def test_a_word_that_is_no_place_is_refused_before_anything_is_asked(run, word):
    refused = joints("porter", "pan_joint=1", word)
    assert refused.exit_code == 2 and not run.asked
    assert f"'{word}': a joint and where it is to go, as lift_joint=0.3" in refused.output


def test_a_refusal_is_told_with_its_reason(run):
    run.reply = Reply(reason="lift_joint: 5 is beyond its range, 0 to 0.3")
    refused = joints("porter", "lift_joint=5")
    assert refused.exit_code == 1 and "beyond its range" in refused.output
