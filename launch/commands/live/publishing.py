"""``uvf topic pub``: a message of a topic from its fields, sent at a steady rate."""

import time
from dataclasses import replace
from itertools import count as counter
from typing import Any

import typer
from google.protobuf.json_format import ParseDict, ParseError

from launch.commands.live.topic import known_topic
from schemas.topics import PREFIX, Topic
from uvf.client import Client
from uvf.models.yaml_data import BadInput, nearest, parse_yaml
from uvf.runtime.messages.topic_lookup import full_key


def message_of(key: str, fields: str) -> tuple[str, Topic[Any], Any]:
    """(owner, topic, message) of a key without wildcards and a message's fields (YAML). Raises BadInput."""
    topic = known_topic(key)
    if "*" in key:
        raise BadInput(f"no topic '{key}' in the table; * stands for many, a message is of one")
    data = parse_yaml(fields, "the message")
    if not isinstance(data, dict):
        raise BadInput(f"'{fields}' are no fields; write them as '{{linear: 0.1}}'")
    names = topic.message.DESCRIPTOR.fields_by_name
    for name in data:
        if name not in names:
            raise BadInput(f"{topic.message.DESCRIPTOR.name} has no field '{name}'; {nearest(str(name), names)}")
    try:
        message = ParseDict(data, topic.message())
    except ParseError as error:
        raise BadInput(f"{topic.message.DESCRIPTOR.name}: {' '.join(str(error).split())}") from error
    own = full_key(key).removeprefix(f"{PREFIX}/")
    return own.partition("/")[0], replace(topic, key=own), message


def publish(run: Client, owner: str, topic: Topic[Any], message: Any, rate: float, count: int) -> None:
    """Sends the message ``count`` times (0: until Ctrl-C), ``rate`` [1/s, wall] times a second, with the time of each moment."""
    run.wait(lambda: run.time > 0.0, 5.0, "the clock is not heard")
    try:
        for sent in counter(1):
            if message.DESCRIPTOR.fields_by_name.get("timestamp") is not None:
                message.ClearField("timestamp")
            run.send(owner, topic, message)
            if sent == count:
                break
            time.sleep(1.0 / rate)
    except KeyboardInterrupt:
        sent -= 1
    typer.echo(f"{sent} sent on {topic.at(owner)}")
