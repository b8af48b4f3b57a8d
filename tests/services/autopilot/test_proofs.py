"""Each row of both tables of failsafes has a test that triggers it by its real cause, in a simulation, and shows the recovery."""

import pytest

from tests.services.autopilot.air import test_long_loss, test_trouble
from tests.services.autopilot.ground import test_trouble as on_the_ground
from tests.services.autopilot.proofs import RULES, SHOWN


@pytest.mark.parametrize("row", RULES, ids="-".join)
def test_it_is_shown(row):
    assert {test_long_loss, test_trouble, on_the_ground}, "read, so that what they show is known"
    assert row in SHOWN, f"no test is marked @shows{row}"
