"""From what is known to what is drawn. A node stays the same object until what it shows has changed."""

from collections.abc import Iterator, Set

import numpy as np
from numpy.typing import NDArray

from services.gcs.state.state import Model
from services.gcs.state.vehicle_model import DisplayPose, VehicleModel
from services.gcs.view.drawing import Colour, Node, TexturedNode
from services.gcs.view.scene import bodies
from services.gcs.view.scene.estimate_layers import EstimateLayers
from services.gcs.view.scene.map_layers import MapLayers
from services.gcs.view.scene.moving_links import MovingLinks
from services.gcs.view.scene.moving_parts import MovingParts
from services.gcs.view.scene.node_cache import NodeCache
from services.gcs.view.scene.scenery import coloured, moving, places_of, rgb_of, scenery
from services.gcs.view.scene.spawned import Spawned
from services.gcs.view.scene.way_layers import WayLayers
from services.gcs.view.scene.windsocks import sock_nodes, sock_places
from uvf.models.aircraft.shape import AircraftShape, aircraft_shape
from uvf.models.shapes.mesh_parts import MeshPart
from uvf.models.urdf.model import load_urdf

Floats = NDArray[np.float64]

GHOST: Colour = (190, 200, 215)
SHOWN_SIZE, MOST_SCALE = 8.5, 4.0  # m
"""Small aircraft are drawn larger than they are, to be seen from where their whole circuit is."""
LEVEL = np.array((1.0, 0.0, 0.0, 0.0))


class SceneView:
    """Draws the state of the ground station; caches the nodes it has made by what they were made from."""

    def __init__(self, model: Model) -> None:
        self._model = model
        self._nodes = NodeCache()
        self._maps, self._estimates, self._ways = MapLayers(self._nodes), EstimateLayers(self._nodes), WayLayers(self._nodes)
        self._surroundings = scenery(model.site.world)
        self._surroundings |= sock_nodes(model.site.world.windsocks)
        self._scripted = moving(model.site.world)
        self._bodies: dict[str, dict[str, Node]] = {}
        self._ghosts: dict[str, dict[str, Node]] = {}
        self._moving: dict[str, MovingParts | MovingLinks] = {}
        self._learn()
        self._spawned = Spawned(model)

    def _learn(self) -> None:
        """What the vehicles look like; external vehicles come later, and go."""
        for name in self._bodies.keys() - self._model.vehicles.keys():
            for known in (self._bodies, self._ghosts, self._moving):
                known.pop(name, None)
        for v in [v for v in self._model.vehicles.values() if v.name not in self._bodies]:
            shape = _shape(v) if v.flies else None
            self._bodies[v.name], self._moving[v.name] = _body(v, shape)
            self._ghosts[v.name] = coloured(_parts(v, shape), GHOST, v.name)

    def nodes(self, t: float) -> dict[str, Node]:
        """All scene nodes at ``t`` [s, wall], by name; ``/vehicles/<v>/...`` is given in that vehicle's frame."""
        self._learn()
        layers = self._model.layers
        shown = {k: n for k, n in self._surroundings.items() if "Walls" in layers or not k.startswith("/world/walls/")}
        shown |= self._spawned.nodes()
        for vehicle in self._model.vehicles.values():
            shown.update(self._of_vehicle(vehicle, layers, t))
        self._nodes.sweep()
        return shown

    def places(self) -> dict[str, DisplayPose]:
        """Poses of the frames of vehicles and of what moves by script, by node name."""
        self._learn()
        layers = self._model.layers
        placed = places_of(self._scripted, self._model.sim_time) | self._spawned.places()
        placed |= sock_places(self._model.site.world.windsocks, self._model.windsocks)
        for v in self._model.vehicles.values():
            if v.place is not None:
                placed[f"/vehicles/{v.name}"] = v.place
                moving = self._moving[v.name].places(v.joints)
                placed |= {f"/vehicles/{v.name}/{part}": place for part, place in moving.items()}
                if v.flies:
                    placed[f"/height/{v.name}"] = DisplayPose(v.place.position, LEVEL)
                placed |= {f"/frame/{v.name}/body": v.place} if "Frames" in layers else {}
                placed |= {f"/sigma/{v.name}": DisplayPose(v.place.position, LEVEL)} if "Uncertainty" in layers else {}
            if v.true_place is not None and "True pose" in layers:
                placed[f"/true/{v.name}"] = v.true_place
        return placed

    def _of_vehicle(self, v: VehicleModel, layers: Set[str], t: float) -> Iterator[tuple[str, Node]]:
        if v.place is not None:
            yield from ((f"/vehicles/{v.name}/{part}", node) for part, node in self._bodies[v.name].items())
        if v.true_place is not None and "True pose" in layers:
            yield from ((f"/true/{v.name}/{part}", node) for part, node in self._ghosts[v.name].items())
        for what, (layer, draw) in {**self._maps.of(v, t), **self._estimates.of(v, t), **self._ways.of(v)}.items():
            if layer in layers:
                yield from ((f"/{what}/{v.name}{suffix}", node) for suffix, node in draw().items())


def _shape(v: VehicleModel) -> AircraftShape:
    """As large as it is drawn."""
    shape = aircraft_shape(v.member.folder, v.member.file)
    size = float(np.ptp(shape.bounds, axis=0).max())
    return shape.scaled(min(max(SHOWN_SIZE / size, 1.0), MOST_SCALE))


def _body(v: VehicleModel, shape: AircraftShape | None) -> tuple[dict[str, Node], MovingParts | MovingLinks]:
    """Its nodes, and what moves them: surfaces, and what is steered or moved by other joints, are drawn in frames of their own."""
    moves: MovingParts | MovingLinks
    if shape is None:
        body = v.member.file.ground
        assert body is not None
        model = load_urdf(v.member.folder / body.urdf)
        moves = MovingLinks(model, [name for name in body.turning_joints if name not in body.drive.joints])
        parts = bodies.rover_parts(model, moves.places(None))
    else:
        moves = MovingParts(shape.movables)
        groups = {bodies.FAST: shape.fixed + shape.undercarriage, **{part.name: part.parts for part in shape.movables}}
        parts = {name: bodies.DrawnParts(group) for name, group in groups.items()}
    drawn: dict[str, Node] = {}
    for name, group in parts.items():
        drawn |= {f"{name}/{i}".lstrip("/"): node for i, node in coloured(group.plain, rgb_of(v.colour), v.name).items()}
        drawn |= {f"{name}/picture_{i}".lstrip("/"): TexturedNode(mesh, v.name) for i, mesh in enumerate(group.pictured)}
    return drawn, moves


def _parts(v: VehicleModel, shape: AircraftShape | None) -> list[MeshPart]:
    """All of it, at rest."""
    if shape is not None:
        return shape.at_rest
    assert v.member.file.ground is not None
    return bodies.rover(v.member.folder / v.member.file.ground.urdf)
