"""Meshes as others write them (DAE, OBJ, STL, glTF), made one STL file in metres with z up that physics, rays and page all read."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import collada  # type: ignore[import-untyped]
import numpy as np
import trimesh
from numpy.typing import NDArray
from PIL import Image
from trimesh.resolvers import FilePathResolver

from uvf.models.importing.mesh_colours import joined, mean_colour
from uvf.models.importing.mesh_looks import looks_of
from uvf.models.importing.notes import Notes
from uvf.models.lfs_pointer import refuse_pointer
from uvf.models.shapes.textured import TexturedMesh, write_textured
from uvf.models.world.file import Colour
from uvf.models.yaml_data import BadInput

Floats = NDArray[np.float64]

FORMATS = (".dae", ".stl", ".obj", ".glb", ".gltf", ".ply", ".off")
FLATTEST = 1e-9  # of a scale
HEAVY, MOST_DRAWN = 50_000, 200_000  # triangles of a mesh, and of all that is only looked at
DENSE = 10_000  # triangles for each metre of the longest side: more are seen by nobody
WHITE: Colour = (1.0, 1.0, 1.0)
DrawnFile = tuple[str, Colour | None]
"""A file's name in the folder, and its colour; None where the original tells none."""
Z_FROM_Y = np.array(((1.0, 0.0, 0.0), (0.0, 0.0, -1.0), (0.0, 1.0, 0.0)))
Z_FROM_X = np.array(((0.0, -1.0, 0.0), (0.0, 0.0, -1.0), (1.0, 0.0, 0.0)))
UNREADABLE = (
    *(OSError, ValueError, TypeError, KeyError, AttributeError, IndexError, NotImplementedError),
    *(collada.common.DaeError, Image.DecompressionBombError),
)


def load_with_pictures(source: Path) -> Any:
    """The scene of a mesh file, with its pictures wherever they are: Gazebo's models keep them in a folder beside that of the meshes."""
    return trimesh.load_scene(source, resolver=FilePathResolver(str(source), allow_anywhere=True))


class RequestedMesh(NamedTuple):
    """Which part of a mesh file (all of it when ``submesh`` is empty), its bounding box centred or not, and how large."""

    submesh: str = ""
    centred: bool = False
    scale: tuple[float, float, float] = (1.0, 1.0, 1.0)


