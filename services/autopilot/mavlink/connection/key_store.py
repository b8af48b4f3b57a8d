"""The signing keys that ground stations have given, kept across restarts in a file that only its owner reads."""

from dataclasses import dataclass
from pathlib import Path

import msgspec

from uvf.runtime.state.state_folder import write_private

KEY_BYTES = 32
MOST_KEYS = 16


class StoredKeys(msgspec.Struct, forbid_unknown_fields=True):
    """The content of the key file. keys: hexadecimal, the newest first; newest: timestamp below which no signature counts."""

    keys: list[str] = []
    newest: int = 0


@dataclass
class KeyStore:
    """The file of signing keys; path: None keeps nothing. Keys never appear in an error or a log."""

    path: Path | None = None

    def load(self) -> tuple[list[bytes], int]:
        """Keys, the newest first, and the newest timestamp. Raises ValueError, without its contents, for a file of another kind."""
        if self.path is None or not self.path.exists():
            return [], 0
        try:
            kept = msgspec.json.decode(self.path.read_bytes(), type=StoredKeys)
            keys = [bytes.fromhex(text) for text in kept.keys]
        except (msgspec.DecodeError, ValueError, OSError):
            keys = [b""]
        if any(len(key) != KEY_BYTES for key in keys):
            raise ValueError(f"{self.path}: not a file of signing keys; remove it, and set signing up again") from None
        return keys, kept.newest

    def save(self, keys: list[bytes], newest: int) -> None:
        """Writes keys and timestamp. Raises OSError."""
        if self.path is not None:
            write_private(self.path, msgspec.json.encode(StoredKeys([key.hex() for key in keys[:MOST_KEYS]], newest)))
