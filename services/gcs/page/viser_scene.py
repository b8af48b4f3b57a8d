"""Brings viser's scene to what a picture says, sending only what has changed."""

from collections.abc import Callable, Coroutine, Mapping
from typing import Any

import numpy as np
import trimesh
import viser
from numpy.typing import NDArray
from viser import _messages

from services.gcs.state.vehicle_model import DisplayPose
from services.gcs.view.drawing import Axes, Boxes, FloorPicture, MeshNode, Node, Points, Polyline, TextNode, TexturedNode
from uvf.models.shapes.textured import TexturedMesh

Floats = NDArray[np.float64]

CUBE = np.array([(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)], dtype=np.float32)
_QUADS = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
CUBE_FACES = np.array([t for a, b, c, d in _QUADS for t in ((a, b, c), (a, c, d))], dtype=np.uint32)
MOVED = 1e-3  # m
TURNED = 1e-3  # quaternion components


class ViserScene:
    """Keeps a scene, everybody's or one browser's, in step with the picture.

    on_pick(vehicle, event): called on viser's event loop when a vehicle is clicked.
    """

    def __init__(self, server: viser.ViserServer | viser.ClientHandle, on_pick: Callable[[str, Any], None]) -> None:
        self._server = server
        self._on_pick = on_pick
        self._shown: dict[str, tuple[Node, Any]] = {}
        self._frames: dict[str, tuple[Any, DisplayPose]] = {}

    def show(self, nodes: Mapping[str, Node], places: Mapping[str, DisplayPose]) -> None:
        """Shows these nodes and frames by name, changing only what differs."""
        for name in sorted((n for n in self._shown if n not in nodes), reverse=True):  # children before the node that bears them
            self._shown.pop(name)[1].remove()
        for name in [n for n in reversed(self._frames) if n not in places]:  # what hangs on a frame before the frame
            self._frames.pop(name)[0].remove()
            self._shown = {k: v for k, v in self._shown.items() if not k.startswith(name + "/")}
        for name, place in places.items():
            self._place(name, place)
        for name, node in nodes.items():
            before = self._shown.get(name)
            if before is None:
                self._shown[name] = (node, self._add(name, node))
            elif before[0] is not node:
                self._shown[name] = (node, self._change(name, node, *before))

    def _place(self, name: str, place: DisplayPose) -> None:
        before = self._frames.get(name)
        if before is None:
            handle = self._server.scene.add_frame(name, show_axes=False, wxyz=place.wxyz, position=place.position)
            self._frames[name] = (handle, place)
            return
        handle, old = before
        if place is old:
            return
        moved = float(np.abs(place.position - old.position).max()) > MOVED
        turned = float(np.abs(place.wxyz - old.wxyz).max()) > TURNED
        if moved or turned:
            if not np.array_equal(place.position, old.position):
                _move(handle, place.position)
            if not np.array_equal(place.wxyz, old.wxyz):
                _turn(handle, place.wxyz)
            self._frames[name] = (handle, place)

    def _add(self, name: str, node: Node) -> Any:
        scene = self._server.scene
        match node:
            case MeshNode():
                return self._add_mesh(name, node)
            case TexturedNode():
                return self._add_textured(name, node)
            case Polyline():
                return scene.add_line_segments(name, segments(node.points), node.colour, thickness=node.width, thickness_units="screen")
            case Points():
                return scene.add_point_cloud(
                    name, _f32(node.points), node.colour, point_size=node.size, point_shape="circle", precision="float32"
                )
            case TextNode():
                return scene.add_label(name, node.text, position=node.position, anchor="bottom-center")
            case FloorPicture():
                return self._add_picture(name, node)
            case Axes():
                radii = node.length / 25, node.length / 20
                return scene.add_frame(
                    name, axes_length=node.length, axes_radius=radii[0], origin_radius=radii[1], wxyz=node.wxyz, position=node.position
                )
            case Boxes():
                return self._add_boxes(name, node)

    def _add_boxes(self, name: str, node: Boxes) -> Any:
        turns = np.tile(np.array((1.0, 0.0, 0.0, 0.0), dtype=np.float32), (len(node.sides), 1))
        return self._server.scene.add_batched_meshes_simple(
            name, CUBE, CUBE_FACES, turns, _f32(node.middles), batched_scales=_f32(node.sides), batched_colors=node.colours, lod="off",
            flat_shading=True, cast_shadow=False, receive_shadow=False,
        )  # fmt: skip

    def _add_mesh(self, name: str, node: MeshNode) -> Any:
        opacity = None if node.opacity >= 1 else node.opacity
        handle = self._server.scene.add_mesh_simple(
            name, _f32(node.vertices), node.faces.astype(np.uint32), color=node.colour, opacity=opacity, flat_shading=True, side="double"
        )
        if node.selects:
            handle.on_click(self._picking(node.selects))
        return handle

    def _add_textured(self, name: str, node: TexturedNode) -> Any:
        handle = self._server.scene.add_mesh_trimesh(name, glb_mesh(node.mesh))
        if node.selects:
            handle.on_click(self._picking(node.selects))
        return handle

    def _picking(self, vehicle: str) -> Callable[[Any], Coroutine[Any, Any, None]]:
        async def picked(event: Any) -> None:
            self._on_pick(vehicle, event)

        return picked

    def _add_picture(self, name: str, node: FloorPicture) -> Any:
        wxyz = (float(np.cos(node.yaw / 2)), 0.0, 0.0, float(np.sin(node.yaw / 2)))
        empty = np.zeros((2, 2, 4), dtype=np.uint8)
        handle = self._server.scene.add_image(
            name, empty, node.width, node.height, format="png", cast_shadow=False, receive_shadow=False, wxyz=wxyz, position=node.centre
        )
        handle._data = node.png
        return handle

    def _change(self, name: str, node: Node, old: Node, handle: Any) -> Any:
        match node, old:
            case (Polyline(), Polyline()) if node.colour == old.colour and node.width == old.width:
                handle.points = segments(node.points)
            case (Points(), Points()) if node.colour == old.colour and len(node.points) == len(old.points):
                handle.points = _f32(node.points)
            case (TextNode(), TextNode()):
                self._change_text(node, old, handle)
            case (FloorPicture(), FloorPicture()) if (node.width, node.height, node.centre, node.yaw) == (
                old.width,
                old.height,
                old.centre,
                old.yaw,
            ):
                handle._data = node.png
            case _:
                return self._add(name, node)
        return handle

    def _change_text(self, node: TextNode, old: TextNode, handle: Any) -> None:
        if node.text != old.text:
            handle.text = node.text
        if node.position != old.position:
            _move(handle, np.asarray(node.position))


