"""The page lives through whatever is within the limits of the schema, however senseless."""

import os

import pytest

from schemas import topics
from tests.hostile.bus_client import Stranger
from tests.services.gcs.fakes import Station

ROUNDS = int(os.environ.get("UVF_HOSTILE_EXAMPLES", "40"))
A_ROUND = 25
LARGEST = 1e11


def beset(shell, stranger, rounds, step):
    """Messages on everything that a service reads, some sound and senseless, some not sound."""
    read = [declared.topic for _, declared, _ in shell.reads()]
    for n in range(rounds):
        for _ in range(A_ROUND):
            topic = stranger.random.choice(read)
            if stranger.random.random() < 0.3:
                sample = stranger.sample(topic, n)
            else:
                sample = stranger._made("senseless", topic, stranger.sound(topic.message), n)
            for name, declared in shell.type.declared_inputs().items():
                if declared.topic == topic and name in shell._boxes:
                    shell._boxes[name].push(sample)
        step()


@pytest.mark.parametrize("seed", [1, 2])
def test_the_page_lives(seed):
    station = Station()
    stranger = Stranger(seed, ("burger", "milvus"), LARGEST)
    beset(station.shell, stranger, ROUNDS, lambda: station.run(0.05, silent=True))
    before = len(station.page.pictures)
    station.run(0.5)
    assert len(station.page.pictures) > before
    assert station.shell.counters.malformed > 10


def test_every_topic_of_the_table_is_spoken_to():
    stranger = Stranger(1, ("burger",))
    for topic in topics.TOPICS.values():
        for _ in range(20):
            assert stranger.sample(topic, 0).key.startswith("uvf/")
