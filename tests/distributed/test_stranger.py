"""A stranger on the bus, on UDP and on the page's socket of a system that runs, for thousands of messages."""

import pytest

from tests.hostile.live_storm import EVERY_KEY, storm_on

MESSAGES = 12_000
DECODING = ("autopilot", "planner", "slam", "sim_ground", "gcs", "mavlink")
"""Processes that each read enough of what the stranger writes."""
GROWTH_MOST = 600  # MB of any one process: none holds on to what it is sent

pytestmark = pytest.mark.timeout(400)


@pytest.mark.parametrize("mission", ["demo", "team"])
def test_a_stranger_stops_nothing_and_deafens_nobody(tmp_path, mission):
    with storm_on(tmp_path, mission) as storm:
        while storm.count < MESSAGES:
            storm.burst()
        storm.stop_all_works()
        storm.the_page_works()
        storm.time_goes_on()
        storm.nobody_has_died()
        refused = {name: health.malformed for name, health in storm.ear.health.items()}
        assert all(refused[name] > 100 for name in DECODING if name in refused) and refused.keys() >= {"autopilot", "mavlink", "gcs"}
        assert {why for _, why in storm.answers} <= {"refused", "refused as broken", "nobody is asked there"}
        grown = {name: round(now - storm.before[name]) for name, now in storm.megabytes().items()}
        assert max(grown.values()) < GROWTH_MOST, grown
        assert {key for _, key, _ in storm.sent} == EVERY_KEY
