"""What the tests of a module share, until one of them fails: its second try has one of its own."""

import contextlib


class Shared:
    """``make()`` is a context manager; its value is made when it is first asked for, and anew for a second try."""

    def __init__(self, make):
        self._make, self._stack, self._value = make, contextlib.ExitStack(), None

    def for_test(self, request):
        if self._value is None or getattr(request.node, "execution_count", 1) > 1:
            self.close()
            self._value = self._stack.enter_context(self._make())
        return self._value

    def close(self):
        self._value = None
        self._stack.close()
