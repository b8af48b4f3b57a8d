"""From what is known to what is drawn. A node stays the same object until what it shows has changed."""

import math
from collections.abc import Callable, Iterator, Mapping, Set
from typing import Any

import numpy as np
from numpy.typing import NDArray

from schemas.messages import FrameTransform, Grid, NavStatus
from services.gcs.state.state import Model
from services.gcs.state.vehicle_model import DisplayPose, VehicleModel
from services.gcs.view.drawing import Colour, FloorPicture, Node, Points, Polyline, TextNode
from services.gcs.view.scene import bodies
from services.gcs.view.scene.fences import fence_nodes
from services.gcs.view.scene.map_image import known_part, occupancy_png
from services.gcs.view.scene.moving_parts import MovingParts
from services.gcs.view.scene.scenery import circuit_line, coloured, moving, places_of, rgb_of, scenery
from services.gcs.view.scene.spawned import Spawned
from uvf.maths.rotations import multiply, rotate, to_euler
from uvf.models.aircraft.shape import AircraftShape, aircraft_shape
from uvf.models.shapes.mesh_parts import MeshPart
from uvf.runtime.messages.convert import array, occupancy_cells, wxyz

Floats = NDArray[np.float64]

ROUTE: Colour = (232, 74, 214)
SCAN: Colour = (255, 92, 92)
ASKED: Colour = (250, 190, 60)
GHOST: Colour = (190, 200, 215)
SHOWN_SIZE, MOST_SCALE = 8.5, 4.0  # m
"""Small aircraft are drawn larger than they are, to be seen from where their whole circuit is."""
MAP_PERIOD = 1.0  # s between two pictures of the map
LEVEL = np.array((1.0, 0.0, 0.0, 0.0))
UP = 0.02  # m above the floor, so that what lies on it is seen


