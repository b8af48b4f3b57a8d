"""Folders and files that exist in memory only."""

from collections.abc import Mapping


class FileTree:
    """A tree of files by absolute path, such as ``/etc/extras/x.json``. A path that goes up, or through an unknown folder, is not found."""

    def __init__(self, files: Mapping[str, bytes]) -> None:
        self._files = {_parts(path): content for path, content in files.items()}

    def content(self, path: str) -> bytes | None:
        """Content of a file, its path with or without the root's slash; None if there is none."""
        return self._files.get(_parts(path))

    def entries(self, path: str) -> list[bytes] | None:
        """Entries of a folder as MAVLink FTP lists them: ``D`` name or ``F`` name, tab, size, each with a NUL; None: no such folder."""
        folder = _parts(path)
        inside = {parts[len(folder) :]: content for parts, content in self._files.items() if parts[: len(folder)] == folder}
        if not inside or () in inside:
            return None
        folders = sorted({rest[0] for rest in inside if len(rest) > 1})
        files = sorted((rest[0], len(content)) for rest, content in inside.items() if len(rest) == 1)
        return [f"D{name}\0".encode() for name in folders] + [f"F{name}\t{size}\0".encode() for name, size in files]


def _parts(path: str) -> tuple[str, ...]:
    """``.`` and ``..`` are names as any other, which nothing has."""
    return tuple(part for part in path.split("/") if part)
