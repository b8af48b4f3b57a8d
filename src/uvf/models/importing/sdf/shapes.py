"""Shapes of SDF collisions as things of a world file."""

from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import trimesh
from numpy.typing import NDArray

from uvf.maths.rotations import matrix, rotate, to_euler
from uvf.maths.se3 import IDENTITY, Transform, compose
from uvf.models.importing.mesh_files import MeshStore, RequestedMesh
from uvf.models.importing.notes import Notes
from uvf.models.importing.polygons import extruded
from uvf.models.importing.sdf.poses import numbers, place_of
from uvf.models.world.file import Box, Colour, Cylinder, Look, Mesh, Sphere
from uvf.models.yaml_data import BadInput

Floats = NDArray[np.float64]
Thing = Box | Cylinder | Sphere | Mesh

GREY: Colour = (0.7, 0.7, 0.7)
SHEET = 0.02  # m, thickness of a plane that is not the ground
SMALLEST = 1e-4  # m, what a world file takes


class Named(NamedTuple):
    """Identity of a shape: its name in the world, its colour if a visual tells one, and the scale (3,) [-] of the saved state."""

    name: str
    colour: Colour | None
    scale: Floats


class Shapes:
    """Turns one <geometry> after the other into things of a world file."""

    def __init__(self, store: MeshStore, find: Callable[[str, Any], Path | None], notes: Notes) -> None:
        self._store = store
        self._find = find
        self._notes = notes

    def things(self, geometry: Any, pose: Transform, who: Named) -> list[Thing]:
        """The things that ``geometry`` becomes in the world; none, with a note, if it cannot be had.

        Raises BadInput for missing measures.
        """
        kind = next((child for child in geometry if isinstance(child.tag, str)), None)
        if kind is None or kind.tag == "empty":
            return []
        make = getattr(self, f"_{kind.tag}", None)
        if kind.tag not in SHAPES or make is None:
            self._notes.add(f"shapes of a kind that is not taken over ({kind.tag})", who.name)
            return []
        try:
            made: list[Thing] = make(kind, pose, who)
        except BadInput as error:
            self._notes.add("shapes that cannot be read, left out", f"{who.name} ({error})")
            return []
        return made

    def _box(self, box: Any, pose: Transform, who: Named) -> list[Thing]:
        size = _lengths(_child(box, "size"), 3) * who.scale
        return [Box(who.name, _point(pose.translation), _point(size), _angles(pose), who.colour or GREY)]

    def _cylinder(self, cylinder: Any, pose: Transform, who: Named) -> list[Thing]:
        radius, height = _length(cylinder, "radius") * who.scale[0], _length(cylinder, "length") * who.scale[2]
        return [_standing(who, pose, float(radius), float(height))]

    def _sphere(self, sphere: Any, pose: Transform, who: Named) -> list[Thing]:
        return [Sphere(who.name, _point(pose.translation), float(_length(sphere, "radius") * who.scale[0]), who.colour or GREY)]

    def _capsule(self, capsule: Any, pose: Transform, who: Named) -> list[Thing]:
        """A cylinder and a ball at either end."""
        radius, length = float(_length(capsule, "radius") * who.scale[0]), float(_length(capsule, "length") * who.scale[2])
        balls = [Sphere(f"{who.name}_{end}", _point(_moved(pose, z)), radius, who.colour or GREY) for end, z in _ends(length)]
        return [_standing(who, pose, radius, length), *balls]

    def _ellipsoid(self, ellipsoid: Any, pose: Transform, who: Named) -> list[Thing]:
        radii = _lengths(_child(ellipsoid, "radii"), 3) * who.scale
        if np.ptp(radii) < SMALLEST:
            return [Sphere(who.name, _point(pose.translation), float(radii[0]), who.colour or GREY)]
        ball = trimesh.creation.icosphere(subdivisions=3)
        ball.apply_transform(np.diag((*radii, 1.0)))
        return self._own_mesh(ball, pose, who)

    def _cone(self, cone: Any, pose: Transform, who: Named) -> list[Thing]:
        """SDF puts a cone's frame halfway up."""
        height = float(_length(cone, "length") * who.scale[2])
        shape = trimesh.creation.cone(float(_length(cone, "radius") * who.scale[0]), height)
        shape.apply_translation((0.0, 0.0, -height / 2))
        return self._own_mesh(shape, pose, who)

    def _polyline(self, polyline: Any, pose: Transform, who: Named) -> list[Thing]:
        points = np.array([numbers(p, 2) for p in polyline.findall("point")]).reshape(-1, 2) * who.scale[:2]
        height = float(_length(polyline, "height") * who.scale[2])
        try:
            vertices, faces = extruded(points, height)
        except ValueError as error:
            raise BadInput(f"{place_of(polyline)}: <polyline>: {error}") from error
        return self._own_mesh(trimesh.Trimesh(vertices, faces), pose, who)

    def _plane(self, plane: Any, pose: Transform, who: Named) -> list[Thing]:
        """A thin box below the surface; the ground itself is told apart before."""
        size = numbers(plane.find("size"), 2) if plane.find("size") is not None else np.ones(2)
        turned = compose(pose, Transform(_turn_z_to(plane_normal(plane)), np.zeros(3)))
        x, y = (float(max(s, SMALLEST)) for s in size * who.scale[:2])
        return [Box(who.name, _point(_moved(turned, -SHEET / 2)), (x, y, SHEET), _angles(turned), who.colour or GREY)]

    def _mesh(self, mesh: Any, pose: Transform, who: Named) -> list[Thing]:
        uri = (mesh.findtext("uri") or "").strip()
        source = self._find(uri, mesh)
        if source is None or not source.is_file():
            self._notes.add("meshes not found, their shapes are missing", uri)
            return []
        file = self._store.convert(source, self._wanted(mesh, who.scale))
        return [Mesh(who.name, file, _point(pose.translation), _angles(pose), colour=who.colour or self._store.colour(source) or GREY)]

    def looks(self, visual: Any, pose: Transform, who: Named) -> list[Look]:
        """What a <visual> becomes that is a mesh; none, with a note, if it cannot be had. A colour of ``who`` holds for all of it."""
        mesh = visual.find("geometry/mesh")
        source = self._find((mesh.findtext("uri") or "").strip(), mesh)
        if source is None or not source.is_file():
            return []
        try:
            wanted = self._wanted(mesh, who.scale)
            painted = (visual.findtext("material/pbr/metal/albedo_map") or "").strip()
            picture = self._find(painted, visual) if painted else None
            files = self._store.drawn(source, wanted, picture if picture is not None and picture.is_file() else None, sparing=True)
        except BadInput as error:
            self._notes.add("looks that cannot be read, left out", f"{who.name} ({error})")
            return []
        at = {"position": _point(pose.translation), "rpy": _angles(pose)}
        return [Look(file, colour=who.colour or colour or GREY, **at) for file, colour in files]

    def _wanted(self, mesh: Any, state_scale: Floats) -> RequestedMesh:
        scale = (numbers(mesh.find("scale"), 3) if mesh.find("scale") is not None else np.ones(3)) * state_scale
        submesh = mesh.find("submesh")
        centred = submesh is not None and (submesh.findtext("center") or "").strip().lower() in ("true", "1")
        return RequestedMesh((submesh.findtext("name") or "").strip() if submesh is not None else "", centred, _point(scale))

    def mesh_colour(self, mesh: Any) -> Colour | None:
        """Colour that the file of a <mesh> tells; None when it tells none or is not there."""
        source = self._find((mesh.findtext("uri") or "").strip(), mesh)
        return None if source is None or not source.is_file() else self._store.colour(source)

    def _own_mesh(self, shape: Any, pose: Transform, who: Named) -> list[Thing]:
        file = self._store.write(shape, who.name)
        return [Mesh(who.name, file, _point(pose.translation), _angles(pose), colour=who.colour or GREY)]