class MeshStore:
    """Writes meshes below ``folder``/meshes, each once.

    upright: whether a DAE that says another axis than z is up gets turned. Gazebo never does, and worlds made with it rely on that.
    """

    def __init__(self, folder: Path, notes: Notes, upright: bool = False) -> None:
        self._upright = upright
        self._folder = folder
        self._notes = notes
        self._written: dict[tuple[Path, RequestedMesh], str] = {}
        self._colours: dict[Path, Colour | None] = {}
        self._drawn: dict[tuple[Path, RequestedMesh, Path | None], tuple[int, list[DrawnFile]]] = {}
        """With the count of their triangles."""
        self._seen = 0
        """Triangles of all that is drawn so far, wherever it stands."""

    def convert(self, source: Path, wanted: RequestedMesh) -> str:
        """Copies ``source`` as an STL file; returns its name in the world's folder. Raises BadInput when it cannot be read."""
        key = (source.resolve(), wanted)
        if key not in self._written:
            whole = joined(self._placed(source, wanted))
            if len(whole.faces) > HEAVY:
                self._notes.add(f"meshes of more than {HEAVY} triangles make everything slow; simplify them", source.name)
            self._written[key] = self.write(whole, source.stem + (f"_{wanted.submesh}" if wanted.submesh else ""))
        return self._written[key]

    def drawn(self, source: Path, wanted: RequestedMesh, picture: Path | None = None, sparing: bool = False) -> list[DrawnFile]:
        """The same as it looks: each picture an OBJ file, in white, and each colour a file, at most eight; one of no colour without any.

        picture: laid over all of it, whatever the file says. sparing: nothing, with a note, of what has more triangles than it is worth.
        Raises BadInput as ``convert``.
        """
        key = (source.resolve(), wanted, picture)
        if key not in self._drawn:
            meshes = self._placed(source, wanted)
            corners = np.array([mesh.bounds for mesh in meshes]).reshape(-1, 3)
            count, longest = sum(len(mesh.faces) for mesh in meshes), float(np.ptp(corners, axis=0).max())
            too_many = sparing and count > min(DENSE * longest, HEAVY)
            self._drawn[key] = (0, []) if too_many else (count, self._written_as_drawn(source, wanted, meshes, picture))
        count, files = self._drawn[key]
        if sparing and (not files or self._seen + count > MOST_DRAWN):
            self._notes.add("looks of many triangles left out, their collision shapes stand for them", source.name)
            return []
        self._seen += count
        return files

    def _written_as_drawn(self, source: Path, wanted: RequestedMesh, meshes: Sequence[Any], picture: Path | None) -> list[DrawnFile]:
        try:
            textured, plain = looks_of(meshes, Image.open(picture).convert("RGB") if picture is not None else None)
        except UNREADABLE as error:
            raise BadInput(f"{source}: cannot be drawn: {' '.join(str(error).split())}; export it anew") from error
        if not textured and len(plain) == 1:
            return [(self.convert(source, wanted), plain[0][1])]
        files: list[DrawnFile] = [(self.write_textured(mesh, source.stem), WHITE) for mesh in textured]
        return files + [(self.write(mesh, f"{source.stem}_{k}"), colour) for k, (mesh, colour) in enumerate(plain, 1)]

    def _placed(self, source: Path, wanted: RequestedMesh) -> list[Any]:
        """The meshes of a file in metres, where they are wanted, each with its own colours."""
        scene = self._scene(source)
        try:
            parts = self._part(scene, wanted.submesh, source).dump()
            meshes = [part for part in parts if isinstance(part, trimesh.Trimesh) and len(part.faces)]
            to = self._metres_from_file(source)
        except UNREADABLE as error:
            raise BadInput(f"{source}: cannot be read as a mesh: {' '.join(str(error).split())}; export it anew") from error
        if not meshes:
            raise BadInput(f"{source}: no triangles in it")
        if min(abs(side) for side in wanted.scale) < FLATTEST:
            raise BadInput(f"{source}: a scale of {' '.join(f'{side:g}' for side in wanted.scale)} leaves nothing of it")
        corners = np.array([mesh.apply_transform(to).bounds for mesh in meshes]).reshape(-1, 3)
        place = np.diag((*wanted.scale, 1.0))
        if wanted.centred:
            place[:3, 3] = -(corners.min(axis=0) + corners.max(axis=0)) / 2 * np.array(wanted.scale)
        return [mesh.apply_transform(place) for mesh in meshes]

    def write_textured(self, mesh: TexturedMesh, name: str) -> str:
        """As ``write``, of a mesh with a picture."""
        file = self._free(name, ".obj")
        write_textured(mesh, self._folder / file)
        return file

    def colour(self, source: Path) -> Colour | None:
        """Mean colour of a mesh file; None when it has none or cannot be read."""
        if source not in self._colours:
            try:
                self._colours[source] = mean_colour(load_with_pictures(source))
            except UNREADABLE:
                self._colours[source] = None
        return self._colours[source]

    def write(self, shape: Any, name: str) -> str:
        """Writes a mesh under a free name like ``name``; returns that of the file in the world's folder."""
        file = self._free(name, ".stl")
        shape.export(self._folder / file)
        return file

    def _free(self, name: str, ending: str) -> str:
        """A file's name below the world's folder that is not taken yet."""
        stem = "".join(c if c.isalnum() or c in "_-" else "_" for c in name).lstrip("-") or "mesh"
        meshes = self._folder / "meshes"
        meshes.mkdir(parents=True, exist_ok=True)
        taken = {p.stem for p in meshes.iterdir()}
        free = next(n for n in (stem, *(f"{stem}_{i}" for i in range(2, len(taken) + 3))) if n not in taken)
        return f"meshes/{free}{ending}"

    def _scene(self, source: Path) -> Any:
        if source.suffix.lower() not in FORMATS:
            raise BadInput(f"{source}: meshes of this kind are not read; export it as STL, OBJ or DAE")
        refuse_pointer(source)
        try:
            return load_with_pictures(source)
        except UNREADABLE as error:
            raise BadInput(f"{source}: cannot be read as a mesh: {' '.join(str(error).split())}; export it anew") from error

    def _part(self, scene: Any, submesh: str, source: Path) -> Any:
        """Only the geometry of that name, or whose node is called so; without one, all."""
        if not submesh:
            return scene
        names = {scene.graph[node][1] for node in scene.graph.nodes_geometry if submesh in (node, scene.graph[node][1])}
        names |= {n for n in scene.geometry if n.split(".")[0].removesuffix("-mesh").removesuffix("_001") == submesh}
        if not names:
            self._notes.add("submeshes not found; the whole mesh is taken", f"{submesh} of {source.name}")
            return scene
        part = scene.copy()
        part.delete_geometry([n for n in scene.geometry if n not in names])
        return part

    def _metres_from_file(self, source: Path) -> Floats:
        """(4, 4): unit and upward axis as the file states them; STL and OBJ state none and are in metres, z up."""
        to = np.eye(4)
        if source.suffix.lower() in (".glb", ".gltf"):
            to[:3, :3] = Z_FROM_Y
        if source.suffix.lower() == ".dae":
            asset = collada.Collada(str(source), ignore=[collada.common.DaeError]).assetInfo
            turn = {"Y_UP": Z_FROM_Y, "X_UP": Z_FROM_X}.get(asset.upaxis or "Z_UP", np.eye(3))
            to[:3, :3] = (turn if self._upright else np.eye(3)) * (asset.unitmeter or 1.0)
            if asset.upaxis in ("Y_UP", "X_UP") and not self._upright:
                self._notes.add("meshes that say another axis than z is up, not turned, as in Gazebo (--upright turns them)", source.name)
        return to
