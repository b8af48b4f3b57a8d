"""Whether a running service heeds its parameters: each field must be read in its steps, not only when it is made."""

import sys
from contextlib import contextmanager

import msgspec

TELLS = "told_params"  # the module that reads all of them, to publish them


def _watched(params, read):
    """The same set, which notes what is read of it and of its copies."""
    kind = type(params)

    class Watched(kind, frozen=True):
        def __getattribute__(self, name):
            if TELLS not in sys._getframe(1).f_code.co_filename:
                read.add(name)
            return kind.__getattribute__(self, name)

    return msgspec.convert(msgspec.to_builtins(params), Watched)


@contextmanager
def all_settable_are_read(service, besides=()):
    """Fails when the steps made inside leave a field unread that may be set while running; besides: those looked at elsewhere."""
    params, read = service.params, set()
    service.params = _watched(params, read)
    yield
    service.params = params
    settable = set(params.__struct_fields__) - service.fixed_params - set(besides)
    assert settable <= read, f"never read while running: {sorted(settable - read)}"
