"""Who and what is in the ground simulation, and the requests that change it: spawn, remove, set pose, save, restore."""

import copy
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from schemas.messages import RemoveRequest, Reply, SetPoseRequest, SimObject, SimObjects, SpawnRequest, StateRequest
from services.sim_ground.loading import BodyPlacement
from services.sim_ground.rig import Rig
from uvf.models.shapes.solid import Solid
from uvf.models.urdf.robot import UrdfModel
from uvf.models.yaml_data import BadInput, listed, nearest
from uvf.runtime.messages.convert import array, quaternion, stamp, vector, yaw_of
from uvf.runtime.messages.spawned import body_fault, crowd_fault, name_fault, pose_fault, solid_of, unit_wxyz
from uvf.sensors.surroundings import Surroundings, vehicle_tree

Floats = NDArray[np.float64]
SAVED_MOST = 16


class Stageable(Protocol):
    """The part of the physics that the requests need."""

    def put(self, name: str, solid: Solid, mass: float) -> str:
        """Adds a solid of ``mass`` [kg], 0 = fixed. Returns what it would stand in, "" when it is added."""
        ...

    def put_vehicle(self, name: str, vehicle: BodyPlacement) -> str:
        """Adds a vehicle. Returns what it would stand in, "" when it is added. Raises BadInput."""
        ...

    def remove(self, name: str) -> None:
        """Removes a solid or a vehicle."""
        ...

    def place(self, name: str, position: Floats, orientation: Floats) -> str:
        """Puts it at ``position`` (3,) [m, world], ``orientation`` (4,) wxyz, at rest. Returns what it would stand in, "" when done."""
        ...

    def poses(self) -> dict[str, tuple[Floats, Floats]]:
        """Position (3,) [m, world] and orientation (4,) wxyz of each added solid, by name."""
        ...

    def save(self) -> Any:
        """Saves the state of the engine."""
        ...

    def restore(self, saved: Any) -> None:
        """Restores a saved state."""
        ...

    def forget(self, saved: Any) -> None:
        """Releases a saved state."""
        ...


class JoiningVehicle(NamedTuple):
    """A new vehicle ready to be added."""

    placed: BodyPlacement
    rig: Rig
    model: UrdfModel


Join = Callable[[str, str, tuple[float, float, float], float], JoiningVehicle]
"""From a new name, a folder in vehicles/, a start x, y [m], yaw [rad], and z [m] of what it stands on. Raises BadInput."""


@dataclass(frozen=True)
class SavedState:
    """A saved state: the engine's, the sensors', the step at which it was saved, and the spawned objects by name and number."""

    world: Any
    rigs: dict[str, Rig]
    step: int
    objects: dict[str, int]