def _move(handle: Any, position: Floats) -> None:
    """As viser's setter does, which costs three times as much, and lets drop what is less than 1e-5 of the distance from the origin."""
    at = tuple(position.tolist())
    handle._impl.position[:] = at
    handle._impl.api._queue_scene_message(_messages.SetPositionMessage(handle._impl.name, at))


def _turn(handle: Any, wxyz: Floats) -> None:
    """As ``_move``."""
    to = tuple(wxyz.tolist())
    handle._impl.wxyz[:] = to
    handle._impl.api._queue_scene_message(_messages.SetOrientationMessage(handle._impl.name, to))


def segments(points: Floats) -> NDArray[np.float32]:
    """(n, 3) points of a poly-line -> (n - 1, 2, 3) segments."""
    return _f32(np.stack((points[:-1], points[1:]), axis=1))


def _f32(points: Floats) -> NDArray[np.float32]:
    return np.ascontiguousarray(points, dtype=np.float32)


def glb_mesh(mesh: TexturedMesh) -> trimesh.Trimesh:
    """As it goes to a browser: dull, seen from both sides."""
    made: Any = trimesh.visual
    look = made.material.PBRMaterial(baseColorTexture=mesh.picture, metallicFactor=0.0, roughnessFactor=1.0, doubleSided=True)
    return trimesh.Trimesh(mesh.vertices, mesh.faces, visual=made.TextureVisuals(uv=mesh.uv, material=look), process=False)
