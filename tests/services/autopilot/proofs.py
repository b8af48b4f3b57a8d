"""Which test shows which failsafe: begun by its real cause in a flight or drive in lockstep, and ended."""

import functools

from services.autopilot.air.failsafes.table import AIR_RULES
from services.autopilot.ground.failsafes import GROUND_RULES
from uvf.runtime.time.lockstep import Lockstep

RULES = {("air", rule.name): rule for rule in AIR_RULES} | {("ground", rule.name): rule for rule in GROUND_RULES}
SHOWN = set()


def shows(kind, *rows):
    """The test returns its run, with ``lockstep`` and ``events``: in these each row has to begin, and to end after that."""

    def mark(test):
        SHOWN.update((kind, row) for row in rows)

        @functools.wraps(test)
        def run(*args, **kwargs):
            trip = test(*args, **kwargs)
            assert isinstance(trip.lockstep, Lockstep), "simulated, not told"
            for row in rows:
                rule = RULES[kind, row]
                began = [t for t, m in trip.events if m.text == rule.raised_text]
                ended = [t for t, m in trip.events if m.text == rule.cleared_text]
                assert began and ended and ended[-1] > began[0], f"{row}: began {began}, ended {ended}"

        return run

    return mark
