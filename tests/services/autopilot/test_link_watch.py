"""Silence of the ground stations counts in wall time, from the first that was heard."""

import pytest

from schemas.messages import Link
from services.autopilot.link_watch import LinkWatch
from uvf.runtime.messages.convert import stamp


def link(t, stations=1, silence=0.5, rate=1.0):
    return Link(timestamp=stamp(t), stations=stations, silence=silence, rate=rate)


def silence_after(*steps):
    watch = LinkWatch()
    for t, told in steps:
        watch.step(t, told)
    return watch.silence


def test_nobody_is_lost_who_was_never_there():
    assert silence_after((1.0, None), (100.0, link(100.0, stations=0, silence=0.0))) == 0.0


def test_who_was_gone_before_the_vehicle_began_is_not_lost():
    assert silence_after((1.0, link(1.0, stations=0, silence=500.0))) == 0.0


def test_it_is_what_the_listener_counts():
    assert silence_after((1.0, link(1.0)), (5.0, link(5.0, stations=0, silence=4.5))) == pytest.approx(4.5)
    assert silence_after((1.0, link(1.0)), (5.0, link(5.0, stations=0, silence=4.5)), (6.0, link(6.0))) == pytest.approx(0.5)


@pytest.mark.parametrize("rate", [0.2, 1.0, 10.0, 50.0])
def test_between_two_words_time_goes_by_as_fast_as_on_the_wall(rate):
    """At 50 times a word comes each 25 s of simulation: no reason to believe that nobody is there."""
    begun = link(0.0, silence=0.8, rate=rate)
    assert silence_after((0.0, begun), (0.5 * rate, begun)) == pytest.approx(1.3)
    assert silence_after((0.0, begun), (0.5 * rate, None)) == pytest.approx(1.3)


def test_without_a_listener_it_counts_on():
    assert silence_after((1.0, link(1.0)), (11.0, None)) == pytest.approx(10.5)


def test_a_listener_that_has_just_begun_ends_no_silence():
    assert silence_after((1.0, link(1.0)), (9.0, link(9.0, stations=0, silence=0.0))) == pytest.approx(8.5)


def test_a_pause_costs_what_the_listener_says_and_no_more():
    paused = link(7.0, rate=0.0)
    assert silence_after((7.0, paused), (7.0, paused)) == pytest.approx(0.5)
    assert silence_after((7.0, paused), (7.0, link(7.0, stations=0, silence=60.0, rate=0.0))) == pytest.approx(60.0)
