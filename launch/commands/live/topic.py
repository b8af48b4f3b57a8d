"""``uvf topic``: the table, and what is on the bus."""

import time
from collections import defaultdict
from collections.abc import Callable
from typing import Any

import typer
from google.protobuf.message import DecodeError
from google.protobuf.text_format import MessageToString

from schemas.topics import REQUESTS, TOPICS, Topic
from uvf.models.yaml_data import BadInput, nearest
from uvf.runtime.bus.address import router_from
from uvf.runtime.bus.interface import Sample, matches
from uvf.runtime.bus.zenoh_bus import ZenohBus
from uvf.runtime.messages.topic_lookup import full_key, topic_of

LOOK = 0.02  # s
LIVE_SECONDS = 2.0
DEPTH = 16_384


def list_table() -> None:
    """Prints one line for each topic and request of the table; keys are never cut."""
    width = max(len(key) for key in (*(t.key for t in TOPICS.values()), *(r.key for r in REQUESTS.values())))
    for topic in TOPICS.values():
        hz = f"{topic.hz:g} Hz" if topic.hz else "on change"
        typer.echo(f"{topic.key:{width}}  {topic.message.DESCRIPTOR.full_name:26}  {hz:9}  {topic.qos.value:8}  {topic.about}")
    for request in REQUESTS.values():
        types = f"{request.message.DESCRIPTOR.name} -> {request.reply.DESCRIPTOR.name}"
        typer.echo(f"{request.key:{width}}  {types:26}  {'request':19}  {request.about}")


def known_topic(key: str) -> Topic[Any]:
    """The topic of the table that a key as people write it belongs to. Raises BadInput."""
    topic = topic_of(full_key(key))
    if topic is None:
        known = [t.key.replace("<owner>", full_key(key).split("/")[1]) for t in TOPICS.values()]
        raise BadInput(f"no topic '{key}' in the table; {nearest(key, known)}")
    return topic


def _listen(key: str, heard: Callable[[Sample], None], go_on: Callable[[], bool]) -> None:
    with ZenohBus(router_from(), timeout=3.0) as bus:
        bus.subscribe_all(lambda sample: heard(sample) if matches(full_key(key), sample.key) else None, depth=DEPTH)
        try:
            while go_on():
                time.sleep(LOOK)
                bus.poll()
        except KeyboardInterrupt:
            return


def list_live() -> None:
    """Prints the keys heard within two seconds."""
    heard: dict[str, str] = {}
    end = time.monotonic() + LIVE_SECONDS
    _listen("**", lambda s: heard.update({s.key: s.type_name}), lambda: time.monotonic() < end)
    for key, type_name in sorted(heard.items()):
        typer.echo(f"{key}  {type_name}")


def echo(key: str, count: int) -> None:
    """Prints messages; ``count`` 0 = until Ctrl-C."""
    left = [count or -1]
    if "srv/" not in key and "**" not in key:
        known_topic(key)

    def heard(sample: Sample) -> None:
        if left[0] == 0:
            return
        left[0] -= 1
        typer.echo(sample_text(sample))

    _listen(key, heard, lambda: left[0] != 0)


def sample_text(sample: Sample) -> str:
    """A line with key, time and sequence number, then the message's fields, as text of several lines."""
    return f"--- {sample.key}  {sample.stamp_ns / 1e9:.3f} s  #{sample.seq}\n{_fields(sample)}"


def _fields(sample: Sample) -> str:
    topic = topic_of(sample.key)
    if topic is None:
        return f"{len(sample.payload)} bytes of {sample.type_name or 'unknown type'}"
    try:
        return MessageToString(topic.message.FromString(sample.payload)).rstrip()
    except DecodeError as error:
        return f"broken {sample.type_name}: {error}"


def rates(key: str, seconds: float) -> None:
    """Prints the message rate [1/s] by wall and by simulation time of every key that matches, counted over ``seconds`` [s, wall]."""
    stamps: defaultdict[str, list[int]] = defaultdict(list)
    end = time.monotonic() + seconds
    _listen(key, lambda s: stamps[s.key].append(s.stamp_ns), lambda: time.monotonic() < end)
    if not stamps:
        raise BadInput(f"nothing heard on {full_key(key)} within {seconds:g} s; 'uvf topic list --live' shows what there is")
    for name, seen in sorted(stamps.items()):
        simulated = (seen[-1] - seen[0]) / 1e9
        sim_rate = (len(seen) - 1) / simulated if simulated > 0 else 0.0
        typer.echo(f"{name}: {len(seen) / seconds:.1f} Hz by wall, {sim_rate:.1f} Hz by simulation time")


def info(key: str) -> None:
    """Prints the table's line of a key and its live endpoints."""
    topic = known_topic(key)
    typer.echo(f"{topic.key}: {topic.about}\ntype {topic.message.DESCRIPTOR.full_name}, {topic.hz:g} Hz, QoS {topic.qos.value}")
    with ZenohBus(router_from(), timeout=3.0) as bus:
        for token in bus.tokens("@ep/**"):
            _, owner, node, way, where, _ = token.split("/")
            if topic_of(where.replace("%", "/").replace("+", "*")) is topic:
                typer.echo(f"{'written' if way == 'pub' else 'read'} by {node} of {owner}")
