"""Gazebo worlds and models (SDF 1.4 to 1.11) as world files: what vehicles bump into, at rest, with plain colours."""

import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import msgspec
import numpy as np
from numpy.typing import NDArray

from uvf.maths.se3 import IDENTITY, Transform, compose
from uvf.models.importing.heights import HOME
from uvf.models.importing.mesh_files import MeshStore
from uvf.models.importing.notes import Notes
from uvf.models.importing.sdf.colours import visual_colour
from uvf.models.importing.sdf.ground import SdfGround
from uvf.models.importing.sdf.heightmap import Heightmaps
from uvf.models.importing.sdf.models import Models, read_sdf
from uvf.models.importing.sdf.poses import Scope, numbers, place_of, relative_to, transform
from uvf.models.importing.sdf.shapes import Named, Shapes, Thing, is_level
from uvf.models.importing.sdf.state import NOTHING_SAVED, ModelState, deleted, saved_states
from uvf.models.world.file import Colour, Look, Origin, WorldFile
from uvf.models.world.wind import Wind
from uvf.models.yaml_data import BadInput

Floats = NDArray[np.float64]

VEHICLE_PLUGIN = re.compile(
    r"(diff|ackermann|velocity|mecanum|tricycle).?(drive|steer|control)|skid.?steer|planar.?move|multicopter|quadrotor", re.I
)
DROPPED = {
    "light": "lights are not simulated",
    "actor": "actors are left out; a box or cylinder with a path does the same",
    "plugin": "plugins are not run",
    "road": "roads are only seen; write fields instead",
    "population": "populations are left out",
    "gui": "the view is not taken over",
}


class _Placed(NamedTuple):
    """A model in the world: its element, frames, name with its owners' in front, pose, and what was saved of it."""

    element: Any
    scope: Scope
    path: str
    world_from_model: Transform
    state: ModelState


