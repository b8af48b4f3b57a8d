"""What has been put into the running simulation, drawn at its true place: shapes, and vehicles that belong to no mission."""

from schemas.messages import SimObject
from services.gcs.state.state import Model, model_name
from services.gcs.state.vehicle_model import DisplayPose
from services.gcs.view.drawing import Colour, Node
from services.gcs.view.scene.bodies import rgb, rover
from services.gcs.view.scene.scenery import at_rest, coloured, merge
from uvf.models.aircraft.shape import aircraft_shape
from uvf.models.shapes.mesh_parts import MeshPart
from uvf.models.vehicle.file import load_vehicle
from uvf.models.yaml_data import BadInput
from uvf.runtime.messages.convert import array, wxyz
from uvf.runtime.messages.spawned import solid_of, unit_wxyz

STRANGER: Colour = (225, 225, 225)

Look = tuple[str, str, tuple[float, ...], bytes]
"""Model, shape, size, colour."""


class Spawned:
    """Spawned objects. Meshes are cached by appearance: many objects of one look are made once."""

    def __init__(self, model: Model) -> None:
        self._model = model
        self._made: dict[Look, dict[str, Node]] = {}

    def nodes(self) -> dict[str, Node]:
        """The parts of each object, in its own frame ``/spawned/<name>``."""
        before, self._made = self._made, {}
        nodes: dict[str, Node] = {}
        for thing in self._model.spawned:
            look = _look(thing)
            if look not in self._made:
                self._made[look] = before[look] if look in before else self._draw(thing)
            nodes |= {f"/spawned/{thing.name}/{part}": node for part, node in self._made[look].items()}
        return nodes

    def _draw(self, thing: SimObject) -> dict[str, Node]:
        if not thing.model:
            solid = solid_of(thing)
            return {"0": merge([at_rest(solid)], rgb(solid.colour))}
        try:
            return coloured(self._parts(thing.model), STRANGER)
        except BadInput as error:  # the simulator's host has files that this one lacks
            self._model.note("", f"'{thing.name}' cannot be drawn: {error}")
            return {}

    def _parts(self, model: str) -> list[MeshPart]:
        folder = self._model.site.vehicles_folder
        file = load_vehicle(folder, model_name(model))
        return rover(folder / model / file.ground.urdf) if file.ground is not None else aircraft_shape(folder / model, file).at_rest

    def places(self) -> dict[str, DisplayPose]:
        """Frames of the objects: a vehicle's from its true pose, the others' from the list of objects."""
        return {f"/spawned/{thing.name}": self._place(thing) for thing in self._model.spawned}

    def _place(self, thing: SimObject) -> DisplayPose:
        truth = self._model.strangers.get(thing.name)
        if truth is not None:
            return DisplayPose(array(truth.position), wxyz(truth.orientation))
        return DisplayPose(array(thing.pose.position), unit_wxyz(thing.pose))


def _look(thing: SimObject) -> Look:
    return thing.model, thing.shape, tuple(thing.size), thing.color.SerializeToString(deterministic=True)
