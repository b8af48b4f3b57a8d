"""Messages that have arrived and wait for their reader."""

from collections import deque
from collections.abc import Callable
from typing import Generic, TypeVar

T = TypeVar("T")

BYTES_MOST = 256_000_000


class Backlog(Generic[T]):
    """A queue bounded in number and in bytes: the oldest messages go first. One thread pushes, another one takes; neither waits."""

    def __init__(self, depth: int, size_of: Callable[[T], int], bytes_most: int = BYTES_MOST) -> None:
        self._depth = depth
        self._size_of = size_of
        self._bytes_most = bytes_most
        self._messages: deque[T] = deque()
        # Each of these is written by one thread only.
        self._pushed = self._dropped = self._taken = 0

    def push(self, message: T) -> None:
        """Adds a message, and drops the oldest ones beyond the bounds."""
        self._messages.append(message)
        self._pushed += self._size_of(message)
        while len(self._messages) > self._depth or self._pushed - self._dropped - self._taken > self._bytes_most:
            oldest = self._pop()
            if oldest is None:
                return
            self._dropped += self._size_of(oldest)

    def take(self) -> T | None:
        """Removes and returns the oldest message; None without one."""
        message = self._pop()
        if message is not None:
            self._taken += self._size_of(message)
        return message

    def _pop(self) -> T | None:
        if not self._messages:  # the usual case, for which an exception would be dear
            return None
        try:
            return self._messages.popleft()
        except IndexError:
            return None
