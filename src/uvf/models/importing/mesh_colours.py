"""Colours of meshes: of materials, of faces, and of pictures laid over them."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import trimesh
from numpy.typing import NDArray
from PIL import Image

from uvf.models.world.file import Colour

Floats = NDArray[np.float64]

MOST = 8  # colours of one mesh


def mean_colour(scene: Any) -> Colour | None:
    """Mean over all parts by area; a picture counts with its mean. None where nothing has a colour."""
    found = [(part.area, rgb) for part in scene.geometry.values() if (rgb := _rgb(part.visual)) is not None]
    total = sum(area for area, _ in found)
    if not total > 0:
        return None
    r, g, b = (float(np.clip(sum(area * rgb[k] for area, rgb in found) / total, 0.0, 1.0)) for k in range(3))
    return r, g, b


def colour_groups(meshes: Sequence[Any]) -> list[tuple[Any, Colour | None]]:
    """The faces of all meshes as a mesh for each colour, at most ``MOST`` of them; one of None for those that have none."""
    coloured = [(mesh, face_colours(mesh)) for mesh in meshes if len(mesh.faces)]
    bare = [mesh for mesh, colours in coloured if colours is None]
    painted = [(mesh, colours) for mesh, colours in coloured if colours is not None]
    groups: list[tuple[Any, Colour | None]] = [(joined(bare), None)] if bare else []
    if not painted:
        return groups
    whole = joined([mesh for mesh, _ in painted])
    palette, numbers = _palette(np.concatenate([colours for _, colours in painted]))
    for k, (r, g, b) in enumerate((palette / 255).tolist()):
        if (numbers == k).any():
            groups.append((whole.submesh([np.flatnonzero(numbers == k)], append=True), (r, g, b)))
    return groups


def face_colours(mesh: Any) -> NDArray[np.uint8] | None:
    """(faces, 3) of 0 to 255, of a picture where the middle of each face lies in it; None for a mesh without colours."""
    visual = mesh.visual
    if not visual.defined:
        return None
    picture, uv = picture_of(visual), getattr(visual, "uv", None)
    if picture is not None and uv is not None and len(uv) == len(mesh.vertices):
        pixels = np.asarray(picture.convert("RGB"))
        u, v = np.mod(uv[mesh.faces].mean(axis=1), 1.0).T
        rows = np.clip(((1.0 - v) * pixels.shape[0]).astype(int), 0, pixels.shape[0] - 1)
        columns = np.clip((u * pixels.shape[1]).astype(int), 0, pixels.shape[1] - 1)
        found: NDArray[np.uint8] = pixels[rows, columns]
        return found
    if getattr(visual, "material", None) is None and visual.kind in ("face", "vertex"):
        return np.asarray(visual.face_colors)[:, :3].astype(np.uint8)
    rgb = _rgb(visual)
    return None if rgb is None else np.tile(np.round(rgb * 255).astype(np.uint8), (len(mesh.faces), 1))


def joined(meshes: Sequence[Any]) -> Any:
    """Meshes as one without colours: joining those too would pack all pictures into one, which is slow."""
    plain = [trimesh.Trimesh(mesh.vertices, mesh.faces, process=False) for mesh in meshes]
    return trimesh.util.concatenate(plain)


def _palette(colours: NDArray[np.uint8]) -> tuple[Floats, NDArray[np.int64]]:
    """Colours (k, 3) of 0 to 255, and which of them each face has."""
    different, numbers = np.unique(colours, axis=0, return_inverse=True)
    if len(different) <= MOST:
        return different.astype(np.float64), numbers.ravel()
    quantised = Image.fromarray(colours[None]).quantize(MOST, method=Image.Quantize.MEDIANCUT, kmeans=3)
    palette = np.array(quantised.getpalette(), dtype=np.float64).reshape(-1, 3)
    return palette, np.asarray(quantised, dtype=np.int64)[0]


def picture_of(visual: Any) -> Any:
    """The picture laid over a mesh by its material; None without one."""
    material = getattr(visual, "material", None)
    return getattr(material, "image", None) or getattr(material, "baseColorTexture", None)


def _rgb(visual: Any) -> Floats | None:
    if not visual.defined:
        return None
    picture, material = picture_of(visual), getattr(visual, "material", None)
    if picture is not None:
        pixels: Floats = np.asarray(picture.convert("RGB").resize((16, 16)), dtype=np.float64).reshape(-1, 3)
        mean: Floats = pixels.mean(axis=0) / 255
        return mean
    colour = getattr(material, "main_color", None) if material is not None else visual.main_color
    return None if colour is None else np.array(colour[:3], dtype=np.float64) / 255
