"""``uvf plan survey``: an area, a vehicle and a camera made into a mission file."""

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from launch.planning.aircraft import MissionText, airspeed_of, load_aircraft
from uvf.maths.geodesy import LocalTangent
from uvf.models.importing.areas import read_areas
from uvf.models.mission.file import Waypoint
from uvf.models.scenario import ROOT
from uvf.models.vehicle.file import VehicleFile
from uvf.models.vehicle.flight_params import AirParams
from uvf.models.world.file import WorldFile, load_world
from uvf.models.yaml_data import BadInput
from uvf.planning.coverage.aerial import AerialTask, highest_ground, own_camera, plan_aerial
from uvf.planning.coverage.camera import SurveyCamera
from uvf.planning.coverage.field import CoverageField, join_fields, make_field
from uvf.planning.coverage.mission import SurveyFlight
from uvf.planning.coverage.plan import CoveragePlan

APPROACH = 6.0  # s, from where the flight begins to the first waypoint
VEHICLE = "surveyor"
SPARE = 1.15, 60.0  # of the planned time, s: how long the run may last


@dataclass(frozen=True)
class SurveyWishes:
    """What the command line asks for. Distances in m, angles in rad; None: from the camera, or the best.

    at: where the middle of the area is put in the world; None: where it lies on Earth.
    """

    area: Path
    height: float
    vehicle: str
    world: str
    wind: tuple[float, float]
    camera: SurveyCamera | None
    overlaps: tuple[float, float]
    spacing: float | None
    trigger: float | None
    airspeed: float | None
    direction: float | None
    at: tuple[float, float] | None
    seed: int


@dataclass(frozen=True)
class Survey:
    """A planned survey: the plan, how it is flown, its mission items, and what it was asked for."""

    wishes: SurveyWishes
    plan: CoveragePlan
    flight: SurveyFlight
    items: list[Waypoint]
    airspeed: float

    def lines(self) -> list[str]:
        """What has been planned, a line each."""
        plan = self.plan
        return [
            *plan.field.notes,
            f"{plan.field.area / 1e4:.2f} ha, {len(plan.swaths)} swaths {plan.width:.1f} m apart, "
            f"pictures every {self.flight.trigger:.1f} m from {self.flight.height:.0f} m",
            f"swaths {plan.swath_length:.0f} m, {plan.swath_ratio:.3f} of the least; path {plan.length:.0f} m, {plan.length_ratio:.2f}",
            f"covered {100 * plan.covered:.2f} % within half a spacing; {plan.turns} turns; {plan.time:.0f} s",
        ]

    def mission_text(self) -> str:
        """The mission file."""
        wishes, first = self.wishes, self.items[self.items[0].kind == "speed"]
        course = float(self.plan.segments[0, 2])
        back = APPROACH * self.airspeed
        x, y = first.x - back * math.cos(course), first.y - back * math.sin(course)
        text = MissionText(
            about=f"Survey of {wishes.area.name.replace(':', ' ')} from {self.flight.height:g} m, {len(self.plan.swaths)} swaths.",
            world=wishes.world,
            seed=wishes.seed,
            duration=SPARE[0] * self.plan.time + SPARE[1],
            wind=wishes.wind,
            name=VEHICLE,
            vehicle=wishes.vehicle,
            start=f"{{x: {x:.1f}, y: {y:.1f}, z: {self.flight.height:.1f}, yaw: {course:.4f}, speed: {self.airspeed:g}}}",
            rows=[_row(item) for item in self.items],
            legs=sum(item.kind == "waypoint" for item in self.items),
        )
        return str(text)


def plan_survey(wishes: SurveyWishes) -> Survey:
    """The survey that is asked for. Raises BadInput."""
    file, params = load_aircraft(wishes.vehicle, "a survey from the air")
    world = load_world(ROOT / "worlds", wishes.world)
    try:
        return _planned(wishes, file, params, world)
    except ValueError as error:
        raise BadInput(f"{wishes.area}: {error}") from error


def _planned(wishes: SurveyWishes, file: VehicleFile, params: AirParams, world: WorldFile) -> Survey:
    field = _field(wishes, world)
    camera = wishes.camera or own_camera(file)
    width = wishes.spacing if wishes.spacing is not None else _of(camera).spacing(wishes.height, wishes.overlaps[0])
    trigger = wishes.trigger if wishes.trigger is not None else _of(camera).trigger_distance(wishes.height, wishes.overlaps[1])
    airspeed = airspeed_of(wishes.vehicle, params, wishes.airspeed)
    height = wishes.height + _ground(field, world)
    task = AerialTask(height, width, trigger, wishes.airspeed or 0.0, wishes.wind, wishes.direction, wishes.seed)
    return Survey(wishes, *plan_aerial(field, task, params), airspeed)


def _field(wishes: SurveyWishes, world: WorldFile) -> CoverageField:
    """All areas of the file as one field in the world's frame."""
    areas = read_areas(wishes.area)
    origin = LocalTangent.from_degrees(world.origin.latitude, world.origin.longitude, world.origin.altitude)
    if wishes.at is not None and areas[0].in_degrees:
        longitude, latitude = areas[0].middle
        origin = LocalTangent.from_degrees(latitude, longitude, 0.0)
    rings = [area.rings_about(origin) for area in areas]
    corners = np.concatenate([outline for outline, _ in rings])
    shift = np.zeros(2)
    if wishes.at is not None:
        shift = np.array(wishes.at) - (corners.min(axis=0) + corners.max(axis=0)) / 2
    elif float(np.abs(corners).max()) > FARTHEST:
        away = float(np.abs(corners).max()) / 1000
        raise BadInput(f"{wishes.area}: lies {away:.0f} km from the origin of world '{wishes.world}'; '--at 0 0' puts it there")
    return join_fields([make_field(outline + shift, [hole + shift for hole in holes]) for outline, holes in rings])


FARTHEST = 50_000.0  # m from the world's origin, in its tangent plane


def _of(camera: SurveyCamera | None) -> SurveyCamera:
    if camera is None:
        raise BadInput("the vehicle has no camera: give --fov, --sensor and --focal, or --spacing and --trigger")
    return camera


def _ground(field: CoverageField, world: WorldFile) -> float:
    """The highest ground [m, world frame] below the field's bounding box."""
    x0, y0, x1, y1 = field.shape.bounds
    return highest_ground(world, (x0, y0), (x1, y1))


def _row(item: Waypoint) -> str:
    if item.kind == "trigger_distance":
        return f"{{kind: trigger_distance, distance: {item.distance:g}}}"
    if item.kind == "speed":
        return f"{{kind: speed, speed: {item.speed:g}}}"
    course = "" if item.course is None else f", course: {item.course:.5f}"
    return f"{{x: {item.x:.2f}, y: {item.y:.2f}, z: {item.z:.1f}{course}}}"
