"""Return: its height follows the parameters; it comes down, waits and lands as they say, and no lower than it may."""

from dataclasses import replace as changed

import msgspec
import pytest

from services.autopilot.air.modes.return_mode import ReturnMode
from tests.services.autopilot.air.states import PARAMS, cruising
from uvf.guidance.route import Place

HOME = 10.0  # m
OVER = Place(0.0, 0.0, HOME + PARAMS.return_altitude)


def with_(**values):
    return msgspec.structs.replace(PARAMS, **values)


def flown(phase, params, seconds, height=None, north=PARAMS.hold_radius):
    """Flies on the circle, or so far off; at the height that is asked for unless another one is given."""
    for _ in range(round(seconds / 0.1)):
        asked = phase.step(cruising(north=north, height=phase.circle.centre.height if height is None else height), params, 0.1).asked
    return asked.height


def returning(lowest=-1e9, height=50.0):
    return ReturnMode(OVER, lowest, HOME, height)


def test_without_wishes_it_circles_at_the_height_of_return_for_ever():
    phase = returning()
    assert flown(phase, PARAMS, 300.0) == OVER.height
    assert phase.ended == "" and phase.circle.radius == PARAMS.hold_radius


def test_coming_from_above_it_does_not_sink_on_its_way():
    assert flown(returning(height=200.0), PARAMS, 1.0, north=2000.0) == 200.0


def test_another_height_or_radius_counts_at_once():
    phase = returning()
    flown(phase, PARAMS, 1.0)
    assert flown(phase, with_(return_altitude=90.0, hold_radius=150.0), 0.1) == HOME + 90.0
    assert phase.circle.radius == 150.0


@pytest.mark.parametrize(
    ("descend", "lowest", "least", "circles"),
    [(40.0, -1e9, 30.0, 50.0), (5.0, -1e9, 30.0, 30.0), (40.0, 62.0, 30.0, 62.0), (500.0, -1e9, 30.0, OVER.height)],
)
def test_over_home_it_comes_down_but_no_lower_than_it_may(descend, lowest, least, circles):
    phase, params = returning(lowest), with_(descend_alt=descend, min_altitude=least)
    assert flown(phase, params, 60.0, north=2000.0) == OVER.height
    assert flown(phase, params, 1.0) == circles


def test_it_lands_after_it_has_waited_at_that_height():
    phase, params = returning(), with_(descend_alt=40.0, land_delay=20.0)
    flown(phase, params, 60.0, north=2000.0)
    flown(phase, params, 60.0, height=OVER.height)
    assert phase.ended == "", "it is still above"
    flown(phase, params, 19.0)
    assert phase.ended == ""
    flown(phase, params, 1.5)
    assert phase.ended == "return: lands"


def test_a_height_that_somebody_asks_for_stays():
    phase = returning()
    flown(phase, PARAMS, 1.0)
    phase.circle = changed(phase.circle, centre=changed(phase.circle.centre, height=120.0))
    assert flown(phase, with_(descend_alt=40.0, return_altitude=90.0), 10.0) == 120.0
