"""Settings made over MAVLink, kept in a file of this machine: by the autopilot's own names, only what differs from the vehicle's file."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Protocol

from uvf.runtime.state.state_folder import write_private


class UnreadableStore(Exception):
    """The file of settings cannot be read; the text says why."""


class Store(Protocol):
    """Where settings are kept."""

    def load(self) -> dict[str, Any]:
        """Settings by name; empty if there are none. Raises UnreadableStore."""

    def save(self, settings: Mapping[str, Any]) -> None:
        """Writes all settings atomically. Raises OSError."""


class FileStore:
    """Settings in a JSON file."""

    def __init__(self, path: Path) -> None:
        self._path = path

    def load(self) -> dict[str, Any]:
        """Settings by name; empty without a file. Raises UnreadableStore."""
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
        """Writes the file, readable by its owner only. Raises OSError."""
        write_private(self._path, json.dumps(dict(settings), indent=1, sort_keys=True).encode() + b"\n")
