"""Pictures of the world and its vehicles by PyBullet's software renderer; the only file here that knows PyBullet."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.sim_camera.backdrop import Backdrop
from services.sim_camera.optics import frustum
from uvf.maths.rotations import IDENTITY, from_euler, matrix, multiply, rotate
from uvf.models.aircraft.shape import AircraftShape
from uvf.models.shapes.mesh_parts import MeshPart, joined
from uvf.models.shapes.solid import Solid, pose_at
from uvf.models.vehicle.sensors import Camera
from uvf.models.world.file import WorldFile
from uvf.models.yaml_data import BadInput
from uvf.runtime.process.quiet import c_errors_discarded

with c_errors_discarded():
    import pybullet

Floats = NDArray[np.float64]
Picture = NDArray[np.uint8]

AHEAD = 1e-3  # m that the eye is before the mount: of a corner exactly in the eye's own plane, as of a plate that the camera is flush with,
# the engine divides 0 by 0, and then fills columns from -2^31 on
NEAR = 0.02  # m
TO_LIGHT = (0.4, -0.6, 1.0)


class Pose(NamedTuple):
    """A pose. position: (3,) [m, world]; world_from_body: (4,) wxyz."""

    position: Floats
    world_from_body: Floats


class Shot(NamedTuple):
    """A picture (height, width, 3) RGB and its depth (height, width) [m] along the view, inf where nothing is; None if not asked for."""

    picture: Picture
    depth: Floats | None


Look = Path | AircraftShape
"""What a vehicle looks like: a URDF, or the shape of an aircraft."""


@dataclass(frozen=True)
class _Shown:
    """A vehicle inside the renderer, whose own frame is the centre of mass: given in the body frame."""

    index: int
    com_in_body: Pose
    joints: Mapping[str, int]


class BulletRenderer:
    """Renders a copy of the world without physics, on a client of its own."""

    def __init__(self, world: WorldFile, solids: Sequence[Solid], vehicles: Mapping[str, Look]) -> None:
        self._client: int = pybullet.connect(pybullet.DIRECT)
        self._backdrop = Backdrop(world)
        self._scripted: list[tuple[int, Solid]] = []
        for solid in solids:
            index = self._add(_visual_shape(solid, self._client), solid.position, solid.orientation)
            if solid.path is not None:
                self._scripted.append((index, solid))
        self._vehicles = {name: self._load(look) for name, look in vehicles.items()}
        self._guests: dict[str, tuple[Look | tuple[str, tuple[float, ...]], int]] = {}

    def _add(self, shape: int, position: Floats, orientation: Floats = IDENTITY) -> int:
        index: int = pybullet.createMultiBody(
            0.0, -1, shape, basePosition=position.tolist(), baseOrientation=_xyzw(orientation), physicsClientId=self._client
        )
        return index

    def _load(self, look: Look) -> _Shown:
        centred = Pose(np.zeros(3), np.array((1.0, 0.0, 0.0, 0.0)))
        if isinstance(look, AircraftShape):
            return _Shown(_aircraft(look, self._client), centred, {})
        try:
            index = pybullet.loadURDF(str(look), useFixedBase=True, physicsClientId=self._client)
        except pybullet.error as error:
            raise BadInput(f"{look}: PyBullet cannot load it ({error}); check its geometry and joints") from error
        local = pybullet.getDynamicsInfo(index, -1, physicsClientId=self._client)
        x, y, z, w = local[4]
        count = pybullet.getNumJoints(index, physicsClientId=self._client)
        infos = [pybullet.getJointInfo(index, j, physicsClientId=self._client) for j in range(count)]
        turning = {info[1].decode(): info[0] for info in infos if info[2] != pybullet.JOINT_FIXED}
        return _Shown(index, Pose(np.array(local[3]), np.array((w, x, y, z))), turning)

    def place(self, t: float, poses: Mapping[str, Pose]) -> None:
        """Places vehicles at their true poses, and scripted solids where they are at ``t`` [s]."""
        for index, solid in self._scripted:
            position, turned = pose_at(solid, t)
            pybullet.resetBasePositionAndOrientation(index, position.tolist(), _xyzw(turned), physicsClientId=self._client)
        for name, (position, world_from_body) in poses.items():
            if (shown := self._vehicles.get(name)) is None:  # one that was put in a moment ago
                continue
            centre = position + rotate(world_from_body, shown.com_in_body.position)
            turned = multiply(world_from_body, shown.com_in_body.world_from_body)
            pybullet.resetBasePositionAndOrientation(shown.index, centre.tolist(), _xyzw(turned), physicsClientId=self._client)

    def turn(self, positions: Mapping[str, Mapping[str, float]]) -> None:
        """Turns joints of vehicles to these positions [rad or m], by their names; other names are passed over."""
        for name, joints in positions.items():
            if (shown := self._vehicles.get(name)) is None:
                continue
            for joint, position in joints.items():
                if (number := shown.joints.get(joint)) is not None:
                    pybullet.resetJointState(shown.index, number, position, physicsClientId=self._client)

    def show(self, guests: Mapping[str, Solid | Look]) -> None:
        """Shows what has been spawned: solids where they are now; vehicles are placed like the others."""
        kinds = {name: guest if isinstance(guest, Path | AircraftShape) else (guest.shape, guest.size) for name, guest in guests.items()}
        for name in [name for name, (kind, _) in self._guests.items() if kinds.get(name) != kind]:
            pybullet.removeBody(self._guests.pop(name)[1], physicsClientId=self._client)
            self._vehicles.pop(name, None)
        for name, guest in guests.items():
            if isinstance(guest, Path | AircraftShape):
                if name not in self._guests:
                    self._vehicles[name] = self._load(guest)
                    self._guests[name] = guest, self._vehicles[name].index
                continue
            if name not in self._guests:
                self._guests[name] = kinds[name], self._add(_visual_shape(guest, self._client), guest.position)
            index, turned = self._guests[name][1], _xyzw(guest.orientation)
            pybullet.resetBasePositionAndOrientation(index, guest.position.tolist(), turned, physicsClientId=self._client)

    def take(self, camera: Camera, body: Pose) -> Shot:
        """The picture that a camera of a vehicle takes with its body at this pose."""
        world_from_camera = multiply(body.world_from_body, from_euler(*camera.mount.rpy))
        forward, left, up = matrix(world_from_camera).T
        eye = body.position + rotate(body.world_from_body, np.array(camera.mount.xyz)) + AHEAD * forward
        view = pybullet.computeViewMatrix(eye.tolist(), (eye + forward).tolist(), up.tolist())
        _, _, rgba, buffer, seen = pybullet.getCameraImage(
            camera.width,
            camera.height,
            viewMatrix=view,
            projectionMatrix=pybullet.computeProjectionMatrix(*frustum(camera, NEAR), NEAR, camera.far),
            lightDirection=TO_LIGHT,
            shadow=0,
            renderer=pybullet.ER_TINY_RENDERER,
            physicsClientId=self._client,
        )
        solids = np.reshape(np.asarray(rgba, dtype=np.uint8), (camera.height, camera.width, 4))[:, :, :3]
        nothing = np.reshape(seen, (camera.height, camera.width)) < 0
        world_from_optical = np.column_stack((-left, -up, forward))
        picture = np.where(nothing[:, :, None], self._backdrop.paint(camera, eye, world_from_optical), solids)
        if not camera.depth:
            return Shot(picture, None)
        depth = linear_depth(np.reshape(buffer, nothing.shape).astype(np.float64), camera.far)
        return Shot(picture, np.where(nothing, self._backdrop.depth(camera, eye, world_from_optical), depth))

    def close(self) -> None:
        """Disconnects the client."""
        pybullet.disconnect(physicsClientId=self._client)


def linear_depth(buffer: Floats, far: float) -> Floats:
    """Depth (height, width) [m] along the view from OpenGL's depth buffer, 0 at ``NEAR`` and 1 at ``far`` [m].

    The buffer has even steps of 1 / depth.
    """
    return far * NEAR / (far - (far - NEAR) * buffer)


def _aircraft(shape: AircraftShape, client: int) -> int:
    """All of it at rest, one body a colour, held together by joints that do not move; out of sight until it is placed."""
    by_colour: dict[tuple[float, ...], list[MeshPart]] = {}
    for part in shape.at_rest:
        colour = shape.colour if part.colour is None else tuple(c / 255 for c in part.colour)
        by_colour.setdefault(colour, []).append(part)
    first, *others = (_mesh_shape(*joined(parts), colour, client) for colour, parts in by_colour.items())
    n, nowhere, unturned = len(others), [0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]
    index: int = pybullet.createMultiBody(
        0.0,
        -1,
        first,
        basePosition=[0.0, 0.0, -100.0],
        linkMasses=[0.0] * n,
        linkCollisionShapeIndices=[-1] * n,
        linkVisualShapeIndices=others,
        linkPositions=[nowhere] * n,
        linkOrientations=[unturned] * n,
        linkInertialFramePositions=[nowhere] * n,
        linkInertialFrameOrientations=[unturned] * n,
        linkParentIndices=[0] * n,
        linkJointTypes=[pybullet.JOINT_FIXED] * n,
        linkJointAxis=[[1.0, 0.0, 0.0]] * n,
        physicsClientId=client,
    )
    return index


def _mesh_shape(vertices: Floats, faces: NDArray[Any], colour: tuple[float, ...], client: int) -> int:
    """Each triangle with its own normal, so that edges are seen."""
    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-12)[:, None]
    shape: int = pybullet.createVisualShape(
        pybullet.GEOM_MESH,
        vertices=corners.reshape(-1, 3).tolist(),
        indices=list(range(3 * len(faces))),
        normals=np.repeat(normals, 3, axis=0).tolist(),
        rgbaColor=(*colour, 1.0),
        specularColor=(0, 0, 0),
        physicsClientId=client,
    )
    return shape


def _visual_shape(solid: Solid, client: int) -> int:
    look = {"rgbaColor": (*solid.colour, 1.0), "specularColor": (0, 0, 0), "physicsClientId": client}
    shape: int
    if solid.shape == "box":
        shape = pybullet.createVisualShape(pybullet.GEOM_BOX, halfExtents=[side / 2 for side in solid.size], **look)
    elif solid.shape == "cylinder":
        radius, height = solid.size
        shape = pybullet.createVisualShape(pybullet.GEOM_CYLINDER, radius=radius, length=height, **look)
    elif solid.shape == "sphere":
        shape = pybullet.createVisualShape(pybullet.GEOM_SPHERE, radius=solid.size[0], **look)
    else:
        shape = pybullet.createVisualShape(pybullet.GEOM_MESH, fileName=str(solid.mesh), meshScale=solid.size, **look)
    return shape


def _xyzw(wxyz: Floats) -> list[float]:
    return [float(wxyz[1]), float(wxyz[2]), float(wxyz[3]), float(wxyz[0])]
