"""A mission that an aircraft cannot fly ends in one line before the start."""

import math

import pytest

from services.autopilot.air.build import hosts
from tests.services.autopilot.air.test_flight import site
from uvf.models.mission.file import JobFile, Waypoint
from uvf.models.yaml_data import BadInput


@pytest.mark.parametrize(
    ("waypoint", "why"),
    [
        (Waypoint(x=math.nan, y=0.0, z=60.0), "item 0 holds a number that is not finite"),
        (Waypoint(kind="jump", jump_to=4), "item 0 jumps to 4, but there are 1 items"),
        (Waypoint(kind="orbit", radius=20.0, z=60.0), "item 0 is a circle of 20 m, too tight at 25 m/s: give at least 37 m"),
    ],
)
def test_a_mission_that_cannot_be_flown_is_refused_with_its_file_and_vehicle(waypoint, why):
    with pytest.raises(BadInput, match=f"none.yaml: milvus: job: mission: {why}"):
        hosts(site(job=JobFile(mission=[waypoint])))
