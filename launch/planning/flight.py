"""``uvf plan flight``: start, goal, fence and obstacles made into a mission file that leads past everything."""

import math
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated

import msgspec
from msgspec import Meta

from launch.planning.aircraft import MissionText, airspeed_of, load_aircraft
from launch.planning.obstacles import prisms_of
from uvf.guidance.corners import CornerLimits
from uvf.guidance.fence_plan import PATH_ROOM
from uvf.maths.zones import Disc, Polygon
from uvf.models.mission.fence import FenceFile, Zone, fence_fault, region_of, zones_of
from uvf.models.mission.file import Metres, Waypoint
from uvf.models.scenario import ROOT
from uvf.models.vehicle.flight_params import AirParams
from uvf.models.world.file import WorldFile, load_world
from uvf.models.yaml_data import BadInput, load_yaml
from uvf.planning.coverage.aerial import highest_ground
from uvf.planning.flight.airspace import Airspace, Prism
from uvf.planning.flight.clearance import Configuration
from uvf.planning.flight.loiter import plan_loiter
from uvf.planning.flight.mission import FlownTurns, flight_items, loiter_item
from uvf.planning.flight.planner import DubinsAirplanePath, FlightLimits, rrt_star_flight
from uvf.planning.sampling.problem import Budget

ITERATIONS = 20_000  # of each try
TRIES = ((1.15, 0.0), (1.3, 4.0), (1.6, 8.0), (1.3, 12.0))
"""Of the flown radius, and m added to the margins aside, with which is planned; what comes out is tested with neither."""
CLIMBING = 0.7
"""Of the fastest climb and descent, that paths are planned with."""
SPARE = 1.2, 60.0  # of the planned time, s: how long the run may last
VEHICLE = "aircraft"


