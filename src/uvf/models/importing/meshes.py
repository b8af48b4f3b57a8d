"""Meshes of others as STL files in metres beside the new vehicle; those that are not there are left out."""

import contextlib
import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import trimesh

from uvf.models.importing.mesh_files import MeshStore, RequestedMesh
from uvf.models.importing.robot import Foreign
from uvf.models.shapes.mesh import load_mesh
from uvf.models.shapes.solid import Solid
from uvf.models.urdf.robot import Link, UrdfModel
from uvf.models.yaml_data import BadInput

BIG = 8.0  # m: no part of a ground vehicle; files of larger figures are in millimetres
GREY = (0.6, 0.6, 0.6)
Scale = tuple[float, float, float]


@dataclass(frozen=True)
class Tools:
    """What the meshes of one robot are brought over with.

    millimetres: scales of this robot's meshes with which one of them would be larger than any part.
    """

    foreign: Foreign
    store: MeshStore
    folder: Path
    millimetres: frozenset[Scale] = frozenset()


def with_own_meshes(foreign: Foreign, folder: Path) -> UrdfModel:
    """The robot with every mesh as a file below ``folder``.

    Of a collision shape it is the convex hull, which is what physics takes of a body that moves.
    """
    tools = Tools(foreign, MeshStore(folder, foreign.notes), folder)
    tools = replace(tools, millimetres=frozenset(_too_big(tools)))
    links = {name: _link(link, tools) for name, link in foreign.model.links.items()}
    return replace(foreign.model, links=links)


def _too_big(tools: Tools) -> Iterator[Scale]:
    """One export has one unit: a screw of a robot in millimetres is in millimetres too, though it is small enough to be in metres."""
    for link in tools.foreign.model.links.values():
        for solid in (*link.visuals, *link.collisions):
            if solid.shape == "mesh" and solid.mesh is not None and solid.mesh.is_file():
                with contextlib.suppress(BadInput):
                    vertices, _ = load_mesh(tools.folder / tools.store.convert(solid.mesh, RequestedMesh(scale=_scale(solid))))
                    if np.ptp(vertices, axis=0).max() > BIG:
                        yield _unsigned(_scale(solid))


def _link(link: Link, tools: Tools) -> Link:
    visuals, collisions = (
        tuple(new for solid in solids for new in _solid(solid, hull, tools))
        for solids, hull in ((link.visuals, False), (link.collisions, True))
    )
    if link.visuals and not visuals and collisions:
        tools.foreign.notes.add("looks taken from the collision shape, for the mesh is missing", link.name)
        visuals = collisions
    if link.collisions and not collisions and visuals:
        tools.foreign.notes.add("collision shape taken from the visual, because its mesh is missing", link.name)
        collisions = visuals
    return replace(link, visuals=visuals, collisions=collisions)


def _solid(solid: Solid, hull: bool, tools: Tools) -> Iterator[Solid]:
    """The solid with its own file; nothing where there is none."""
    notes, store = tools.foreign.notes, tools.store
    if solid.shape != "mesh":
        yield solid
        return
    if solid.mesh is None or not solid.mesh.is_file():
        notes.add("meshes that are missing", _uri(solid.mesh))
        return
    wanted = RequestedMesh(scale=_scale(solid))
    try:
        files = [(store.convert(solid.mesh, wanted), None)] if hull or solid.colour != GREY else store.drawn(solid.mesh, wanted)
        for file, _ in files:
            load_mesh(tools.folder / file)
    except BadInput as error:
        notes.add("meshes that cannot be read", str(error))
        return
    unit = 1.0
    if _unsigned(_scale(solid)) in tools.millimetres:
        notes.add("meshes taken to be in millimetres, for one of them is larger than 8 m", solid.mesh.name)
        unit = 0.001
    if hull:
        files = [(store.write(_hull(tools.folder / files[0][0]), f"{solid.mesh.stem}_hull"), None)]
    for file, colour in files:
        yield replace(solid, mesh=tools.folder / file, size=(unit, unit, unit), colour=colour or solid.colour)


def _uri(mesh: Path | None) -> str:
    """As the robot's file names it: a path joins the slashes after the scheme."""
    return re.sub(r"^(package|model|file):/(?=[^/])", r"\1://", str(mesh))


def _hull(file: Path) -> Any:
    """Of a flat mesh, which has none, its bounding box."""
    mesh = trimesh.Trimesh(*load_mesh(file))
    try:
        return mesh.convex_hull
    except (ValueError, RuntimeError):
        box = trimesh.creation.box(np.maximum(mesh.extents, 1e-3))
        box.apply_translation(mesh.bounds.mean(axis=0))
        return box


def _scale(solid: Solid) -> Scale:
    x, y, z = solid.size
    return x, y, z


def _unsigned(scale: Scale) -> Scale:
    """A mirrored part comes from the same export."""
    x, y, z = (abs(side) for side in scale)
    return x, y, z
