"""The world about the vehicles: ground, floor, walls, furniture; each shape is made once, also of what moves by script."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from services.gcs.state.vehicle_model import DisplayPose
from services.gcs.view.drawing import Colour, MeshNode, Node, Polyline, TexturedNode
from services.gcs.view.scene.bodies import rgb
from uvf.maths.rotations import IDENTITY, from_euler, matrix
from uvf.models.mission.file import Waypoint
from uvf.models.scenario import MissionVehicle, Scenario
from uvf.models.shapes.mesh import triangles
from uvf.models.shapes.mesh_parts import MeshPart, box, joined
from uvf.models.shapes.solid import Solid, pose_at
from uvf.models.shapes.textured import TexturedMesh, joined_textured, textured
from uvf.models.world.cutaway import cut_height, cut_open, cut_open_textured
from uvf.models.world.file import Wall, WorldFile
from uvf.models.world.geometry import WALL, hills, seen, solids

Floats = NDArray[np.float64]

WALL_SHOWN = 0.9  # m: walls are cut at this height so that one looks into the rooms
FLOOR: Colour = (140, 150, 164)


def scenery(world: WorldFile) -> dict[str, Node]:
    """The static scene nodes of a world, by name."""
    x_min, y_min, x_max, y_max = world.floor
    floor = box(((x_min + x_max) / 2, (y_min + y_max) / 2, -0.06), (x_max - x_min, y_max - y_min, 0.1))
    nodes: dict[str, Node] = {"/world/floor": MeshNode(floor.vertices, floor.faces, FLOOR)}
    walls = [(wall.colour, part) for wall in world.walls for part in _segments(wall)]
    nodes.update(_merged("/world/walls", walls))
    top = cut_height(world, [solid for solid in solids(world) if solid.path is None])
    still = [s for s in (*seen(world), *hills(world)) if s.name != WALL and s.path is None]
    pictures = [(solid, textured(solid)) for solid in still]
    plain = [(s.colour, part) for s, mesh in pictures if mesh is None and len((part := _placed(s, top)).faces)]
    nodes.update(_merged("/world/things", plain))
    nodes.update(_pictured("/world/pictures", [(s.mesh, mesh) for s, mesh in pictures if mesh is not None], top))
    nodes.update((f"{_frame(s)}/shape", merge([at_rest(s)], rgb(s.colour))) for s in moving(world))
    return nodes


def moving(world: WorldFile) -> list[Solid]:
    """The solids that move by a script: people, doors."""
    return [solid for solid in solids(world) if solid.path is not None]


def places_of(scripted: Sequence[Solid], t: float) -> dict[str, DisplayPose]:
    """Frames of the moving solids at simulation time ``t`` [s], by node name."""
    return {_frame(solid): DisplayPose(*pose_at(solid, t)) for solid in scripted}


def _frame(solid: Solid) -> str:
    return f"/world/moving/{solid.name}"


def _placed(solid: Solid, top: float) -> MeshPart:
    """A solid's triangles in the world, up to a height [m]."""
    vertices, faces = triangles(solid)
    return MeshPart(*((vertices, faces) if vertices[:, 2].max() <= top else cut_open(vertices, faces, top)))


def at_rest(solid: Solid) -> MeshPart:
    """A solid's triangles in its own frame."""
    return MeshPart(*triangles(replace(solid, position=np.zeros(3), orientation=IDENTITY)))


def _segments(wall: Wall) -> Iterator[MeshPart]:
    """Each stretch of a wall as a box, lengthened by half its thickness at both ends so that corners close."""
    height = min(wall.height, WALL_SHOWN)
    for a, b in zip(np.array(wall.points[:-1]), np.array(wall.points[1:]), strict=True):
        along = b - a
        length = float(np.hypot(*along)) + wall.thickness
        middle = (a + b) / 2
        part = box((0, 0, 0), (length, wall.thickness, height))
        yield _turned(part, float(np.arctan2(along[1], along[0])), (middle[0], middle[1], height / 2))


def _turned(part: MeshPart, yaw: float, centre: tuple[float, float, float]) -> MeshPart:
    rotation = matrix(from_euler(0, 0, yaw))
    return MeshPart(part.vertices @ rotation.T + np.array(centre), part.faces)


def _merged(name: str, parts: list[tuple[tuple[float, float, float], MeshPart]]) -> dict[str, Node]:
    """One mesh for each colour: a browser draws ten big meshes faster than a hundred small ones."""
    by_colour: dict[tuple[float, float, float], list[MeshPart]] = {}
    for colour, part in parts:
        by_colour.setdefault(colour, []).append(part)
    return {f"{name}/{i}": merge(group, rgb(colour)) for i, (colour, group) in enumerate(sorted(by_colour.items()))}


def _pictured(name: str, meshes: Sequence[tuple[Path | None, TexturedMesh]], top: float) -> dict[str, Node]:
    """One mesh for each file, wherever it stands, up to a height [m]."""
    by_file: dict[Path | None, list[TexturedMesh]] = {}
    for file, mesh in meshes:
        there = cut_open_textured(mesh, top) if mesh.vertices[:, 2].max() > top else mesh
        if len(there.faces):
            by_file.setdefault(file, []).append(there)
    return {f"{name}/{i}": TexturedNode(joined_textured(group)) for i, group in enumerate(by_file.values())}


def merge(parts: list[MeshPart], colour: Colour, selects: str = "") -> MeshNode:
    """The parts as one mesh of one colour; ``selects``: the vehicle that a click selects."""
    return MeshNode(*joined(parts), colour, selects=selects)


def coloured(parts: Sequence[MeshPart], colour: Colour, selects: str = "") -> dict[str, Node]:
    """The parts of a body merged by colour; ``colour`` is that of parts without one."""
    groups: dict[Colour, list[MeshPart]] = {}
    for part in parts:
        groups.setdefault(part.colour or colour, []).append(part)
    return {str(i): merge(group, c, selects) for i, (c, group) in enumerate(groups.items())}


def rgb_of(colour: str) -> Colour:
    """``#4ea1ff`` -> (78, 161, 255)."""
    return int(colour[1:3], 16), int(colour[3:5], 16), int(colour[5:7], 16)


def circuit(items: list[Waypoint]) -> Floats:
    """Legs of the mission (n, 3) [m, world] as written, closed where a jump leads back."""
    points = [(w.x, w.y, w.z) for w in items if w.kind in ("waypoint", "orbit")]
    if points and any(w.kind == "jump" for w in items):
        points.append(points[0])
    return np.array(points).reshape(-1, 3)


def circuit_line(points: Floats, colour: Colour) -> Polyline:
    """The line through points (n, 3) [m, world]."""
    return Polyline(points, colour, 2.0)


def extent(site: Scenario) -> Floats:
    """Lowest and highest corner (2, 3) [m, world] of the floor, the starts and the missions."""
    x_min, y_min, x_max, y_max = site.world.floor
    points = [np.array(((x_min, y_min, 0.0), (x_max, y_max, 0.0)))]
    points += [_reach(member) for member in site.members.values()]
    everything = np.vstack(points)
    return np.array((everything.min(axis=0), everything.max(axis=0)))


def _reach(member: MissionVehicle) -> Floats:
    start = member.entry.start
    return np.vstack((np.array(((start.x, start.y, start.z),)), circuit(member.entry.job.mission)))
