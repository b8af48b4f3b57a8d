"""What a step puts out."""

from collections.abc import Mapping, Sequence

from google.protobuf.message import Message

Value = Message | Sequence[Message]
OutputMessages = Mapping[str, Value | Mapping[str, Value]]
"""Declared name -> a message, a list of them, or a dict of either by vehicle (services of the whole world)."""
