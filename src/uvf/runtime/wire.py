"""From bytes on the bus to messages: whoever decodes says what was wrong instead of failing."""

from collections.abc import Callable
from typing import Any, TypeVar

from google.protobuf.message import DecodeError, Message

from schemas.topics import Topic
from uvf.runtime.bus import Sample, Sink
from uvf.runtime.soundness import fault

M = TypeVar("M", bound=Message)


class Malformed(Exception):
    """Bytes that are not what the table says; the text names key and type."""


def decode(key: str, payload: bytes, type_: type[M]) -> M:
    """Raises Malformed, also for numbers that no service can work with."""
    try:
        message = type_.FromString(payload)
    except DecodeError as error:
        raise Malformed(f"{key}: broken {type_.DESCRIPTOR.full_name}: {error}") from error
    if why := fault(message):
        raise Malformed(f"{key}: broken {type_.DESCRIPTOR.full_name}: {why}")
    return message


def decode_sample(sample: Sample, type_: type[M]) -> M:
    """Raises Malformed, also for another type than the one that is due."""
    name = type_.DESCRIPTOR.full_name
    if sample.type_name != name:
        raise Malformed(f"{sample.key}: {sample.type_name or 'untyped bytes'} where {name} is due")
    return decode(sample.key, sample.payload, type_)


def guarded(topic: Topic[Any], heard: Callable[[Any, Sample], None], warn: Callable[[str], None]) -> Sink:
    """A sink that hands over decoded messages and tells of the others."""

    def sink(sample: Sample) -> None:
        try:
            message = decode_sample(sample, topic.message)
        except Malformed as error:
            warn(str(error))
            return
        heard(message, sample)

    return sink
