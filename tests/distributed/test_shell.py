"""Commands of the shell to the demo, and examples that drive its rover from where it starts."""

import re
import subprocess
import sys
from contextlib import closing

import pytest

from tests.distributed.system import System
from tests.second_try import Shared
from uvf.models.scenario import ROOT


@pytest.fixture(scope="module")
def systems(tmp_path_factory):
    """Not the one that others share: of a ground station that has left, a vehicle holds within 5 s."""
    with closing(Shared(lambda: System(tmp_path_factory.mktemp("runs")))) as shared:
        yield shared


@pytest.fixture
def system(systems, request):
    return systems.for_test(request)


@pytest.fixture
def shell(system):
    """Runs ``uvf WORDS``; (exit code, what it says)."""

    return lambda *words: run(system, "-m", "launch.cli", *words)


def run(system, *words):
    """Runs Python with ``words`` beside the system; (exit code, what it says)."""
    command = [sys.executable, "-P", *words]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, env=system.environment, timeout=90, check=False)
    return done.returncode, (done.stdout + done.stderr).strip()


@pytest.mark.parametrize(("example", "expected"), [("08_waypoints", "at (2.2, 1.2) after"), ("09_waypoints_mavlink", "at (2.2, 1.2)")])
def test_a_program_outside_drives_through_waypoints(system, shell, example, expected):
    # It drives straight, and exploring the rover may have gone behind a wall: with the first try's system it stands where it starts.
    assert shell("mode", "burger", "hold")[0] == 0
    code, said = run(system, f"examples/{example}.py", "2.6,1.5", "2.2,1.2")
    assert code == 0, said
    assert expected in said


def test_a_rover_is_armed_sent_somewhere_and_called_back(shell):
    for words, code, expected in (
        ("mode burger hold", 0, "burger: mode hold"),
        ("disarm burger", 0, "burger: disarmed"),
        ("mode burger offboard", 1, ""),
        ("arm burger", 0, "burger: armed"),
        ("mode burger mission", 0, "burger: mode mission"),
        ("goal burger 2.6 1.5", 0, "burger: goes to (2.6, 1.5)"),
        ("cancel burger", 0, "burger: its goal is cancelled"),
    ):
        got, said = shell(*words.split())
        assert got == code, f"{words}: {said}"
        assert expected in said


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
