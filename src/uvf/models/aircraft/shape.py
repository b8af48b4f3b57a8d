"""How an aircraft looks, for cameras, page, lidars and collisions: its mesh, or a body of wing, fuselage, tail and what moves on them.

Nothing is drawn by hand: the measures are those of ``looks:`` in its file, of its JSBSim model, or the usual ones.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from uvf.models.aircraft.bodies import airship, fuselage_parts, gondola, payload, propeller, undercarriage
from uvf.models.aircraft.dimensions import planned
from uvf.models.aircraft.panels import Movable, Panel, hull_fins, tail_panels, wing_panels
from uvf.models.jsbsim.sizes import Hull, Sizes, sizes_of
from uvf.models.shapes.mesh import load_mesh
from uvf.models.shapes.mesh_parts import Floats, MeshPart
from uvf.models.vehicle.air import STANDARD_JOINTS, AirBody
from uvf.models.vehicle.file import VehicleFile
from uvf.models.vehicle.layers import folders_of, holding


@dataclass(frozen=True, eq=False)
class AircraftShape:
    """The shape of an aircraft: origin at the centre of gravity, FLU, in metres.

    colour: red, green, blue, 0..1, of the parts that have none of their own.
    """

    fixed: list[MeshPart]
    movables: list[Movable]
    colour: tuple[float, float, float]
    undercarriage: list[MeshPart] = field(default_factory=list)

    @property
    def at_rest(self) -> list[MeshPart]:
        """All parts, with nothing deflected."""
        return self.airborne + self.undercarriage

    @property
    def airborne(self) -> list[MeshPart]:
        """All parts but wheels and legs: those that must touch nothing."""
        return self.fixed + [moved(part, m.origin) for m in self.movables for part in m.parts]

    @property
    def bounds(self) -> Floats:
        """Lowest and highest corner (2, 3) [m, body frame FLU]."""
        points = np.vstack([part.vertices for part in self.at_rest])
        return np.array((points.min(axis=0), points.max(axis=0)))

    def scaled(self, scale: float) -> "AircraftShape":
        """The shape made larger by the factor ``scale`` [-] about the centre of gravity."""
        movables = [replace(m, origin=m.origin * scale, parts=_scaled(m.parts, scale)) for m in self.movables]
        legs = _scaled(self.undercarriage, scale)
        return replace(self, fixed=_scaled(self.fixed, scale), movables=movables, undercarriage=legs)


def moved(part: MeshPart, way: Floats) -> MeshPart:
    """The part shifted by ``way`` (3,) [m]."""
    return replace(part, vertices=part.vertices + way)


def _scaled(parts: Sequence[MeshPart], scale: float) -> list[MeshPart]:
    return [replace(part, vertices=part.vertices * scale) for part in parts]


def aircraft_shape(folder: Path, file: VehicleFile) -> AircraftShape:
    """The shape of the aircraft in this folder. Raises BadInput for a mesh or a model that cannot be read."""
    air = file.air
    assert air is not None
    if air.mesh is not None:
        return AircraftShape([MeshPart(*load_mesh(folder / air.mesh))], [], air.looks.colour)
    models = holding(folders_of(folder), air.model)
    sizes = sizes_of(models / air.model / f"{air.model}.xml")
    hull = sizes.hull
    shape = _plane(air, sizes) if hull is None else _airship(air, sizes, hull)
    return replace(shape, fixed=[*shape.fixed, *payload(file.sensors)])


def _plane(air: AirBody, sizes: Sizes) -> AircraftShape:
    looks = planned(air.looks, sizes)
    shape = _assembled(air, sizes, fuselage_parts(looks, sizes), [*wing_panels(looks), *tail_panels(looks)])
    return replace(shape, undercarriage=undercarriage(sizes, looks.fuselage.width, looks.fuselage.z))


def _airship(air: AirBody, sizes: Sizes, hull: Hull) -> AircraftShape:
    car = gondola(sizes, hull)
    shape = _assembled(air, sizes, airship(sizes, hull, car), hull_fins(hull))
    return replace(shape, undercarriage=undercarriage(sizes, car.size[1], car.centre[2]))


def _assembled(air: AirBody, sizes: Sizes, body: Sequence[MeshPart], panels: Sequence[Panel]) -> AircraftShape:
    fixed = [*body, *(part for panel in panels for part in panel.fixed())]
    turning = [propeller(_joint(air, i), thruster) for i, thruster in enumerate(sizes.thrusters) if thruster.radius]
    return AircraftShape(fixed, [*(m for panel in panels for m in panel.movables()), *turning], air.looks.colour)


def _joint(air: AirBody, engine: int) -> str:
    """What the joint of an engine's propeller is called."""
    sources = (f"propulsion/engine[{engine}]/", *(("propulsion/engine/",) if engine == 0 else ()))
    joints = air.joints or STANDARD_JOINTS
    return next((name for name, joint in joints.items() if (joint.speed or "").startswith(sources)), f"propeller_{engine}")
