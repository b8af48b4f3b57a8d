"""Settings made over MAVLink, kept in a file of this machine: by the autopilot's own names, only what differs from the vehicle's file."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Protocol

from uvf.runtime.state.state_folder import write_private


class UnreadableStore(Exception):
    """A file of settings that is none; the text says what is wrong with it."""


class Store(Protocol):
    def load(self) -> dict[str, Any]:
        """Name -> value; empty if there are none. Raises Unreadable."""

    def save(self, settings: Mapping[str, Any]) -> None:
        """Whole or not at all. Raises OSError."""


class FileStore:
    def __init__(self, path: Path) -> None:
        self._path = path

    def load(self) -> dict[str, Any]:
        try:
            found = json.loads(self._path.read_bytes())
        except FileNotFoundError:
            return {}
        except OSError as error:
            raise UnreadableStore(f"{self._path.name}: {error.strerror}") from error
        except (ValueError, RecursionError) as error:
            raise UnreadableStore(f"{self._path.name} is broken") from error
        if not isinstance(found, dict):
            raise UnreadableStore(f"{self._path.name} holds no settings")
        return found

    def save(self, settings: Mapping[str, Any]) -> None:
        write_private(self._path, json.dumps(dict(settings), indent=1, sort_keys=True).encode() + b"\n")
