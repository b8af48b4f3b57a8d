"""A layout for Foxglove and Lichtblick, in which a run's log opens with maps, tracks and curves of its own vehicles.

Format: what these programs export as a layout (https://docs.foxglove.dev/docs/visualization/layouts); they leave out what they do not know.
"""

from collections.abc import Sequence
from typing import Any

from schemas.topics import PREFIX

SHOWN = ("map/grid", "map/team", "sensor/scan", "nav/path", "nav/pose", "sensor/camera/info")
"""Topics of a vehicle that the scene shows."""
CURVES = {
    "height and position, m": ("truth/state.position.x", "truth/state.position.y", "truth/state.position.z"),
    "estimate, m": ("nav/pose.pose.position.x", "nav/pose.pose.position.y"),
    "speed, m/s": ("nav/odometry.linear_velocity.x", "nav/state.airspeed"),
    "battery": ("sensor/battery.remaining",),
}
STATES = ("state/vehicle.mode", "state/vehicle.armed", "nav/status.state")
COLOURS = ("#4e98e2", "#f5774d", "#63c67a", "#b982e6", "#e6c34a", "#59c6c9")
CAMERA = {"perspective": True, "distance": 30, "phi": 45, "thetaOffset": 45, "targetOffset": [0, 0, 0]}


def foxglove_layout(keys: Sequence[str]) -> dict[str, Any]:
    """The layout, ready for JSON, of a log with messages on these keys."""
    known = set(keys)
    vehicles = sorted({key.split("/")[1] for key in keys if key.endswith("/state/vehicle")})

    def there(names: Sequence[str]) -> list[str]:
        """As ``/uvf/burger/nav/pose.pose.position.x``, of all vehicles that have it."""
        full = [f"{PREFIX}/{vehicle}/{name}" for name in names for vehicle in vehicles]
        return [f"/{name}" for name in full if name.partition(".")[0] in known]

    panels: dict[str, Any] = {"3D!scene": _scene(there(SHOWN))}
    plots = {f"Plot!{i}": _plot(title, paths) for i, (title, names) in enumerate(CURVES.items()) if (paths := there(names))}
    panels |= plots
    states = [{"value": path, "timestampMethod": "receiveTime"} for path in there(STATES)]
    panels["StateTransitions!states"] = {"paths": states, "isSynced": True}
    pictures = [f"/{key}" for key in keys if key.endswith("/image")]
    if pictures:
        panels["Image!camera"] = {"imageMode": {"imageTopic": pictures[0]}}
    left = _column([name for name in ("3D!scene", "Image!camera") if name in panels], 65)
    layout = {"first": left, "second": _column([*plots, "StateTransitions!states"]), "direction": "row", "splitPercentage": 60}
    return {"configById": panels, "globalVariables": {}, "userNodes": {}, "playbackConfig": {"speed": 1}, "layout": layout}


def _scene(topics: Sequence[str]) -> dict[str, Any]:
    transforms = {"showLabel": True, "axisScale": 0.5}
    shown = {topic: {"visible": True} for topic in topics}
    return {"followMode": "follow-none", "followTf": "world", "cameraState": CAMERA, "scene": {"transforms": transforms}, "topics": shown}


def _plot(title: str, paths: Sequence[str]) -> dict[str, Any]:
    lines = [
        {"value": path, "enabled": True, "timestampMethod": "receiveTime", "showLine": True, "color": COLOURS[i % len(COLOURS)]}
        for i, path in enumerate(paths)
    ]
    shown = {"showXAxisLabels": True, "showYAxisLabels": True, "showLegend": True, "legendDisplay": "floating", "isSynced": True}
    return {"paths": lines, "foxglovePanelTitle": title, "xAxisVal": "timestamp", **shown}


def _column(panels: Sequence[str], first: float | None = None) -> Any:
    """Panels below each other, as the tree that a layout is; first: the upper one's share [%], else all are alike."""
    if len(panels) == 1:
        return panels[0]
    share = first if first is not None else 100 / len(panels)
    return {"first": panels[0], "second": _column(panels[1:]), "direction": "column", "splitPercentage": share}