class SceneView:
    """Draws the state of the ground station; caches the nodes it has made by what they were made from."""

    def __init__(self, model: Model) -> None:
        self._model = model
        self._made: dict[str, tuple[Any, dict[str, Node]]] = {}
        self._used: set[str] = set()
        self._surroundings = scenery(model.site.world)
        self._scripted = moving(model.site.world)
        self._bodies: dict[str, dict[str, Node]] = {}
        self._ghosts: dict[str, dict[str, Node]] = {}
        self._moving: dict[str, MovingParts] = {}
        self._learn()
        self._spawned = Spawned(model)
        self._map_due: dict[str, float] = {}

    def _learn(self) -> None:
        """What the vehicles look like; external vehicles come later, and go."""
        for name in self._bodies.keys() - self._model.vehicles.keys():
            for known in (self._bodies, self._ghosts, self._moving):
                known.pop(name, None)
        for v in [v for v in self._model.vehicles.values() if v.name not in self._bodies]:
            shape = _shape(v) if v.flies else None
            self._bodies[v.name] = _body(v, shape)
            self._ghosts[v.name] = coloured(_parts(v, shape), GHOST, v.name)
            if shape is not None:
                self._moving[v.name] = MovingParts(shape.movables)

    def nodes(self, t: float) -> dict[str, Node]:
        """All scene nodes at ``t`` [s, wall], by name; ``/vehicles/<v>/...`` is given in that vehicle's frame."""
        self._learn()
        layers = self._model.layers
        shown = {k: n for k, n in self._surroundings.items() if "Walls" in layers or not k.startswith("/world/walls/")}
        shown |= self._spawned.nodes()
        self._used = set()
        for vehicle in self._model.vehicles.values():
            shown.update(self._of_vehicle(vehicle, layers, t))
        if len(self._made) > len(self._used):
            self._made = {name: made for name, made in self._made.items() if name in self._used}
        return shown

    def places(self) -> dict[str, DisplayPose]:
        """Poses of the frames of vehicles and of what moves by script, by node name."""
        self._learn()
        layers = self._model.layers
        placed = places_of(self._scripted, self._model.sim_time) | self._spawned.places()
        for v in self._model.vehicles.values():
            if v.place is not None:
                placed[f"/vehicles/{v.name}"] = v.place
                if v.flies:
                    moving = self._moving[v.name].places(v.joints)
                    placed |= {f"/vehicles/{v.name}/{part}": place for part, place in moving.items()}
                    placed[f"/height/{v.name}"] = DisplayPose(v.place.position, LEVEL)
            if v.true_place is not None and "True pose" in layers:
                placed[f"/true/{v.name}"] = v.true_place
        return placed

    def _of_vehicle(self, v: VehicleModel, layers: Set[str], t: float) -> Iterator[tuple[str, Node]]:
        if v.place is not None:
            yield from ((f"/vehicles/{v.name}/{part}", node) for part, node in self._bodies[v.name].items())
        if v.true_place is not None and "True pose" in layers:
            yield from ((f"/true/{v.name}/{part}", node) for part, node in self._ghosts[v.name].items())
        for what, (layer, draw) in self._layers(v, t).items():
            if layer in layers:
                yield from ((f"/{what}/{v.name}{suffix}", node) for suffix, node in draw().items())

    def _layers(self, v: VehicleModel, t: float) -> Mapping[str, tuple[str, Callable[[], dict[str, Node]]]]:
        return {
            "map": ("Map", lambda: self._map(v, f"map {v.name}", v.grid, t)),
            "team": ("Team maps", lambda: self._map(v, f"team map {v.name}", v.team_map, t)),
            "scan": ("Scan", lambda: self._scan(v)),
            "path": ("Paths", lambda: self._path(v)),
            "goal": ("Paths", lambda: self._goal(v)),
            "mission": ("Paths", lambda: self._mission(v)),
            "fence": ("Fences", lambda: self._fence(v)),
            "track": ("Tracks", lambda: self._track(v)),
            "label": ("Labels", lambda: self._label(v)),
            "height": ("Labels", lambda: self._height(v)),
        }

    def _make(self, name: str, of: Any, make: Callable[[], Node]) -> dict[str, Node]:
        """The node made from ``of`` before, if it is still that; else a new one."""
        return self._make_all(name, of, lambda: {"": make()})

    def _make_all(self, name: str, of: Any, make: Callable[[], dict[str, Node]]) -> dict[str, Node]:
        """The same of several nodes that are made at once."""
        self._used.add(name)
        before = self._made.get(name)
        if before is None or (before[0] is not of and before[0] != of):
            self._made[name] = (of, make())
        return dict(self._made[name][1])

    def _map(self, v: VehicleModel, name: str, grid: Grid | None, t: float) -> dict[str, Node]:
        if grid is None or not grid.data or grid.column_count == 0:
            return {}
        if v.world_from_map is None and grid.frame_id != "world":
            return {}  # nobody has said yet where this map lies
        if name in self._made and t < self._map_due.get(name, 0.0):
            self._used.add(name)
            return self._made[name][1]
        self._map_due[name] = t + MAP_PERIOD
        return self._make(name, (grid, v.world_from_map), lambda: floor_picture(grid, v.world_from_map))

    def _scan(self, v: VehicleModel) -> dict[str, Node]:
        points = v.scan_points
        if points is None or len(points) == 0:
            return {}
        return self._make(f"scan {v.name}", v.scan, lambda: Points(points, SCAN, 0.035))

    def _path(self, v: VehicleModel) -> dict[str, Node]:
        path = v.path
        if path is None or len(path.poses) < 2:
            return {}
        lift = 0.0 if v.flies else UP * 2
        return self._make(f"path {v.name}", path, lambda: Polyline(_points(path.poses) + np.array((0, 0, lift)), ROUTE, 3.5))

    def _goal(self, v: VehicleModel) -> dict[str, Node]:
        """A ring where the vehicle is going: amber while only asked for, in the route's colour once it is its goal."""
        going = v.nav_status is not None and v.nav_status.state in (NavStatus.PLANNING, NavStatus.DRIVING, NavStatus.RECOVERING)
        asked = v.goal_asked if v.order is not None and v.order.state == "sent" else None
        if asked is not None:
            return self._make(f"goal {v.name}", asked, lambda: _ring(asked[0], asked[1], ASKED))
        if v.flies or not going or v.nav_status is None:
            return {}
        at = (round(v.nav_status.goal.x, 2), round(v.nav_status.goal.y, 2))
        return self._make(f"goal {v.name}", (*at, "going"), lambda: _ring(*at, ROUTE))

    def _mission(self, v: VehicleModel) -> dict[str, Node]:
        mission = v.mission
        if mission is None or not mission.items:
            return {}
        points = mission_points(v)
        if len(points) < 2:
            return {}
        line = self._make(f"mission {v.name}", mission, lambda: circuit_line(points, ROUTE))
        for i, point in enumerate(_distinct(points)):
            x, y, z = (float(c) for c in point)
            number = self._make(f"mission {v.name} {i}", (x, y, z), lambda at=(x, y, z), n=i + 1: TextNode(f"{n}", at))  # type: ignore[misc]
            line[f"/{i}"] = number[""]
        return line

    def _fence(self, v: VehicleModel) -> dict[str, Node]:
        fence = v.fence
        if fence is None:
            return {}
        return self._make_all(f"fence {v.name}", fence, lambda: fence_nodes(fence, rgb_of(v.colour), v.flies))

    def _track(self, v: VehicleModel) -> dict[str, Node]:
        colour, up = rgb_of(v.colour), np.array((0, 0, 0.0 if v.flies else UP))
        nodes = {}
        for number, points in v.track.closed:
            drawn = self._make(f"track {v.name} {number}", number, lambda p=points: Polyline(p + up, colour, 2.5))  # type: ignore[misc]
            nodes[f"/{number}"] = drawn[""]
        if v.track.tail_length > 1:
            key = (v.track.count, v.track.tail_length)
            nodes["/tail"] = self._make(f"track {v.name}", key, lambda: Polyline(v.track.tail + up, colour, 2.5))[""]
        return nodes

    def _label(self, v: VehicleModel) -> dict[str, Node]:
        if v.place is None:
            return {}
        x, y, z = (round(float(c), 2) for c in v.place.position)
        if not v.flies:
            return self._make(f"label {v.name}", (x, y, z), lambda: TextNode(v.name, (x, y, z + 0.45)))
        return self._make(f"label {v.name}", (x, y, z), lambda: TextNode(f"{v.name}  {z:.0f} m", (x, y, z + 2.5)))

    def _height(self, v: VehicleModel) -> dict[str, Node]:
        """A line from an aircraft down to the ground, so that its place can be read.

        It hangs on a frame, and its points are whole metres: a browser moves frames at once, new points a while later.
        """
        if v.place is None or not v.flies:
            return {}
        down = math.ceil(v.place.position[2])
        foot = np.array(((0.0, 0.0, -down), (0.0, 0.0, 0.0)))
        return {"/line": self._make(f"height {v.name}", down, lambda: Polyline(foot, rgb_of(v.colour), 1.5))[""]}


