"""Tables that strangers fill: each has an end, and who counts least makes room."""

from collections.abc import Callable, MutableMapping
from typing import Any, TypeVar

K = TypeVar("K")


def make_room(table: MutableMapping[K, Any], key: K, most: int, rank: Callable[[K], Any]) -> None:
    """Removes the entries of lowest ``rank`` until ``key`` can be added to ``table`` without exceeding ``most``."""
    while key not in table and len(table) >= most:
        del table[min(table, key=rank)]