SHAPES = ("box", "cylinder", "sphere", "capsule", "ellipsoid", "cone", "polyline", "plane", "mesh")


def plane_normal(plane: Any) -> Floats:
    """Unit normal (3,) of a <plane> in its own frame."""
    normal = numbers(plane.find("normal"), 3) if plane.find("normal") is not None else np.array((0.0, 0.0, 1.0))
    length = float(np.linalg.norm(normal))
    upright: Floats = np.array((0.0, 0.0, 1.0)) if length == 0 else normal / length
    return upright


def is_level(plane: Any, pose: Transform) -> bool:
    """Whether a <plane> at ``pose`` faces upward, as the ground does."""
    return bool(rotate(pose.rotation, plane_normal(plane))[2] > 0.999)


def _turn_z_to(direction: Floats) -> Floats:
    """wxyz of the shortest turn that brings z there."""
    x, y, z = direction
    if z < -1 + 1e-12:
        return np.array((0.0, 1.0, 0.0, 0.0))
    q = np.array((1 + z, -y, x, 0.0))
    turned: Floats = q / np.linalg.norm(q)
    return turned


def _standing(who: Named, pose: Transform, radius: float, height: float) -> Cylinder:
    return Cylinder(who.name, _point(_moved(pose, -height / 2)), radius, height, _angles(pose), who.colour or GREY)


def _ends(length: float) -> tuple[tuple[str, float], tuple[str, float]]:
    return ("low", -length / 2), ("high", length / 2)


def _moved(pose: Transform, z: float) -> Floats:
    """The point at height ``z`` [m] in the shape's frame."""
    return pose.translation + matrix(pose.rotation)[:, 2] * z


def _child(element: Any, tag: str) -> Any:
    child = element.find(tag)
    if child is None:
        raise BadInput(f"{place_of(element)}: <{element.tag}> has no <{tag}>; write it")
    return child


def _length(element: Any, tag: str) -> float:
    return float(_lengths(_child(element, tag), 1)[0])


def _lengths(element: Any, count: int) -> Floats:
    values = numbers(element, count)
    if (values < SMALLEST).any():
        raise BadInput(f"{place_of(element)}: <{element.tag}> holds '{element.text.strip()}'; lengths of 0.1 mm and more are needed")
    return values


def _point(values: Floats) -> tuple[float, float, float]:
    x, y, z = (float(v) for v in values)
    return x, y, z


def _angles(pose: Transform) -> tuple[float, float, float]:
    """Roll, pitch, yaw [rad], exactly zero where they only round."""
    if np.allclose(np.abs(pose.rotation), IDENTITY.rotation, atol=1e-9):
        return 0.0, 0.0, 0.0
    roll, pitch, yaw = (0.0 if abs(a) < 1e-7 else float(a) for a in to_euler(pose.rotation))
    return roll, pitch, yaw