class GroundStage:
    """The vehicles and objects of the simulation. Requests are carried out in the order spawn, remove, set pose, save, restore."""

    def __init__(self, world: Stageable, rigs: Mapping[str, Rig], surroundings: Surroundings, taken: tuple[str, ...], join: Join) -> None:
        """taken: names of what is there from the beginning, of vehicles that others simulate too."""
        self.rigs = dict(rigs)
        self.late = 0
        """Steps by which the sensors' time is behind the clock, because of states that were restored."""
        self.told: set[str] = set()
        """Vehicles whose frames have been told."""
        self._world = world
        self._surroundings = surroundings
        self._taken = taken
        self._join = join
        self._objects: dict[str, SimObject] = {}
        self._numbers: dict[str, int] = {}
        self._spawned = 0
        self._kept: dict[str, SavedState] = {}

    def spawn(self, request: SpawnRequest, others: Collection[str]) -> Reply:
        """Adds an object or a vehicle. others: names of what the air simulator has spawned."""
        wanted = request.object
        reason = self._name_fault(wanted.name, others) or crowd_fault(len(self._objects) + len(others)) or body_fault(wanted)
        if not reason:
            try:
                reason = self._put_vehicle(wanted) if wanted.model else self._put(wanted)
            except BadInput as error:
                reason = str(error)
        if not reason:
            self._objects[wanted.name] = copy.deepcopy(wanted)
            self._spawned += 1
            self._numbers[wanted.name] = self._spawned
        return _reply(reason)

    def _name_fault(self, name: str, others: Collection[str]) -> str:
        if fault := name_fault(name):
            return fault
        if name in self._objects or name in self._taken or name in others:
            return f"there is a '{name}' already; take another name"
        return ""

    def _put(self, wanted: SimObject) -> str:
        solid = solid_of(wanted)
        if met := self._world.put(wanted.name, solid, wanted.mass):
            return _inside(wanted.name, met)
        self._surroundings.add_object(wanted.name, solid)
        return ""

    def _put_vehicle(self, wanted: SimObject) -> str:
        position = wanted.pose.position
        start = (position.x, position.y, yaw_of(wanted.pose.orientation))
        placed, rig, model = self._join(wanted.name, wanted.model, start, position.z)
        if met := self._world.put_vehicle(wanted.name, placed):
            return _inside(wanted.name, met)
        self._surroundings.add_vehicle(wanted.name, vehicle_tree(model))
        self.rigs[wanted.name] = rig
        return ""

    def remove(self, request: RemoveRequest) -> Reply:
        """Removes what has been spawned."""
        name = request.name
        if name not in self._objects:
            if name in self._taken:
                return _reply(f"'{name}' belongs to the mission; only what has been spawned can be removed")
            return _reply(f"there is no '{name}'; {nearest(name, self._objects)}")
        self._take_out(name)
        return _reply("")

    def _take_out(self, name: str) -> None:
        self._world.remove(name)
        self._surroundings.remove(name)
        self.rigs.pop(name, None)
        self.told.discard(name)
        del self._objects[name], self._numbers[name]

    def set_pose(self, request: SetPoseRequest) -> Reply:
        """Puts a vehicle or an object elsewhere, at rest."""
        known = {**self._objects, **self.rigs}
        if request.name not in known:
            return _reply(f"there is no '{request.name}' that can be put elsewhere; {nearest(request.name, known)}")
        if fault := pose_fault(request.pose):
            return _reply(fault)
        met = self._world.place(request.name, array(request.pose.position), unit_wxyz(request.pose))
        return _reply(_inside(request.name, met) if met else "")

    def save(self, step: int, request: StateRequest) -> Reply:
        """Saves the state after the service's ``step``."""
        if request.name not in self._kept and len(self._kept) >= SAVED_MOST:
            return _reply(f"{SAVED_MOST} states are kept already: {listed(self._kept)}; use one of these names again")
        if request.only_ask:
            return _reply("")
        if request.name in self._kept:
            self._world.forget(self._kept[request.name].world)
        self._kept[request.name] = SavedState(self._world.save(), copy.deepcopy(self.rigs), step - self.late, dict(self._numbers))
        return _reply("")

    def restore(self, step: int, request: StateRequest) -> Reply:
        """Restores a saved state at the service's ``step``: what was spawned since is removed.

        It is refused when something was removed since, which cannot come back.
        """
        kept = self._kept.get(request.name)
        if kept is None:
            return _reply(f"no state '{request.name}' has been saved; {nearest(request.name, self._kept)}")
        if gone := [name for name, number in kept.objects.items() if self._numbers.get(name) != number]:
            return _reply(f"'{gone[0]}' has been removed since '{request.name}' was saved; a state needs all that was there")
        if request.only_ask:
            return _reply("")
        for name in [name for name in self._objects if name not in kept.objects]:
            self._take_out(name)
        self._world.restore(kept.world)
        self.rigs = copy.deepcopy(kept.rigs)
        self.late = step - kept.step
        return _reply("")

    def objects(self, t: float) -> SimObjects:
        """All spawned objects as they stand at ``t`` [s]; vehicles where they were spawned, for their truth is published elsewhere."""
        poses = self._world.poses()
        for name, (position, orientation) in poses.items():
            self._objects[name].pose.position.CopyFrom(vector(position))
            self._objects[name].pose.orientation.CopyFrom(quaternion(orientation))
        return SimObjects(timestamp=stamp(t), objects=self._objects.values())


def _inside(name: str, met: str) -> str:
    return f"'{name}' would stand in '{met}' there; choose another place"


def _reply(reason: str) -> Reply:
    return Reply(accepted=not reason, reason=reason)
