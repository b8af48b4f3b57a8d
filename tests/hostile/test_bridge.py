"""The bridge between a hostile bus and hostile autopilots: it goes on, answers everybody, and what it says can be read.

For longer, and otherwise each time: ``UVF_HOSTILE_EXAMPLES=20000 python -m pytest tests/hostile/test_bridge.py -n0``.
"""

import os
import random

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from schemas import topics
from services.mavlink_bridge.commands import WAITING_MOST as COMMANDS_MOST
from services.mavlink_bridge.connection import PARTS_MOST, TEXTS_MOST
from services.mavlink_bridge.parameters import WAITING_MOST as PARAMETERS_MOST
from services.mavlink_bridge.station import AUTOPILOTS_MOST, RIVALS_MOST
from services.mavlink_bridge.transfers import WAITING_MOST as PLANS_MOST
from tests.hostile.bridge_storm import ANSWERS, ASKED, STEP, TOLD, Besieged, Liar

EXAMPLES = int(os.environ.get("UVF_HOSTILE_EXAMPLES", "0"))
STORM = settings(
    max_examples=EXAMPLES or 15, derandomize=not EXAMPLES, database=None, deadline=None, suppress_health_check=list(HealthCheck)
)
ACTIONS = st.lists(
    st.one_of(ASKED.map(lambda a: ("ask", *a)), TOLD.map(lambda s: ("say", *s)), TOLD.map(lambda s: ("say", *s))), max_size=25
)


def survives(bridge, actions, liar):
    for n, (what, *how) in enumerate(actions):
        getattr(bridge, what)(*how)
        if n % 3 == 0:
            bridge.run(STEP, liar)
    bridge.run(2.0, liar)
    bridge.run(4.0)
    sound = bridge.vehicles[0]._autopilot
    assert len(bridge.replies) == bridge.asked, "everybody is answered"
    assert all(
        request.reply.FromString(reply).reason for request, reply, _ in bridge.replies if not request.reply.FromString(reply).accepted
    )
    assert bridge.t - bridge.newest(topics.NAV_STATE)[0] < 0.5, "the sound vehicle is still told of"
    assert bridge.t - bridge.newest(topics.STATUS)[0] < 0.5
    assert len(bridge.station.autopilots) <= AUTOPILOTS_MOST
    assert all(len(known.rivals) <= RIVALS_MOST for known in bridge.station.autopilots.values())
    assert all(len(queue) <= COMMANDS_MOST for queue in sound.commands._queues.values())
    assert len(sound.parameters._wanted) <= PARAMETERS_MOST and len(sound.transfers._queue) <= PLANS_MOST
    assert len(sound.wire.texts) <= TEXTS_MOST and len(sound.wire._parts) <= PARTS_MOST


@pytest.mark.parametrize("is_ardupilot", [False, True], ids=["PX4", "ArduPilot"])
@given(actions=ACTIONS, seed=ANSWERS)
@STORM
def test_whatever_is_asked_and_told_the_bridge_goes_on(is_ardupilot, actions, seed):
    survives(Besieged(is_ardupilot), actions, Liar(random.Random(seed)))
