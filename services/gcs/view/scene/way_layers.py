"""Where a vehicle has been, is, and is to go; its name, its scan and its fence."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from schemas.messages import NavStatus
from services.gcs.state.vehicle_model import VehicleModel
from services.gcs.view.drawing import Colour, MeshNode, Points, Polyline, TextNode
from services.gcs.view.scene.fences import fence_nodes
from services.gcs.view.scene.levels import UP
from services.gcs.view.scene.node_cache import Layers, NodeCache, Nodes
from services.gcs.view.scene.scenery import circuit_line, rgb_of
from uvf.runtime.messages.convert import array

Floats = NDArray[np.float64]

ROUTE: Colour = (232, 74, 214)
SCAN: Colour = (255, 92, 92)
ASKED: Colour = (250, 190, 60)
SHADOW: Colour = (20, 24, 32)
SHADOW_RADIUS = 4.0  # m


class WayLayers:
    """Draws a vehicle's ways."""

    def __init__(self, nodes: NodeCache) -> None:
        self._nodes = nodes

    def of(self, v: VehicleModel) -> Layers:
        """The layers of a vehicle."""
        return {
            "scan": ("Scan", lambda: self._scan(v)),
            "path": ("Paths", lambda: self._path(v)),
            "goal": ("Paths", lambda: self._goal(v)),
            "mission": ("Paths", lambda: self._mission(v)),
            "fence": ("Fences", lambda: self._fence(v)),
            "track": ("Tracks", lambda: self._track(v)),
            "label": ("Labels", lambda: self._label(v)),
            "height": ("Labels", lambda: self._height(v)),
        }

    def _scan(self, v: VehicleModel) -> Nodes:
        scans = [(v.scan, v.scan_points), *v.other_scans.values()]
        seen = [(scan, points) for scan, points in scans if points is not None and len(points)]
        if not seen:
            return {}
        made_of = [scan for scan, _ in seen]
        return self._nodes.make(f"scan {v.name}", made_of, lambda: Points(np.concatenate([points for _, points in seen]), SCAN, 0.035))

    def _path(self, v: VehicleModel) -> Nodes:
        path = v.path
        if path is None or len(path.poses) < 2:
            return {}
        lift = 0.0 if v.flies else UP * 2
        return self._nodes.make(f"path {v.name}", path, lambda: Polyline(_points(path.poses) + np.array((0, 0, lift)), ROUTE, 3.5))

    def _goal(self, v: VehicleModel) -> Nodes:
        """A ring where the vehicle is going: amber while only asked for, in the route's colour once it is its goal."""
        going = v.nav_status is not None and v.nav_status.state in (NavStatus.PLANNING, NavStatus.DRIVING, NavStatus.RECOVERING)
        asked = v.goal_asked if v.order is not None and v.order.state == "sent" else None
        if asked is not None:
            return self._nodes.make(f"goal {v.name}", asked, lambda: _ring(asked[0], asked[1], ASKED))
        if v.flies or not going or v.nav_status is None:
            return {}
        at = (round(v.nav_status.goal.x, 2), round(v.nav_status.goal.y, 2))
        return self._nodes.make(f"goal {v.name}", (*at, "going"), lambda: _ring(*at, ROUTE))

    def _mission(self, v: VehicleModel) -> Nodes:
        mission = v.mission
        if mission is None or not mission.items:
            return {}
        points = mission_points(v)
        if len(points) < 2:
            return {}
        line = self._nodes.make(f"mission {v.name}", mission, lambda: circuit_line(points, ROUTE))
        for i, point in enumerate(_distinct(points)):
            x, y, z = (float(c) for c in point)
            number = self._nodes.make(f"mission {v.name} {i}", (x, y, z), lambda at=(x, y, z), n=i + 1: TextNode(f"{n}", at))  # type: ignore[misc]
            line[f"/{i}"] = number[""]
        return line

    def _fence(self, v: VehicleModel) -> Nodes:
        fence = v.fence
        if fence is None:
            return {}
        return self._nodes.make_all(f"fence {v.name}", fence, lambda: fence_nodes(fence, rgb_of(v.colour), v.flies))

    def _track(self, v: VehicleModel) -> Nodes:
        colour, up = rgb_of(v.colour), np.array((0, 0, 0.0 if v.flies else UP))
        nodes = {}
        for number, points in v.track.closed:
            drawn = self._nodes.make(f"track {v.name} {number}", number, lambda p=points: Polyline(p + up, colour, 2.5))  # type: ignore[misc]
            nodes[f"/{number}"] = drawn[""]
        if v.track.tail_length > 1:
            key = (v.track.count, v.track.tail_length)
            nodes["/tail"] = self._nodes.make(f"track {v.name}", key, lambda: Polyline(v.track.tail + up, colour, 2.5))[""]
        return nodes

    def _label(self, v: VehicleModel) -> Nodes:
        if v.place is None:
            return {}
        x, y, z = (round(float(c), 2) for c in v.place.position)
        if not v.flies:
            return self._nodes.make(f"label {v.name}", (x, y, z), lambda: TextNode(v.name, (x, y, z + 0.45)))
        return self._nodes.make(f"label {v.name}", (x, y, z), lambda: TextNode(f"{v.name}  {z:.0f} m", (x, y, z + 2.5)))

    def _height(self, v: VehicleModel) -> Nodes:
        """A line from an aircraft down to the ground and its shadow there, so that its place can be read.

        They hang on a frame, and their heights are whole metres: a browser moves frames at once, new points a while later.
        """
        if v.place is None or not v.flies:
            return {}
        down = math.ceil(v.place.position[2])
        foot = np.array(((0.0, 0.0, -down), (0.0, 0.0, 0.0)))
        line = self._nodes.make(f"height {v.name}", down, lambda: Polyline(foot, rgb_of(v.colour), 1.5))
        shadow = self._nodes.make(f"shadow {v.name}", down, lambda: _disc(3 * UP - down, SHADOW_RADIUS, SHADOW))
        return {"/line": line[""], "/shadow": shadow[""]}


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


def _disc(z: float, radius: float, colour: Colour) -> MeshNode:
    """A flat disc at the height ``z`` [m, parent's frame]."""
    a = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    rim = np.column_stack((radius * np.cos(a), radius * np.sin(a), np.full(len(a), z)))
    n = np.arange(len(a))
    faces = np.column_stack((np.full(len(a), len(a)), n, (n + 1) % len(a)))
    return MeshNode(np.vstack((rim, (0.0, 0.0, z))), faces, colour, 0.45)


def _ring(x: float, y: float, colour: Colour) -> Polyline:
    """A ring with a cross in it, 0.5 m wide, drawn in one stroke."""
    a = np.linspace(0, 2 * np.pi, 33)
    ring = np.column_stack((x + 0.25 * np.cos(a), y + 0.25 * np.sin(a)))
    cross = np.array(((x, y), (x, y + 0.35), (x, y - 0.35), (x, y), (x - 0.35, y), (x + 0.35, y)))
    flat = np.vstack((ring, ring[:1], cross[3:], cross[:3]))
    return Polyline(np.column_stack((flat, np.full(len(flat), 3 * UP))), colour, 3.0)
