"""Loops as equations: against ones that can be worked out by hand, and poles on the right counted, dead times and all."""

import numpy as np
import pytest

from uvf.control.design.margins import margins, step_response
from uvf.control.design.signal_flow import SignalFlow

OMEGA = np.geomspace(0.004, 1000.0, 1200)
S = 1j * OMEGA


def flow(gain, delay=0.0, lag=0.0, pole=0.0):
    """x' = pole x + u; u = -gain x behind a lag and a dead time."""
    made = SignalFlow(OMEGA, ("x", "asked", "given"), ("gust",))
    made.opens("asked")
    made.integral("x", {"x": pole, "given": 1.0, "gust": 1.0})
    made.equal("asked", {"x": -gain})
    made.lag("given", lag, {"asked": made.dead_time(delay)})
    return made


def test_loop_and_responses_are_those_of_the_transfer_functions():
    made = flow(2.0, delay=0.1, lag=0.2)
    loop = 2.0 * np.exp(-0.1 * S) / (1 + 0.2 * S) / S
    assert np.allclose(made.loop("asked"), loop)
    assert np.allclose(made.response("x", "gust"), 1 / S / (1 + loop))
    assert np.allclose(made.closed("asked", "asked"), 1 / (1 + loop))


@pytest.mark.parametrize(
    ("gain", "delay", "lag", "pole", "unstable"),
    [
        (2.0, 0.0, 0.0, 0.0, 0),
        (-2.0, 0.0, 0.0, 0.0, 1),  # the wrong sign
        (2.0, 0.0, 0.1, 1.0, 0),  # unstable by itself, held
        (0.5, 0.0, 0.1, 1.0, 1),  # too little to hold it
        (15.0, 0.1, 0.0, 0.0, 0),
        (16.5, 0.1, 0.0, 0.0, 2),  # pi / 2 over the dead time is the end
        (80.0, 0.1, 0.0, 0.0, 4),
        (11.0, 0.0, 0.2, -10.0, 0),
    ],
)
def test_poles_on_the_right_are_counted(gain, delay, lag, pole, unstable):
    assert flow(gain, delay, lag, pole).unstable == unstable


@pytest.mark.parametrize(("slow", "unstable"), [((1e-3, 2e-4), 0), ((1e-3, -2e-4), 1), ((-1e-3, -2e-4), 2)])
def test_poles_slower_than_the_frequencies_are_counted_too(slow, unstable):
    made = SignalFlow(OMEGA, ("x", "y", "z"))
    for name, pole in zip("xy", slow, strict=True):
        made.integral(name, {name: -pole})
    made.integral("z", {"z": -2.0, "x": 1.0, "y": 1.0})
    assert made.unstable == unstable


def test_what_the_margins_say_is_where_it_becomes_unstable():
    found = margins(OMEGA, flow(2.0, delay=0.1, lag=0.2).loop("asked"))
    assert flow(2.0 * found.gain * 0.99, 0.1, 0.2).unstable == 0
    assert flow(2.0 * found.gain * 1.01, 0.1, 0.2).unstable == 2
    assert flow(2.0, 0.1 + 0.98 * found.delay, 0.2).unstable == 0
    assert flow(2.0, 0.1 + 1.02 * found.delay, 0.2).unstable == 2


def test_a_loop_that_needs_its_gain_has_a_margin_downwards():
    found = margins(OMEGA, flow(2.0, lag=0.1, pole=1.0).loop("asked"))
    assert found.gain == pytest.approx(0.5, rel=1e-2) and found.gain_db == pytest.approx(-6.0, abs=0.1)


def test_a_step_arrives_as_its_time_constant_says():
    t = np.array((0.0, 0.5, 1.0, 4.0))
    response = step_response(OMEGA, 1 / (1 + 0.5 * S), t)
    assert response == pytest.approx(1 - np.exp(-t / 0.5), abs=0.01)
