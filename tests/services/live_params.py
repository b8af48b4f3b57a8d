"""Whether a running service heeds its parameters: each field must be read in its steps, not only when it is made."""

from contextlib import contextmanager


class _Watched:
    """Stands in for a parameter set and notes what is read."""

    def __init__(self, params):
        self._params = params
        self.read = set()

    def __getattr__(self, name):
        self.read.add(name)
        return getattr(self._params, name)


@contextmanager
def all_settable_are_read(service):
    """Fails when the steps made inside leave a field unread that may be set while running."""
    watched = _Watched(service.params)
    service.params = watched
    yield
    service.params = watched._params
    settable = set(service.params.__struct_fields__) - service.fixed_params
    assert settable <= watched.read, f"never read while running: {sorted(settable - watched.read)}"
