"""Files that are there whole or not at all."""

import os
from contextlib import suppress
from pathlib import Path

from uvf.models.yaml_data import BadInput


def write_whole(path: Path, content: bytes) -> None:
    """Writes a file beside and renames it, so that nobody ever reads half of it. Raises BadInput, and what was there stays."""
    part = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        part.write_bytes(content)
        part.replace(path)
    except OSError as error:
        with suppress(OSError):
            part.unlink(missing_ok=True)
        raise BadInput(f"{path}: cannot be written: {error.strerror}") from error
