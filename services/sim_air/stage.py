"""Who is in the air simulation, and the requests that change it: spawn, remove, set pose, save, restore."""

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from schemas.messages import RemoveRequest, Reply, SetPoseRequest, SimObject, SimObjects, SpawnRequest, StateRequest, WindRequest
from services.sim_air.aircraft import Aircraft, SavedAircraft
from services.sim_air.contact.collisions import Collisions
from services.sim_air.contact.surroundings import Around
from services.sim_air.environment.windsocks import Windsocks
from services.sim_air.placing import fault_of, place, start_of
from uvf.maths.bvh import Bvh
from uvf.models.mission import file as mission_file
from uvf.models.yaml_data import BadInput, listed, nearest
from uvf.runtime.messages.convert import array, quaternion, stamp, vector
from uvf.runtime.messages.spawned import crowd_fault, name_fault

SAVED_MOST = 16
STRONGEST = 60.0  # m/s, a hurricane's


Floats = NDArray[np.float64]


class JoiningAircraft(NamedTuple):
    """A new aircraft ready to be added, and its shape."""

    aircraft: Aircraft
    shape: Bvh


Join = Callable[[str, str, mission_file.StartPose], JoiningAircraft]
"""From a new name, a folder in vehicles/ and where it begins. Raises BadInput."""


@dataclass(frozen=True)
class KeptWorld:
    """A saved state: all aircraft, the spawned ones with their shapes, and the step at which it was saved."""

    aircraft: dict[str, SavedAircraft]
    spawned: dict[str, tuple[SimObject, Bvh]]
    step: int


class AirStage:
    """The aircraft of the simulation. Requests are carried out in the order spawn, remove, set pose, save, restore."""

    def __init__(self, aircraft: Mapping[str, Aircraft], around: Around, taken: tuple[str, ...], join: Join, windsocks: Windsocks) -> None:
        """taken: names of what is there from the beginning, of vehicles that others simulate too."""
        self.aircraft = dict(aircraft)
        self.around = around
        self.windsocks = windsocks
        self.collisions = Collisions(around)
        self.late = 0
        """Steps by which the aircraft's time is behind the clock, because of states that were restored."""
        self.told: set[str] = set()
        """Aircraft whose frames have been told."""
        self._steady: Floats | None = None
        """The mean wind that somebody has asked for; None: that of the mission."""
        self._taken = taken
        self._join = join
        self._spawned: dict[str, tuple[SimObject, Bvh]] = {}
        self._kept: dict[str, KeptWorld] = {}

    def blow(self, request: WindRequest) -> Reply:
        """Lets another mean wind blow, also about those that come later."""
        steady = array(request.velocity)
        if np.linalg.norm(steady) > STRONGEST:
            return Reply(reason=f"a wind of {np.linalg.norm(steady):.0f} m/s; give {STRONGEST:g} m/s at most")
        self._steady = steady
        self.windsocks.blow(steady)
        for craft in self.aircraft.values():
            craft.blow(steady)
        return Reply(accepted=True)

    def spawn(self, t: float, request: SpawnRequest, others: Collection[str]) -> Reply:
        """Adds an aircraft at ``t`` [s]. others: names of what the ground simulator has spawned."""
        wanted = request.object
        asked = SetPoseRequest(name=wanted.name, pose=wanted.pose, speed=request.speed)
        if fault := self._name_fault(wanted.name, others) or crowd_fault(len(self._spawned) + len(others)) or fault_of(asked):
            return Reply(reason=fault)
        try:
            joining = self._join(wanted.name, wanted.model, start_of(asked))
        except BadInput as error:
            return Reply(reason=str(error))
        joining.aircraft.wait_until(t)
        self._put_in(joining.aircraft, wanted, joining.shape)
        return Reply(accepted=True)

    def _name_fault(self, name: str, others: Collection[str]) -> str:
        if fault := name_fault(name):
            return fault
        if name in self.aircraft or name in self._taken or name in others:
            return f"there is a '{name}' already; take another name"
        return ""

    def _put_in(self, craft: Aircraft, told: SimObject, shape: Bvh) -> None:
        self.aircraft[craft.name] = craft
        if self._steady is not None:
            craft.blow(self._steady)
        self._spawned[craft.name] = (SimObject(name=craft.name, model=told.model), shape)
        self.around.add_aircraft(craft.name, shape)
        self.collisions.add(craft.name, shape)

    def remove(self, request: RemoveRequest) -> Reply:
        """Removes a spawned aircraft."""
        name = request.name
        if name not in self._spawned:
            if name in self.aircraft:
                return Reply(reason=f"'{name}' belongs to the mission; only what has been spawned can be removed")
            return Reply(reason=f"there is no '{name}' in the air simulation; {nearest(name, self._spawned)}")
        self._take_out(name)
        return Reply(accepted=True)

    def _take_out(self, name: str) -> None:
        self.around.remove_aircraft(name)
        self.collisions.remove(name)
        self.told.discard(name)
        del self.aircraft[name], self._spawned[name]

    def set_pose(self, request: SetPoseRequest) -> Reply:
        """Puts an aircraft elsewhere."""
        reply = place(self.aircraft, request)
        if reply.accepted:
            self.collisions.forget(request.name)
        return reply

    def save(self, step: int, request: StateRequest) -> Reply:
        """Saves the state after the service's ``step``. The aircraft continue from the saved state, to the last bit."""
        if request.name not in self._kept and len(self._kept) >= SAVED_MOST:
            return Reply(reason=f"{SAVED_MOST} states are kept already: {listed(self._kept)}; use one of these names again")
        if not request.only_ask:
            kept = KeptWorld({name: craft.keep() for name, craft in self.aircraft.items()}, dict(self._spawned), step - self.late)
            self._kept[request.name] = kept
            self._go_on_from(kept)
        return Reply(accepted=True)

    def restore(self, step: int, request: StateRequest) -> Reply:
        """Restores a saved state at the service's ``step``: aircraft spawned since are removed, those removed since are there again."""
        kept = self._kept.get(request.name)
        if kept is None:
            return Reply(reason=f"no state '{request.name}' of the air simulation has been saved; {nearest(request.name, self._kept)}")
        if not request.only_ask:
            for name in list(self._spawned):
                self._take_out(name)
            self._go_on_from(kept)
            for name, (told, shape) in kept.spawned.items():
                self._put_in(self.aircraft[name], told, shape)
            self.late = step - kept.step
        return Reply(accepted=True)

    def _go_on_from(self, kept: KeptWorld) -> None:
        self.aircraft = {name: one.again() for name, one in kept.aircraft.items()}
        for name in self.aircraft:
            self.collisions.forget(name)

    def objects(self, t: float) -> SimObjects:
        """The spawned aircraft as they are at ``t`` [s]."""
        for name, (told, _) in self._spawned.items():
            motion = self.aircraft[name].motion
            told.pose.position.CopyFrom(vector(motion.position))
            told.pose.orientation.CopyFrom(quaternion(motion.world_from_body))
        return SimObjects(timestamp=stamp(t), objects=[told for told, _ in self._spawned.values()])
