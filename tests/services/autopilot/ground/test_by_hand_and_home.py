"""A rover that nobody drives any more, and its fence about home."""

import msgspec
import pytest

from schemas.messages import Breach, DriveCommand, Mode, ModeRequest
from tests.services.autopilot.ground.test_service import BODY, Bench
from uvf.runtime.messages.convert import stamp

MANUAL = [ModeRequest(mode=Mode.MODE_MANUAL)]


def driven(**params):
    bench = Bench()
    bench.service.params = msgspec.structs.replace(bench.service.params, **params)
    return bench.step(set_mode=MANUAL).step(30, linear=0.4, source="mavlink", pose=(3.0, 4.0))


@pytest.mark.parametrize(
    ("action", "mode", "armed"),
    [
        ("wait", Mode.MODE_MANUAL, True),
        ("hold", Mode.MODE_HOLD, True),
        ("return", Mode.MODE_RETURN, True),
        ("off", Mode.MODE_HOLD, False),
    ],
)
def test_without_sticks_it_stands_and_does_what_the_parameter_says(action, mode, armed):
    bench = driven(stick_action=action).step(70, pose=(3.0, 4.0))
    assert bench.speed == pytest.approx(0.0, abs=1e-6)
    assert (bench.said["status"].mode, bench.said["status"].armed) == (mode, armed)
    assert ("manual control lost" in bench.events) == (action != "wait")


@pytest.mark.parametrize(("timeout", "speed"), [(0.5, 0.0), (2.0, 0.4)])
def test_how_long_a_command_counts_is_a_parameter(timeout, speed):
    bench = driven(stick_timeout=timeout)
    last = DriveCommand(timestamp=stamp(bench.t), linear=0.4)
    bench.step(60, mavlink=last, pose=(3.0, 4.0))
    assert bench.speed == pytest.approx(speed, abs=1e-6)


def test_who_has_not_driven_yet_is_not_missed():
    bench = Bench()
    bench.service.params = msgspec.structs.replace(bench.service.params, stick_action="hold")
    bench.step(set_mode=MANUAL).step(200, pose=(3.0, 4.0))
    assert bench.said["status"].mode == Mode.MODE_MANUAL


@pytest.mark.parametrize(("action", "mode"), [("warn", Mode.MODE_MANUAL), ("hold", Mode.MODE_HOLD), ("return", Mode.MODE_RETURN)])
def test_before_the_fence_about_home_it_stops(action, mode):
    bench = driven(max_distance=1.0, fence_action=action)
    bench.step(40, linear=0.4, source="mavlink", pose=(3.0 + 1.0 - BODY.radius - 0.1, 4.0))
    assert bench.speed == pytest.approx(0.0, abs=1e-6)
    assert "fence ahead: stopped" in bench.events and bench.said["status"].mode == mode


def test_home_takes_its_fence_along_and_outside_of_it_is_told():
    bench = driven(max_distance=1.0).step(pose=(5.0, 4.0)).step(10, pose=(5.0, 4.0))
    assert (bench.said["status"].breach, bench.said["status"].breaches) == (Breach.BREACH_EDGE, 1)
    bench.service._engine.home = (5.0, 4.0)
    bench.step(10, pose=(5.0, 4.0))
    assert bench.said["status"].breach == Breach.BREACH_NONE