class SdfImport:
    """Reads one SDF file into a world of ``folder``."""

    def __init__(self, path: Path, folder: Path, searched: Sequence[Path] = (), upright: bool = False) -> None:
        self.notes = Notes()
        self._path = path
        self._folder = folder
        self._models = Models(path, searched, self.notes)
        self._shapes = Shapes(MeshStore(folder, self.notes, upright), self._models.find, self.notes)
        self._planes: list[tuple[float, Colour | None]] = []
        self._heightmaps = Heightmaps(folder, self._models.find, self.notes)
        self._looks: list[Look] = []
        self._names: set[str] = set()
        self._states: dict[str, ModelState] = {}

    def world(self) -> WorldFile:
        """The world file; its meshes are already in the folder. Raises BadInput."""
        root = read_sdf(self._path)
        found = root.find("world")
        element = root if found is None else found
        for insertion in element.findall("state/insertions"):
            element.extend(insertion.findall("model") + insertion.findall("include"))
        has_models = any(True for _ in element.iter("model", "include"))
        self._models.expand(element)
        self._states = saved_states(element)
        self._tell_dropped(root, element)
        gone = deleted(element)
        scope = Scope(element, self.notes)
        things = [
            thing
            for model in element.findall("model")
            if model.get("name") not in gone
            for thing in self._model(self._placed(model, scope, ("", IDENTITY)))
        ]
        has_ground = bool(self._planes) or self._models.names_ground or self._heightmaps.terrain is not None
        if has_models and not things and not has_ground:
            raise BadInput(f"{self._path}: nothing in it can be taken over{self._why()}")
        if not things and self._heightmaps.terrain is None:
            self.notes.add("nothing stands in this world; what a launch file spawns is not in it: wrap that in a world of its own")
        first = element.find("model")
        about = f"Imported from {self._path.name}: {element.get('name') or ('' if first is None else first.get('name'))}."
        ground, settings = SdfGround(self._folder, self.notes), self._settings(element, about)
        settings = msgspec.structs.replace(settings, looks=self._looks)
        if self._heightmaps.terrain is not None:
            return ground.on_terrain(settings, things, self._heightmaps.terrain, self._heightmaps.lowest)
        return ground.levelled(settings, things, self._planes, self._models.names_ground)

    def _why(self) -> str:
        said = self.notes.lines()
        return f": {'; '.join(said)}" if said else ""

    def _placed(self, model: Any, around: Scope, owner: tuple[str, Transform]) -> _Placed:
        """A model of ``around`` where it was when saved, else where the file puts it; owner: its path with ``::`` and world_from_owner."""
        name = model.get("name", "model")
        path, world_from_owner = owner
        state = self._states.get(path + name, NOTHING_SAVED)
        at = state.pose or compose(world_from_owner, around.pose(name))
        return _Placed(model, around.inner(name), path + name, at, state)

    def _model(self, model: _Placed) -> Iterator[Thing]:
        if any(VEHICLE_PLUGIN.search(f"{p.get('filename')} {p.get('name')}") for p in model.element.iter("plugin")):
            self.notes.add("vehicles are not part of a world; 'uvf vehicle' takes them", model.path)
            return
        models = (model.element, *model.element.iterancestors("model"))
        if model.element.find("link") is not None and not any(_true(e.findtext("static")) for e in models):
            self.notes.add("models that could be pushed stand still here", model.path)
        for link in model.element.findall("link"):
            yield from self._link(model, link)
        for inner in model.element.findall("model"):
            yield from self._model(self._placed(inner, model.scope, (f"{model.path}::", model.world_from_model)))

    def _link(self, model: _Placed, link: Any) -> Iterator[Thing]:
        name = link.get("name", "link")
        world_from_link = model.state.links.get(name) or compose(model.world_from_model, model.scope.pose(name))
        collisions, visuals = link.findall("collision"), link.findall("visual")
        looks = [look for visual in visuals for look in self._look(model, visual, world_from_link)]
        self._looks += looks
        if visuals and not collisions and not looks:
            self.notes.add("parts that are only seen and not touched are left out", f"{model.path}::{name}")
        for i, collision in enumerate(collisions):
            for thing in self._collision(model, collision, (world_from_link, self._name(model, link, i), visuals)):
                yield msgspec.structs.replace(thing, hidden=bool(looks))

    def _look(self, model: _Placed, visual: Any, world_from_link: Transform) -> list[Look]:
        """Of a visual that is a mesh; plain shapes are shown by what they stand for."""
        if visual.find("geometry/mesh") is None:
            return []
        pose = visual.find("pose")
        frame = relative_to(pose)
        owner = world_from_link if not frame else compose(model.world_from_model, model.scope.pose(frame))
        colour = visual_colour(visual) if visual.find("material/pbr/metal/albedo_map") is None else None
        return self._shapes.looks(visual, compose(owner, transform(pose)), Named(model.path, colour, model.state.scale))

    def _collision(self, model: _Placed, collision: Any, of_link: tuple[Transform, str, list[Any]]) -> Iterator[Thing]:
        world_from_link, name, visuals = of_link
        pose, geometry = collision.find("pose"), collision.find("geometry")
        frame = relative_to(pose)
        owner = world_from_link if not frame else compose(model.world_from_model, model.scope.pose(frame))
        at = compose(owner, transform(pose))
        bits = (collision.findtext("surface/contact/collide_bitmask") or "1").strip().lower()
        if geometry is None or not bits.removeprefix("0x").strip("0"):
            self.notes.add("collisions without a shape or that touch nothing are left out", name)
            return
        colour = self._colour(collision, visuals)
        plane = geometry.find("plane")
        if plane is not None and is_level(plane, at):
            self._planes.append((float(at.translation[2]), colour))
            return
        heightmap = geometry.find("heightmap")
        if heightmap is not None:
            self._heightmaps.take(heightmap, at, name)
            return
        yield from self._shapes.things(geometry, at, Named(name, colour, model.state.scale))

    def _colour(self, collision: Any, visuals: list[Any]) -> Colour | None:
        """Of the visual of the same link that lies where the collision lies."""
        if not visuals:
            return None
        here = transform(collision.find("pose")).translation
        nearest = min(visuals, key=lambda v: float(np.linalg.norm(transform(v.find("pose")).translation - here)))
        mesh = nearest.find("geometry/mesh")
        return visual_colour(nearest) or (self._shapes.mesh_colour(mesh) if mesh is not None else None)

    def _name(self, model: _Placed, link: Any, index: int) -> str:
        """The model's, the link's when there are several, the collision's when there are several; a number when taken."""
        collisions, parts = link.findall("collision"), [model.path.rpartition("::")[2]]
        if len(model.element.findall("link")) > 1:
            parts = [link.get("name", "link")]
        if len(collisions) > 1:
            parts = [*parts, collisions[index].get("name") or str(index + 1)]
        parts = [part for i, part in enumerate(parts) if i == len(parts) - 1 or not parts[i + 1].startswith(part)]
        full = re.sub(r"[^\w.-]+", "_", "_".join(parts))
        name = next(n for n in (full, *(f"{full}_{i}" for i in range(2, len(self._names) + 3))) if n not in self._names)
        self._names.add(name)
        return name

    def _settings(self, world: Any, about: str) -> WorldFile:
        """What the file says of the place, the air and the magnetic field."""
        place, wind, field = world.find("spherical_coordinates"), world.find("wind/linear_velocity"), world.find("magnetic_field")
        origin = HOME
        if place is None:
            self.notes.add("the file does not say where on Earth it lies: set 'origin'")
        else:
            latitude, longitude, altitude = (_figure(place, tag) for tag in ("latitude_deg", "longitude_deg", "elevation"))
            if abs(latitude) > 90.0 or abs(longitude) > 180.0:
                raise BadInput(f"{place_of(place)}: {latitude:g}, {longitude:g} deg is no place on Earth; mend <spherical_coordinates>")
            origin = Origin(latitude, longitude, altitude)
        gravity = world.find("gravity")
        if gravity is not None and abs(numbers(gravity, 3)[2] + 9.81) > 0.05:
            self.notes.add("gravity is 9.81 m/s^2 here, whatever the file says")
        bare = WorldFile(about=about, origin=origin, floor=(-10.0, -10.0, 10.0, 10.0))
        tesla = numbers(field, 3) if field is not None else np.zeros(3)
        steady = tuple(float(v) for v in numbers(wind, 3)) if wind is not None else bare.wind.steady
        magnetic = tuple(float(v) for v in tesla) if 0 < np.abs(tesla).max() <= 1e-3 else bare.magnetic_field
        return WorldFile(about, origin, bare.floor, wind=Wind(steady), magnetic_field=magnetic)  # type: ignore[arg-type]

    def _tell_dropped(self, root: Any, world: Any) -> None:
        if len(root.findall("world")) > 1:
            self.notes.add("only the first world of the file is taken", str(world.get("name")))
        if root is world and root.find("model") is None:
            raise BadInput(f"{self._path}: neither a <world> nor a <model> in it")
        for tag, reason in DROPPED.items():
            for element in world.iter(tag):
                self.notes.add(reason, element.get("name") or element.get("filename") or tag)


def _figure(place: Any, tag: str) -> float:
    element = place.find(tag)
    return float(numbers(element, 1)[0]) if element is not None else 0.0


def _true(text: str | None) -> bool:
    return (text or "").strip().lower() in ("true", "1")
