"""Whatever a MAVLink client sends: no exception, tables with an end, one answer to each command, and a good station is served.

UVF_HOSTILE_EXAMPLES: how many bursts, 40 by default; ``python -m tests.hostile.mavlink_client 300`` goes on for five minutes.
"""

import os
import random

import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from tests.hostile.mavlink_client import KINDS, Hostile, framed, payload
from uvf.mavlink.codec import Codec

EXAMPLES = int(os.environ.get("UVF_HOSTILE_EXAMPLES", "40"))


@pytest.fixture(scope="module")
def client():
    """One flight for all of them: what one burst has left behind meets the next."""
    hostile = Hostile()
    hostile.fly(1.0)
    yield hostile
    hostile.end()


def test_the_dice_reach_every_message_of_the_dialect_with_all_its_fields():
    dice, codec = random.Random(1), Codec()
    for kind in KINDS:
        (message,) = codec.parse(framed(kind, payload(dice, kind), 255, 190))
        assert message.get_msgId() == kind.id
    assert codec.counts.received == len(KINDS) > 200


@settings(
    max_examples=EXAMPLES,
    deadline=None,
    phases=[Phase.explicit, Phase.generate],
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large, HealthCheck.function_scoped_fixture],
)
@given(st.randoms(use_true_random=False), st.integers(1, 30))
def test_nothing_stops_the_link_or_leaves_a_command_without_its_answer(client, dice, count):
    client.burst(dice, count)


@pytest.mark.parametrize("seed", range(4))
def test_neither_does_a_storm(client, seed):
    dice = random.Random(seed)
    for _ in range(EXAMPLES // 20):
        client.burst(dice, 300)