def _shape(v: VehicleModel) -> AircraftShape:
    """As large as it is drawn."""
    shape = aircraft_shape(v.member.folder, v.member.file)
    size = float(np.ptp(shape.bounds, axis=0).max())
    return shape.scaled(min(max(SHOWN_SIZE / size, 1.0), MOST_SCALE))


def _body(v: VehicleModel, shape: AircraftShape | None) -> dict[str, Node]:
    """An aircraft's movable parts are drawn in frames of their own, which turn."""
    colour = rgb_of(v.colour)
    if shape is None:
        return coloured(_parts(v, None), colour, v.name)
    found = coloured(shape.fixed + shape.undercarriage, colour, v.name)
    for part in shape.movables:
        drawn = coloured(part.parts, colour, v.name)
        found |= {f"{part.name}/{i}": node for i, node in drawn.items()}
    return found


def _parts(v: VehicleModel, shape: AircraftShape | None) -> list[MeshPart]:
    """All of it, at rest."""
    if shape is not None:
        return shape.at_rest
    assert v.member.file.ground is not None
    return bodies.rover(v.member.folder / v.member.file.ground.urdf)


def floor_picture(grid: Grid, world_from_map: FrameTransform | None) -> FloorPicture:
    """The grid as a picture on the ground, placed by its pose (that of its lower left corner) and its frame's."""
    cells, (row, column) = known_part(occupancy_cells(grid))
    dx, dy = grid.cell_size.x, grid.cell_size.y
    width, height = cells.shape[1] * dx, cells.shape[0] * dy
    turn = wxyz(grid.pose.orientation)
    centre = array(grid.pose.position) + rotate(turn, np.array((column * dx + width / 2, row * dy + height / 2, 0.0)))
    if world_from_map is not None and grid.frame_id != "world":
        map_turn = wxyz(world_from_map.rotation)
        turn, centre = multiply(map_turn, turn), array(world_from_map.translation) + rotate(map_turn, centre)
    x, y, z = (float(c) for c in centre)
    return FloorPicture(occupancy_png(cells), width, height, (x, y, z + UP / 2), to_euler(turn)[2])


def mission_points(v: VehicleModel) -> Floats:
    """Positions (n, 3) [m, world] of the mission in force, closed where a jump leads back."""
    items = v.mission.items if v.mission is not None else []
    points = [array(i.position) for i in items if i.kind in (i.WAYPOINT, i.ORBIT)]
    if len(points) > 1 and any(i.kind == i.JUMP for i in items):
        points.append(points[0])
    return np.array(points).reshape(-1, 3)


def _distinct(points: Floats) -> Floats:
    return points[:-1] if len(points) > 1 and np.array_equal(points[0], points[-1]) else points


def _points(poses: Any) -> Floats:
    return np.array([(p.position.x, p.position.y, p.position.z) for p in poses])


def _ring(x: float, y: float, colour: Colour) -> Polyline:
    """A ring with a cross in it, 0.5 m wide, drawn in one stroke."""
    a = np.linspace(0, 2 * np.pi, 33)
    ring = np.column_stack((x + 0.25 * np.cos(a), y + 0.25 * np.sin(a)))
    cross = np.array(((x, y), (x, y + 0.35), (x, y - 0.35), (x, y), (x - 0.35, y), (x + 0.35, y)))
    flat = np.vstack((ring, ring[:1], cross[3:], cross[:3]))
    return Polyline(np.column_stack((flat, np.full(len(flat), 3 * UP))), colour, 3.0)
