"""The Unmanned Vehicle Framework. ``uvf.connect()`` is the way in for your own programs."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from uvf.client import connect as connect


def __getattr__(name: str) -> Any:
    """Imports the client (and zenoh with it) only when it is asked for: the command line starts without."""
    if name == "connect":
        from uvf.client import connect

        return connect
    raise AttributeError(f"module 'uvf' has no attribute '{name}'")
