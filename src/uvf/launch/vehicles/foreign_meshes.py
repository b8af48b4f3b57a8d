"""Meshes of others as STL files in metres beside the new vehicle; those that are not there are left out."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import trimesh

from uvf.launch.vehicles.foreign import Foreign
from uvf.launch.worlds.mesh_files import MeshStore, Wanted
from uvf.runtime.params import BadInput
from uvf.runtime.robot_model import Link, UrdfModel
from uvf.runtime.solid import Solid
from uvf.runtime.solid_mesh import load_mesh

BIG = 8.0  # m: no part of a ground vehicle; files of larger figures are in millimetres
GREY = (0.6, 0.6, 0.6)


def with_own_meshes(foreign: Foreign, folder: Path) -> UrdfModel:
    """Every mesh as a file below ``folder``, of collisions the convex hull, which is what physics takes of a body that moves."""
    store = MeshStore(folder, foreign.notes)
    links = {name: _link(link, foreign, store, folder) for name, link in foreign.model.links.items()}
    return replace(foreign.model, links=links)


def _link(link: Link, foreign: Foreign, store: MeshStore, folder: Path) -> Link:
    visuals, collisions = (
        tuple(new for solid in solids for new in _solid(solid, hull, (foreign, store, folder)))
        for solids, hull in ((link.visuals, False), (link.collisions, True))
    )
    if link.visuals and not visuals and collisions:
        foreign.notes.add("looks taken from the collision shape, for the mesh is missing", link.name)
        visuals = collisions
    if link.collisions and not collisions and visuals:
        foreign.notes.add("collision shape taken from the looks, for its mesh is missing", link.name)
        collisions = visuals
    return replace(link, visuals=visuals, collisions=collisions)


def _solid(solid: Solid, hull: bool, tools: tuple[Foreign, MeshStore, Path]) -> Iterator[Solid]:
    """The solid with its own file; nothing where there is none."""
    foreign, store, folder = tools
    if solid.shape != "mesh":
        yield solid
        return
    if solid.mesh is None or not solid.mesh.is_file():
        foreign.notes.add("meshes that are missing", str(solid.mesh))
        return
    try:
        written = store.convert(solid.mesh, Wanted(scale=_scale(solid)))
        file = folder / written
        vertices, _ = load_mesh(file)
    except BadInput as error:
        foreign.notes.add("meshes that cannot be read", str(error))
        return
    unit = 1.0
    if np.ptp(vertices, axis=0).max() > BIG:
        foreign.notes.add("meshes taken to be in millimetres, for they are larger than 8 m", solid.mesh.name)
        unit = 0.001
    if hull:
        file = folder / store.write(_hull(file), f"{solid.mesh.stem}_hull")
    colour = (store.colour(solid.mesh) if solid.colour == GREY else None) or solid.colour
    yield replace(solid, mesh=file, size=(unit, unit, unit), colour=colour)


def _hull(file: Path) -> Any:
    """Of a flat mesh, which has none, its bounding box."""
    mesh = trimesh.Trimesh(*load_mesh(file))
    try:
        return mesh.convex_hull
    except (ValueError, RuntimeError):
        box = trimesh.creation.box(np.maximum(mesh.extents, 1e-3))
        box.apply_translation(mesh.bounds.mean(axis=0))
        return box


def _scale(solid: Solid) -> tuple[float, float, float]:
    x, y, z = solid.size
    return x, y, z
