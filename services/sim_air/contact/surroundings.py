"""What is about the aircraft: the world, what moves in it, ground vehicles where they truly are, and the other aircraft."""

from collections.abc import Callable, Mapping, Sequence

from schemas.messages import NavState, SimObject, SimObjects
from services.sim_air.engine.states import AircraftMotion
from services.sim_air.environment.ground import GroundSurface
from uvf.maths.bvh import Bvh
from uvf.maths.raycast import MovingBody
from uvf.models.shapes.solid import Solid
from uvf.runtime.messages.convert import array, wxyz
from uvf.runtime.messages.spawned import solid_of, sound_objects, unit_wxyz
from uvf.sensors.surroundings import Surroundings, Whereabouts


class Around:
    """The obstacles about the aircraft, computed on demand once a step."""

    def __init__(
        self, things: Sequence[Solid], ground: GroundSurface, vehicles: Mapping[str, Bvh], tree_of: Callable[[str], Bvh | None]
    ) -> None:
        """things: of the world; ground: they; vehicles: the shapes of all; tree_of: that of a vehicle model that is put in later;
        None where this host has none that stands on the ground."""
        self.things = things
        self.shapes = vehicles
        self.ground = ground
        self._surroundings = Surroundings(things, vehicles, ground.scene)
        self._scripted = any(thing.path is not None for thing in things)
        self.still = self._surroundings.still
        self._tree_of = tree_of
        self._put_in: dict[str, tuple[str, tuple[float, ...]]] = {}
        self._t = 0.0
        self._objects: list[SimObject] = []
        self._truth: Mapping[str, NavState] = {}
        self._aircraft: Mapping[str, AircraftMotion] = {}
        self._bodies: dict[str, MovingBody] | None = None

    def add_aircraft(self, name: str, shape: Bvh) -> None:
        """Adds an aircraft with its shape."""
        self._surroundings.add_vehicle(name, shape)

    def remove_aircraft(self, name: str) -> None:
        """Removes an aircraft."""
        self._surroundings.remove(name)

    def look(self, t: float, truth: Mapping[str, NavState], objects: SimObjects | None, aircraft: Mapping[str, AircraftMotion]) -> None:
        """Sets the situation at ``t`` [s]: ground vehicles by their newest truth, aircraft by their motion."""
        self._t, self._truth, self._objects, self._aircraft = t, truth, sound_objects(objects), aircraft
        self._bodies = None

    @property
    def crowded(self) -> bool:
        """Whether more than one thing may move."""
        return self._scripted or len(self._aircraft.keys() | self._truth.keys()) + len(self._objects) > 1

    def bodies(self) -> dict[str, MovingBody]:
        """All moving bodies, by name."""
        if self._bodies is None:
            self._take_in()
            placed = {o.name: (array(o.pose.position), unit_wxyz(o.pose)) for o in self._objects if not o.model}
            told = {n: Whereabouts(array(v.position), wxyz(v.orientation)) for n, v in self._truth.items() if n not in self._aircraft}
            s = self._surroundings
            self._bodies = {**s.moving(self._t), **s.objects(placed), **s.bodies(told), **s.bodies(self._aircraft)}
        return self._bodies

    def others(self, name: str) -> list[MovingBody]:
        """The moving bodies other than the named aircraft."""
        return [body for other, body in self.bodies().items() if other != name]

    def _take_in(self) -> None:
        """What has come into the running simulation since, and gone."""
        now = {o.name: (o.model or o.shape, tuple(o.size)) for o in self._objects}
        for name in [name for name, kind in self._put_in.items() if now.get(name) != kind]:
            self._surroundings.remove(name)
        for o in self._objects:
            if self._put_in.get(o.name) == now[o.name]:
                continue
            if not o.model:
                self._surroundings.add_object(o.name, solid_of(o))
            elif (tree := self._tree_of(o.model)) is not None:
                self._surroundings.add_vehicle(o.name, tree)
        self._put_in = now
