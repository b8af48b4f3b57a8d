"""Meshes with a picture laid over them: an OBJ file, its MTL file, and the picture that this names."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
import trimesh
from numpy.typing import NDArray
from PIL import Image

from uvf.maths.rotations import matrix
from uvf.models.shapes.solid import Solid

Floats = NDArray[np.float64]
LARGEST = 512  # px a side
UNREADABLE = (OSError, ValueError, KeyError, IndexError, TypeError, AttributeError, AssertionError, Image.DecompressionBombError)


@dataclass(frozen=True, eq=False)
class TexturedMesh:
    """vertices (n, 3) in the file's own units, faces (m, 3), uv (n, 2) of the picture, v up, beyond 0 to 1 repeated; picture: RGB."""

    vertices: Floats
    faces: NDArray[np.int64]
    uv: Floats
    picture: Any


@lru_cache(maxsize=256)
def load_textured(path: Path) -> TexturedMesh | None:
    """The mesh of an OBJ file; None where it has no picture, or none that can be read: then its plain colour is all there is."""
    if path.suffix.lower() != ".obj":
        return None
    try:
        mesh: Any = trimesh.load(path, process=False, force="mesh")
        picture = getattr(getattr(mesh.visual, "material", None), "image", None)
        uv = getattr(mesh.visual, "uv", None)
        if picture is None or uv is None or len(uv) != len(mesh.vertices):
            return None
        return TexturedMesh(np.asarray(mesh.vertices, dtype=np.float64), np.asarray(mesh.faces), np.asarray(uv), _small(picture))
    except UNREADABLE:
        return None


def textured(solid: Solid) -> TexturedMesh | None:
    """A solid's mesh with its picture, vertices [m] in the frame of the solid's pose; None where it has none."""
    mesh = load_textured(solid.mesh) if solid.mesh is not None else None
    if mesh is None:
        return None
    return replace(mesh, vertices=mesh.vertices * np.array(solid.size) @ matrix(solid.orientation).T + solid.position)


def joined_textured(meshes: Sequence[TexturedMesh]) -> TexturedMesh:
    """Meshes under one picture, that of the first, as one mesh."""
    offsets = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes[:-1])])
    faces = np.vstack([mesh.faces + offset for mesh, offset in zip(meshes, offsets, strict=True)])
    vertices, uv = np.vstack([mesh.vertices for mesh in meshes]), np.vstack([mesh.uv for mesh in meshes])
    return TexturedMesh(vertices, faces, uv, meshes[0].picture)


def write_textured(mesh: TexturedMesh, path: Path) -> None:
    """Writes ``path`` (.obj), the .mtl and .jpg beside it of the same name; the picture no larger than ``LARGEST``."""
    _small(mesh.picture).save(path.with_suffix(".jpg"), quality=85)
    path.with_suffix(".mtl").write_text(f"newmtl picture\nKd 1 1 1\nmap_Kd {path.stem}.jpg\n", encoding="utf-8")
    normals = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False).vertex_normals
    lines = [f"mtllib {path.stem}.mtl"]
    for word, rows in (("v", mesh.vertices), ("vt", mesh.uv), ("vn", normals)):
        lines += [f"{word} " + " ".join(f"{value:.6g}" for value in row) for row in rows.tolist()]
    lines.append("usemtl picture")
    lines += ["f " + " ".join(f"{i}/{i}/{i}" for i in face) for face in (mesh.faces + 1).tolist()]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def _small(picture: Image.Image) -> Image.Image:
    """A picture in RGB, no side longer than ``LARGEST``."""
    small = picture.convert("RGB")
    small.thumbnail((LARGEST, LARGEST))
    return small
