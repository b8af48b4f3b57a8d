"""How meshes of others look: their faces by picture and by colour."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uvf.models.importing.mesh_colours import colour_groups, picture_of
from uvf.models.shapes.textured import TexturedMesh, joined_textured
from uvf.models.world.file import Colour

SAMPLED = 16  # px a side, in which pictures are compared
PLAIN = 6.0  # of 255: a picture that varies less is a colour


def looks_of(meshes: Sequence[Any], picture: Any = None) -> tuple[list[TexturedMesh], list[tuple[Any, Colour | None]]]:
    """The faces that have a picture, a mesh for each picture, and the others, a mesh for each colour. picture: laid over all of them."""
    found: dict[bytes, list[TexturedMesh]] = {}
    plain = []
    for mesh in (m for m in meshes if len(m.faces)):
        uv, laid = getattr(mesh.visual, "uv", None), picture or (picture_of(mesh.visual) if mesh.visual.defined else None)
        if laid is None or uv is None or len(uv) != len(mesh.vertices) or not _varies(laid):
            plain.append(mesh)
        else:
            found.setdefault(_thumb(laid).tobytes(), []).append(TexturedMesh(mesh.vertices, mesh.faces, uv[:, :2], laid))
    return [joined_textured(group) for group in found.values()], colour_groups(plain)


def _thumb(picture: Any) -> NDArray[np.uint8]:
    return np.asarray(picture.convert("RGB").resize((SAMPLED, SAMPLED)), dtype=np.uint8)


def _varies(picture: Any) -> bool:
    return float(_thumb(picture).reshape(-1, 3).std(axis=0).max()) > PLAIN
