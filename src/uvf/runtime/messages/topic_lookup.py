"""The table of topics and requests, looked up by full keys and by names of types."""

import functools
from collections.abc import Sequence
from typing import Any

from google.protobuf.message import Message

from schemas.topics import PREFIX, REQUESTS, TOPICS, Topic

KEY_MOST = 512
"""Characters of a key that any part of the system has to deal with; those of the table stay far below."""
REMEMBERED = 8192  # keys
_SAID = [t.message for t in TOPICS.values()] + [m for r in REQUESTS.values() for m in (r.message, r.reply)]
MESSAGES: dict[str, Any] = {message.DESCRIPTOR.full_name: message for message in _SAID}
"""Every type of the table, by its full name."""


Tree = dict[str, Any]
"""Parts of keys, each with what may follow; under the empty one, the line of the table."""


def _tree(lines: dict[str, Any]) -> Tree:
    tree: Tree = {}
    for line in lines.values():
        here = tree
        for part in line.by("*").at("*").split("/"):
            here = here.setdefault(part, {})
        here.setdefault("", line)
    return tree


def _find(tree: Tree, parts: Sequence[str]) -> Any:
    """The line whose key has these parts; a part as it is written goes before one that may be any."""
    if not parts:
        return tree.get("")
    for part in (parts[0] or "*", "*"):
        if part in tree and (found := _find(tree[part], parts[1:])) is not None:
            return found
    return None


_TOPICS, _REQUESTS = _tree(TOPICS), _tree(REQUESTS)


def full_key(key: str) -> str:
    """The key as it is on the bus, with the prefix that people leave out."""
    return key if key.startswith(f"{PREFIX}/") else f"{PREFIX}/{key}"


def topic_of(key: str) -> Topic[Message] | None:
    """Topic of the table that a key belongs to; None for requests, their replies and unknown keys."""
    return _topic_of(key) if len(key) <= KEY_MOST else None


@functools.lru_cache(REMEMBERED)
def _topic_of(key: str) -> Topic[Message] | None:
    found: Topic[Message] | None = _find(_TOPICS, key.split("/"))
    return found


def is_of_table(key: str, type_name: str) -> bool:
    """Whether a message of this type is what the table has for this key, as a topic or as one half of a request."""
    topic = topic_of(key)
    if topic is not None:
        return type_name == topic.message.DESCRIPTOR.full_name
    *asked, half = key.split("/")
    request = _find(_REQUESTS, asked) if half in ("request", "reply") else None
    if request is None:
        return False
    message = request.message if half == "request" else request.reply
    return bool(type_name == message.DESCRIPTOR.full_name)
