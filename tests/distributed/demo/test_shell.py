"""Commands of the shell to the running demo: what is done, what is refused and why, by exit code and line."""

import re
import subprocess
import sys

import pytest

from uvf.models.scenario import ROOT


@pytest.fixture
def shell(system):
    """Runs ``uvf WORDS``; (exit code, what it says)."""

    def run(*words):
        command = [sys.executable, "-P", "-m", "launch.cli", *words]
        done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, env=system.environment, timeout=60, check=False)
        return done.returncode, (done.stdout + done.stderr).strip()

    return run


def test_a_rover_is_armed_sent_somewhere_and_called_back(shell):
    assert shell("mode", "burger", "hold") == (0, "burger: mode hold")
    assert shell("disarm", "burger") == (0, "burger: disarmed")
    assert shell("mode", "burger", "offboard")[0] == 1
    assert shell("arm", "burger") == (0, "burger: armed")
    assert shell("mode", "burger", "mission") == (0, "burger: mode mission")
    assert shell("goal", "burger", "2.6", "1.5") == (0, "burger: goes to (2.6, 1.5)")
    assert shell("cancel", "burger") == (0, "burger: its goal is cancelled")


@pytest.mark.parametrize(
    ("words", "code", "why"),
    [
        (("arm", "burgr"), 2, "no vehicle 'burgr' is running; did you mean 'burger'?"),
        (("mode", "burger", "hld"), 2, "no mode 'hld'; did you mean 'hold'?"),
        (("disarm", "milvus"), 1, "the aircraft is flying"),
        (("goal", "burger", "-500", "0"), 1, ""),
        (("param", "get", "burger", "speed"), 2, "write it as SERVICE.PARAMETER"),
        (("param", "get", "burger", "trackr.speed"), 2, "no service 'trackr'; did you mean 'tracker'?"),
        (("param", "set", "burger", "tracker.speed", "-0.3"), 1, "-0.3 is not above 0"),
        (("param", "list", "nobody"), 2, "no vehicle 'nobody' is running"),
    ],
)
def test_what_cannot_be_is_refused_with_the_reason(shell, words, code, why):
    got, said = shell(*words)
    assert got == code and why in said and said.startswith("uvf: ") and said.count("\n") == 0, said


def test_a_parameter_is_set_while_its_service_runs(shell):
    before = shell("param", "get", "burger", "tracker.speed")
    assert before[0] == 0
    assert shell("param", "set", "burger", "tracker.speed", "0.3") == (0, "tracker.speed = 0.3")
    code, listed = shell("param", "list", "burger", "tracker")
    assert code == 0 and re.search(r"^tracker\.speed = 0\.3 m/s  ", listed, re.MULTILINE)
    assert shell("param", "set", "burger", "tracker.speed", before[1])[0] == 0


def test_messages_are_sent(shell):
    assert shell("topic", "pub", "burger/cmd/client", "{linear: 0.1}", "-n", "3", "--rate", "10") == (0, "3 sent on uvf/burger/cmd/client")
