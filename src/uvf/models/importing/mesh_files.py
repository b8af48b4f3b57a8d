"""Meshes as others write them (DAE, OBJ, STL, glTF), made one STL file in metres with z up that physics, rays and page all read."""

from pathlib import Path
from typing import Any, NamedTuple

import collada  # type: ignore[import-untyped]
import numpy as np
import trimesh
from numpy.typing import NDArray

from uvf.models.importing.mesh_colours import colour_groups, mean_colour
from uvf.models.importing.notes import Notes
from uvf.models.lfs_pointer import refuse_pointer
from uvf.models.world.file import Colour
from uvf.models.yaml_data import BadInput

Floats = NDArray[np.float64]

FORMATS = (".dae", ".stl", ".obj", ".glb", ".gltf", ".ply", ".off")
FLATTEST = 1e-9  # of a scale
HEAVY = 50_000  # triangles
Z_FROM_Y = np.array(((1.0, 0.0, 0.0), (0.0, 0.0, -1.0), (0.0, 1.0, 0.0)))
Z_FROM_X = np.array(((0.0, -1.0, 0.0), (0.0, 0.0, -1.0), (1.0, 0.0, 0.0)))
UNREADABLE = (OSError, ValueError, TypeError, KeyError, AttributeError, IndexError, NotImplementedError, collada.common.DaeError)


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
        self._parts: dict[Path, list[tuple[Any, Colour | None]]] = {}

    def convert(self, source: Path, wanted: RequestedMesh) -> str:
        """Copies ``source`` as an STL file; returns its name in the world's folder. Raises BadInput when it cannot be read."""
        key = (source.resolve(), wanted)
        if key not in self._written:
            loaded = self._load(source, wanted)
            loaded.apply_transform(np.diag((*wanted.scale, 1.0)))
            self._written[key] = self.write(loaded, source.stem + (f"_{wanted.submesh}" if wanted.submesh else ""))
        return self._written[key]

    def by_colour(self, source: Path, wanted: RequestedMesh) -> list[tuple[str, Colour | None]]:
        """The same in one file for each of its colours, pictures by their few main ones; of a file without colours one of no colour.

        Raises BadInput as ``convert``.
        """
        if source.resolve() not in self._parts:
            self.convert(source, wanted)  # refuses what cannot be read
            groups = colour_groups(trimesh.load_scene(source).dump())
            self._parts[source.resolve()] = groups if len(groups) > 1 else []
        parts, to = self._parts[source.resolve()], np.diag((*wanted.scale, 1.0)) @ self._metres_from_file(source)
        if not parts:
            return [(self.convert(source, wanted), self.colour(source))]
        found: list[tuple[str, Colour | None]] = []
        for k, (part, colour) in enumerate(parts, 1):
            key = (source.resolve(), wanted._replace(submesh=f"colour {k}"))
            if key not in self._written:
                self._written[key] = self.write(part.copy().apply_transform(to), f"{source.stem}_{k}")
            found.append((self._written[key], colour))
        return found

    def colour(self, source: Path) -> Colour | None:
        """Mean colour of a mesh file; None when it has none or cannot be read."""
        if source not in self._colours:
            try:
                self._colours[source] = mean_colour(trimesh.load_scene(source))
            except UNREADABLE:
                self._colours[source] = None
        return self._colours[source]

    def write(self, shape: Any, name: str) -> str:
        """Writes a mesh under a free name like ``name``; returns that of the file in the world's folder."""
        stem = "".join(c if c.isalnum() or c in "_-" else "_" for c in name).lstrip("-") or "mesh"
        meshes = self._folder / "meshes"
        meshes.mkdir(parents=True, exist_ok=True)
        taken = {p.stem for p in meshes.iterdir()}
        free = next(n for n in (stem, *(f"{stem}_{i}" for i in range(2, len(taken) + 3))) if n not in taken)
        shape.export(meshes / f"{free}.stl")
        return f"meshes/{free}.stl"

    def _load(self, source: Path, wanted: RequestedMesh) -> Any:
        if source.suffix.lower() not in FORMATS:
            raise BadInput(f"{source}: meshes of this kind are not read; export it as STL, OBJ or DAE")
        refuse_pointer(source)
        try:
            scene = trimesh.load_scene(source)
            whole = self._part(scene, wanted.submesh, source).to_mesh()
            metres = self._metres_from_file(source)
        except UNREADABLE as error:
            raise BadInput(f"{source}: cannot be read as a mesh: {' '.join(str(error).split())}; export it anew") from error
        if len(whole.faces) == 0:
            raise BadInput(f"{source}: no triangles in it")
        if min(abs(side) for side in wanted.scale) < FLATTEST:
            raise BadInput(f"{source}: a scale of {' '.join(f'{side:g}' for side in wanted.scale)} leaves nothing of it")
        whole.apply_transform(metres)
        if wanted.centred:
            whole.apply_translation(-whole.bounds.mean(axis=0))
        if len(whole.faces) > HEAVY:
            self._notes.add(f"meshes of more than {HEAVY} triangles make everything slow; simplify them", source.name)
        return whole

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