class FlightPlace(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A place in the world frame [m]; ``course`` [rad] counter-clockwise from east; left out: towards the goal."""

    x: Metres
    y: Metres
    z: Metres
    course: Annotated[float, Meta(ge=-7, le=7)] | None = None


class ObstacleFile(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A polygon (corners x, y) or a circle (x, y, radius) [m], from ``floor`` up to ``ceiling`` [m, world].

    Without a floor it stands on the ground, without a ceiling it has no top.
    """

    polygon: list[tuple[Metres, Metres]] | None = None
    circle: tuple[Metres, Metres, Annotated[float, Meta(gt=0, le=1e6)]] | None = None
    floor: Metres | None = None
    ceiling: Metres | None = None


class FlightFile(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The file that is planned for."""

    start: FlightPlace
    goal: FlightPlace
    fence: FenceFile = FenceFile()
    obstacles: list[ObstacleFile] = []


@dataclass(frozen=True)
class FlightWishes:
    """What the command line asks for. wind: [m/s], east and north, where it blows to; aside, above: margins [m]."""

    file: Path
    vehicle: str
    world: str
    wind: tuple[float, float]
    airspeed: float | None
    aside: float
    above: float
    seed: int


@dataclass(frozen=True)
class PlannedFlight:
    """A planned flight: what it was asked for, the planned path, and the mission's items."""

    wishes: FlightWishes
    fence: FenceFile
    path: DubinsAirplanePath
    items: list[Waypoint]
    airspace: Airspace
    airspeed: float
    ground: float

    def lines(self) -> list[str]:
        """What has been planned, a line each."""
        (x0, y0, z0, _), (x1, y1, z1, _) = self.path.waypoints[0].tolist(), self.path.waypoints[-1].tolist()
        orbits = sum(item.to_altitude for item in self.items)
        ends = "circles at the goal" if self.items[-1].kind == "orbit" else "there is no room to circle at the goal"
        return [
            f"{len(self.airspace.obstacles)} obstacles, {len(self.airspace.fence.include)} zones to stay in, "
            f"{len(self.airspace.fence.exclude)} to keep out of",
            f"path {self.path.length:.0f} m, {math.hypot(x1 - x0, y1 - y0):.0f} m in a straight line; from {z0:.0f} to {z1:.0f} m",
            f"{sum(item.kind == 'waypoint' for item in self.items)} waypoints, {orbits} circles to an altitude; {ends}",
        ]

    def mission_text(self) -> str:
        """The mission file."""
        wishes = self.wishes
        x, y, z, course = self.path.waypoints[0].tolist()
        slowest = self.airspeed - math.hypot(*wishes.wind)
        legs = sum(item.kind == "waypoint" for item in self.items)
        text = MissionText(
            about=f"Flight of {wishes.file.name.replace(':', ' ')} past {len(self.airspace.obstacles)} obstacles, {legs} waypoints.",
            world=wishes.world,
            seed=wishes.seed,
            duration=SPARE[0] * self.path.length / slowest + SPARE[1],
            wind=wishes.wind,
            name=VEHICLE,
            vehicle=wishes.vehicle,
            start=f"{{x: {x:.2f}, y: {y:.2f}, z: {z - self.ground:.2f}, yaw: {math.remainder(course, math.tau):.5f}, "
            f"speed: {self.airspeed:g}}}",
            rows=[_row(item) for item in self.items],
            legs=legs,
            fence=_fence_rows(self.fence),
        )
        return str(text)


def plan_flight(wishes: FlightWishes) -> PlannedFlight:
    """The flight that is asked for. Raises BadInput."""
    _, params = load_aircraft(wishes.vehicle, "a flight")
    world = load_world(ROOT / "worlds", wishes.world)
    if not wishes.file.is_file():
        raise BadInput(f"no file {wishes.file}: it is a .yaml with start, goal, fence and obstacles")
    file = load_yaml(wishes.file, FlightFile)
    try:
        return _planned(wishes, file, params, world)
    except ValueError as error:
        raise BadInput(f"{wishes.file}: {error}") from error


def _planned(wishes: FlightWishes, file: FlightFile, params: AirParams, world: WorldFile) -> PlannedFlight:
    airspeed = airspeed_of(wishes.vehicle, params, wishes.airspeed)
    if math.hypot(*wishes.wind) >= airspeed:
        raise BadInput(f"a wind of {math.hypot(*wishes.wind):g} m/s; at {airspeed:g} m/s not every course can be flown in it")
    turns = CornerLimits(airspeed, (wishes.wind[1], wishes.wind[0]), params.turn_bank, params.roll_in)
    fastest = airspeed + math.hypot(*wishes.wind)
    least = params.fence_margin + PATH_ROOM if file.fence.zones else 0.0
    if wishes.aside < least:
        raise BadInput(f"--aside {wishes.aside:g}: the autopilot keeps {least:g} m from its fence; give that or more")
    climb, sink = (math.atan(CLIMBING * rate / fastest) for rate in (params.climb_max, params.sink_max))
    limits = FlightLimits(turns.radius, climb, sink, wishes.aside, wishes.above)
    airspace, query = _airspace(wishes, file, world), _query(file)
    path, items = _found(airspace, limits, query, (FlownTurns(turns.radius, turns.ramp, least), wishes.seed))
    end = plan_loiter(airspace, limits, query[1], query[1][2], max(params.hold_radius, limits.radius))
    ending = [] if end is None else [loiter_item(end)]
    (x, y) = query[0][:2]
    speed = [] if wishes.airspeed is None else [Waypoint(kind="speed", speed=airspeed)]
    ground = highest_ground(world, (x, y), (x, y))
    return PlannedFlight(wishes, file.fence, path, [*speed, *items, *ending], airspace, airspeed, ground)


def _found(
    airspace: Airspace, limits: FlightLimits, query: tuple[Configuration, Configuration], how: tuple[FlownTurns, int]
) -> tuple[DubinsAirplanePath, list[Waypoint]]:
    """A path and its mission, planned with more and more room until it is clear as it will be flown. Raises ValueError."""
    why = "paths were found, but none that the autopilot flies clear of everything; allow smaller margins or a lower airspeed"
    for number, (wider, more) in enumerate(TRIES):
        wished = replace(limits, radius=wider * limits.radius, aside=limits.aside + more)
        plan = rrt_star_flight(airspace, wished, query, Budget(ITERATIONS), how[1] + number)
        if plan.path is None:
            why = plan.reason if number == 0 else why
        elif (items := flight_items(plan.path, airspace, limits, how[0])) is not None:
            return plan.path, items
    raise ValueError(why)


def _query(file: FlightFile) -> tuple[Configuration, Configuration]:
    a, b = file.start, file.goal
    if math.hypot(b.x - a.x, b.y - a.y) < 1.0:
        raise BadInput("start and goal are at one place; a flight leads from one to another")
    straight = math.atan2(b.y - a.y, b.x - a.x)
    courses = [straight if place.course is None else place.course for place in (a, b)]
    return (a.x, a.y, a.z, courses[0]), (b.x, b.y, b.z, courses[1])


def _airspace(wishes: FlightWishes, file: FlightFile, world: WorldFile) -> Airspace:
    """The file's fence and obstacles, and what stands in the world; not lower than the highest ground about."""
    zones = zones_of(file.fence, f"{wishes.file}: fence")
    prisms = [_prism(obstacle, f"{wishes.file}: obstacles: {i}") for i, obstacle in enumerate(file.obstacles)]
    region = region_of(zones)
    boxes = [area.box for area in region.include] or [((p.x, p.y), (p.x, p.y)) for p in (file.start, file.goal)]
    low = min(x for (x, _), _ in boxes), min(y for (_, y), _ in boxes)
    high = max(x for _, (x, _) in boxes), max(y for _, (_, y) in boxes)
    ground = highest_ground(world, low, high)
    floor = ground if file.fence.floor is None else max(file.fence.floor, ground)
    return Airspace((*prisms, *prisms_of(world)), region, floor, math.inf if file.fence.ceiling is None else file.fence.ceiling)


def _prism(obstacle: ObstacleFile, place: str) -> Prism:
    if (obstacle.polygon is None) == (obstacle.circle is None):
        raise BadInput(f"{place}: an obstacle is a polygon or a circle, one of the two")
    x, y, radius = obstacle.circle or (0.0, 0.0, 0.0)
    zone = Zone(obstacle.polygon or (), (x, y), radius)
    if why := fence_fault([zone], obstacle.floor, obstacle.ceiling):
        raise BadInput(f"{place}: {why.removeprefix('zone 0: ')}")
    area = Polygon(obstacle.polygon) if obstacle.polygon else Disc((x, y), radius)
    low = -math.inf if obstacle.floor is None else obstacle.floor
    return Prism(area, low, math.inf if obstacle.ceiling is None else obstacle.ceiling)


def _fence_rows(fence: FenceFile) -> str:
    """The fence as rows of the vehicle; none where there is no fence."""
    written = msgspec.to_builtins(fence)
    rows = [f"      {name}: {written[name]}\n" for name in ("floor", "ceiling") if written[name] is not None]
    rows += ["      zones:\n"] if fence.zones else []
    for zone in fence.zones:
        shape = f"polygon: {[list(p) for p in zone.polygon]}" if zone.polygon else f"circle: {list(zone.circle or ())}"
        rows.append(f"        - {{{shape}{', exclude: true' if zone.exclude else ''}}}\n")
    return "".join(["    fence:\n", f"      action: {fence.action}\n", *rows]) if rows else ""


def _row(item: Waypoint) -> str:
    if item.kind == "speed":
        return f"{{kind: speed, speed: {item.speed:g}}}"
    place = f"x: {item.x:.2f}, y: {item.y:.2f}, z: {item.z:.2f}"
    if item.kind == "orbit":
        return f"{{kind: orbit, {place}, radius: {item.radius:.2f}{', to_altitude: true' if item.to_altitude else ''}}}"
    return f"{{{place}, course: {item.course:.5f}}}"
