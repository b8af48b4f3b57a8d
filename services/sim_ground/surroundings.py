"""What a ground vehicle's rays may meet: the world that stands, what moves in it by script, and the other vehicles' bodies."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from services.sim_ground.body import BodyState
from uvf.maths.bvh import Bvh, build
from uvf.maths.raycast3 import Body
from uvf.maths.rotations import IDENTITY
from uvf.maths.solids import joined
from uvf.maths.transforms import Transform, compose
from uvf.runtime.robot_model import UrdfModel
from uvf.runtime.scene import primitives, scene
from uvf.runtime.solid import Solid, pose_at

Floats = NDArray[np.float64]


class Surroundings:
    """Trees of solids are built once; only poses change."""

    def __init__(self, things: Sequence[Solid], vehicles: Mapping[str, UrdfModel]) -> None:
        self.still = scene(things)
        self._scripted = [(solid, _own_tree(solid)) for solid in things if solid.path is not None]
        self._objects: dict[str, Bvh] = {}
        self._vehicles = {name: vehicle_tree(model) for name, model in vehicles.items()}

    def moving(self, t: float) -> list[Body]:
        """What moves by script, as it stands at simulation time ``t`` [s]."""
        return [Body(tree, *pose_at(solid, t)) for solid, tree in self._scripted]

    def add_vehicle(self, name: str, model: UrdfModel) -> None:
        self._vehicles[name] = vehicle_tree(model)

    def add_object(self, name: str, solid: Solid) -> None:
        self._objects[name] = _own_tree(solid)

    def remove(self, name: str) -> None:
        self._vehicles.pop(name, None)
        self._objects.pop(name, None)

    def objects(self, poses: Mapping[str, tuple[Floats, Floats]]) -> list[Body]:
        """What has been put in, at these poses."""
        return [Body(self._objects[name], *pose) for name, pose in poses.items()]

    def bodies(self, states: Mapping[str, BodyState]) -> dict[str, Body]:
        """The vehicles, where they are."""
        return {name: Body(tree, states[name].position, states[name].world_from_body) for name, tree in self._vehicles.items()}


def _own_tree(solid: Solid) -> Bvh:
    return build(primitives(replace(solid, position=np.zeros(3), orientation=IDENTITY)))


def vehicle_tree(model: UrdfModel) -> Bvh:
    """All collision shapes of a vehicle in its base frame; wheels look the same however they are turned."""
    parts = []
    for name, root_from_link in model.link_poses().items():
        for solid in model.links[name].collisions:
            rotation, translation = compose(root_from_link, Transform(solid.orientation, solid.position))
            parts.append(primitives(replace(solid, position=translation, orientation=rotation)))
    return build(joined(parts))
