"""What takes long to find out, and is asked for again and again."""

from collections.abc import Callable
from typing import Generic, TypeVar

T = TypeVar("T")


class Remembered(Generic[T]):
    """One value, found out anew when what it was found from is another."""

    def __init__(self) -> None:
        self._of: tuple[object, ...] | None = None
        self._value: T

    def of(self, key: tuple[object, ...], find: Callable[[], T]) -> T:
        """The value for a key: numbers and text count as what they are, everything else as the object that it is."""
        if self._of is None or len(key) != len(self._of) or not all(_same(a, b) for a, b in zip(key, self._of, strict=True)):
            self._value = find()
            self._of = key
        return self._value


def _same(a: object, b: object) -> bool:
    return a is b or (isinstance(a, int | float | str) and a == b)
