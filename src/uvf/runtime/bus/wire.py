"""From bytes on the bus to messages: whoever decodes says what was wrong instead of failing."""

from collections.abc import Callable
from typing import Any, TypeVar

from google.protobuf.message import DecodeError, Message

from schemas.limits import size_of
from schemas.topics import Topic
from uvf.runtime.bus.interface import Sample, Sink
from uvf.runtime.messages.validation import error_in, escaped

TYPE_SHOWN = 60  # letters

M = TypeVar("M", bound=Message)


class Malformed(Exception):
    """Bytes that are not what the table says; the text names key and type."""


def decode(key: str, payload: bytes, type_: type[M]) -> M:
    """Message of this type in the bytes on ``key``. Raises Malformed, also for what is beyond the limits of the schema."""
    if len(payload) > size_of(type_):
        raise Malformed(f"{key}: {len(payload)} bytes, {size_of(type_)} are the most for {type_.DESCRIPTOR.full_name}")
    try:
        message = type_.FromString(payload)
    except DecodeError as error:
        raise Malformed(f"{key}: broken {type_.DESCRIPTOR.full_name}: {error}") from error
    if why := error_in(message):
        raise Malformed(f"{key}: broken {type_.DESCRIPTOR.full_name}: {why}")
    return message


def decode_sample(sample: Sample, type_: type[M]) -> M:
    """Message in a sample. Raises Malformed, also where the sample is of another type."""
    name = type_.DESCRIPTOR.full_name
    if sample.type_name != name:
        raise Malformed(f"{sample.key}: {escaped(sample.type_name[:TYPE_SHOWN]) or 'untyped bytes'} where {name} is due")
    return decode(sample.key, sample.payload, type_)


def guarded(topic: Topic[Any], heard: Callable[[Any, Sample], None], warn: Callable[[str], None]) -> Sink:
    """A sink that hands decoded messages to ``heard`` and tells ``warn`` of those that cannot be decoded."""

    def sink(sample: Sample) -> None:
        try:
            message = decode_sample(sample, topic.message)
        except Malformed as error:
            warn(str(error))
            return
        heard(message, sample)

    return sink
