"""What a vehicle's rays may meet: the world that stands, what moves in it by script, and the other vehicles' bodies."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.bvh import Bvh, build
from uvf.maths.raycast import MovingBody, Scene
from uvf.maths.rotations import IDENTITY
from uvf.maths.se3 import Transform, compose
from uvf.maths.solids import joined, mesh
from uvf.models.aircraft.shape import AircraftShape
from uvf.models.generated_file import mesh_file
from uvf.models.shapes.mesh_parts import joined as joined_parts
from uvf.models.shapes.scene import primitives, scene
from uvf.models.shapes.solid import Solid, pose_at
from uvf.models.urdf.robot import UrdfModel
from uvf.sensors.body_track import PosedBody

Floats = NDArray[np.float64]


class Whereabouts(NamedTuple):
    """Pose in the world: position (3,) [m], attitude world_from_body wxyz (4,)."""

    position: Floats
    world_from_body: Floats


class Surroundings:
    """All that a vehicle's rays may meet. Trees of solids are built once; only poses change."""

    def __init__(self, things: Sequence[Solid], vehicles: Mapping[str, Bvh], still: Scene | None = None) -> None:
        """vehicles: their collision shapes in their own frames; still: the scene of the things, where it is there already."""
        self.still = still or scene(things)
        self._scripted = [(solid, own_tree(solid)) for solid in things if solid.path is not None]
        self._objects: dict[str, Bvh] = {}
        self._vehicles = dict(vehicles)

    def moving(self, t: float) -> dict[str, MovingBody]:
        """Bodies that move by script, by name, where they are at simulation time ``t`` [s]."""
        return {solid.name: MovingBody(tree, *pose_at(solid, t)) for solid, tree in self._scripted}

    def add_vehicle(self, name: str, tree: Bvh) -> None:
        """Adds a vehicle by its collision shapes in its own frame, or replaces them."""
        self._vehicles[name] = tree

    def add_object(self, name: str, solid: Solid) -> None:
        """Adds an object that was put into the simulation, or replaces it."""
        self._objects[name] = own_tree(solid)

    def remove(self, name: str) -> None:
        """Takes out the vehicle or object of this name, if there is one."""
        self._vehicles.pop(name, None)
        self._objects.pop(name, None)

    def objects(self, poses: Mapping[str, tuple[Floats, Floats]]) -> dict[str, MovingBody]:
        """Objects that were put in, by name, at these poses: positions (3,) [m] and attitudes wxyz (4,), world."""
        return {name: MovingBody(self._objects[name], *pose) for name, pose in poses.items()}

    def bodies(self, states: Mapping[str, PosedBody]) -> dict[str, MovingBody]:
        """Vehicles whose state is known, by name."""
        known = ((name, tree, states[name]) for name, tree in self._vehicles.items() if name in states)
        return {name: MovingBody(tree, state.position, state.world_from_body) for name, tree, state in known}


def own_tree(solid: Solid) -> Bvh:
    """Tree of one solid in its own frame."""
    return build(primitives(replace(solid, position=np.zeros(3), orientation=IDENTITY)))


def vehicle_tree(model: UrdfModel) -> Bvh:
    """Tree of all collision shapes of a vehicle in its root frame; wheels look the same however they are turned."""
    parts = []
    for name, root_from_link in model.link_poses().items():
        for solid in model.links[name].collisions:
            rotation, translation = compose(root_from_link, Transform(solid.orientation, solid.position))
            parts.append(primitives(replace(solid, position=translation, orientation=rotation)))
    return build(joined(parts))


def aircraft_tree(shape: AircraftShape) -> Bvh:
    """Tree of an aircraft in its body frame without its wheels, whose contacts the flight simulator computes."""
    vertices, faces = joined_parts(shape.airborne)
    return build(mesh(vertices, faces, np.zeros(3), IDENTITY))


def aircraft_solid(name: str, shape: AircraftShape) -> Solid:
    """Solid of an aircraft with its wheels, as a mesh file, for engines that read files."""
    return Solid(name, "mesh", (1.0, 1.0, 1.0), np.zeros(3), mesh=mesh_file(name, *joined_parts(shape.at_rest)))
