"""Files that are made for engines which read nothing but files: in one folder of the user's, named by their content."""

import hashlib
import os
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def handed_file(stem: str, suffix: str, content: bytes) -> Path:
    """Path of a file with this content; written once, whole or not at all, however many processes ask for it."""
    folder = Path(tempfile.gettempdir()) / f"uvf-files-{os.getuid()}"
    folder.mkdir(mode=0o700, exist_ok=True)
    target = folder / f"{stem}-{hashlib.sha256(content).hexdigest()[:16]}{suffix}"
    if not target.is_file():
        part = target.with_suffix(f".{os.getpid()}")
        part.write_bytes(content)
        part.replace(target)
    return target


def mesh_file(stem: str, vertices: Floats, faces: NDArray[Any]) -> Path:
    """Path of an STL file with these vertices (n, 3) [m] and faces (m, 3)."""
    # Takes a second to import: an autopilot that is started again in flight needs no meshes.
    import trimesh

    content = trimesh.Trimesh(vertices, faces, process=False).export(file_type="stl")
    assert isinstance(content, bytes)
    return handed_file(stem, ".stl", content)
