"""Sensors of others as the ``sensors:`` section of a vehicle.yaml."""

from collections.abc import Callable, Collection, Iterator
from typing import Any

import numpy as np

from uvf.maths.rotations import rotate, to_euler
from uvf.maths.se3 import Transform, apply, compose
from uvf.models.importing.robot import Foreign, ForeignSensor
from uvf.models.shapes.mesh import triangles

Section = dict[str, Any]

FASTEST = 100.0  # Hz, of the simulator of the ground
FASTEST_CAMERA = 5.0
MOST_BEAMS = 4096
LIDARS = ("ray", "gpu_ray", "lidar", "gpu_lidar")
CAMERAS = ("camera", "depth", "depth_camera", "rgbd", "rgbd_camera", "wideanglecamera", "multicamera")
BUMPERS = ("contact", "bumper")
LEAST_GAP, LEAST_SECTOR = 0.5, 0.05  # rad
NAMES = {
    "lidar": ("laser", "lidar", "scan", "hokuyo", "rplidar", "lds", "velodyne", "sick"),
    "imu": ("imu",),
    "camera": ("camera", "kinect", "realsense", "astra", "zed"),
}
SEVERAL = {"sonar": "sonars", "range": "rangefinders"}
"""Kinds of which a vehicle may have any number, and their sections."""
LEVEL, FAR = 0.99, 30.0  # of the axis' z, and m
NARROW, FEW = 0.6, 30  # rad and beams, below which rays are the cone of one reading
BEAM, NEAR = 0.1, 1.0  # rad and m, below which they are one beam, as of a cliff sensor
FIGURES = ("samples", "resolution", "min_angle", "max_angle", "min", "max", "stddev", "update_rate", "horizontal_fov", "width", "height")
LINK_KINDS = {"lidar": "ray", "imu": "imu", "camera": "camera"}


def sensors_section(foreign: Foreign, base_from_link: dict[str, Transform], moving: Collection[str]) -> Section:
    """The ``sensors`` section of a vehicle file: what the robot carries, what its links' names tell of, and encoders, which all have.

    moving: links that are moved on command: cameras without depth go with them.
    """
    section: Section = {}
    for sensor in sorted((*foreign.sensors, *_by_names(foreign)), key=lambda each: _rank(each, base_from_link)):
        _tell_odd(sensor, foreign)
        if sensor.kind.lower() in BUMPERS and sensor.link in base_from_link:
            bumper, felt = _bumper(sensor.link, foreign, base_from_link[sensor.link]), section.setdefault("bumpers", [])
            felt += [bumper] if bumper not in felt else []  # a file has one for each shape of a link
            continue
        kind, make = _kind(sensor)
        if make is None or sensor.link not in base_from_link:
            foreign.notes.add("sensors of a kind that is not simulated, dropped", f"{sensor.kind} on {sensor.link}")
            continue
        base_from_sensor = compose(base_from_link[sensor.link], sensor.link_from_sensor)
        mount, frame = _mount(base_from_sensor), sensor.link if _is_link_itself(sensor) else f"{sensor.link}_{kind}"
        if kind == "lidar" and not _is_level(base_from_sensor):
            foreign.notes.add("lidars that are not level dropped", sensor.link)
        elif kind == "lidar" and "lidar" in section:
            others = section.setdefault("other_lidars", [])
            taken = {section["lidar"]["frame"], *(other["frame"] for other in others)}
            others.append({"mount": mount, **make(sensor, foreign), "frame": frame if frame not in taken else f"{frame}_{len(others) + 2}"})
        elif kind in SEVERAL:
            all_of_it = section.setdefault(SEVERAL[kind], [])
            all_of_it.append({"mount": mount, **make(sensor, foreign), "frame": f"{sensor.link}_{kind}_{len(all_of_it) + 1}"})
        elif kind in section:
            foreign.notes.add(f"a vehicle has one {kind}; the others dropped", sensor.link)
        else:
            made = make(sensor, foreign)
            if sensor.link in moving and kind == "camera" and not made.get("depth"):
                mount = {"link": sensor.link, **_mount(sensor.link_from_sensor)}
            elif sensor.link in moving:
                foreign.notes.add("sensors on links that are moved on command stay where they are at zero", sensor.link)
            section[kind] = {"preset": "good"} if kind == "gnss" else {"mount": mount, **made, "frame": frame}
    foreign.notes.add("guessed: wheel encoders of 4096 ticks a turn at 50 Hz")
    section["encoders"] = {"hz": 50.0, "ticks_per_turn": 4096}
    return section


def _rank(sensor: ForeignSensor, base_from_link: dict[str, Transform]) -> float:
    """Of several lidars the one that sees most for SLAM is the first: level, about it, and far."""
    if _kind(sensor)[0] != "lidar" or sensor.element is None or sensor.link not in base_from_link:
        return 0.0
    beams, fan = _fan(sensor)
    area = fan * min(_number(sensor, "range/max", 10.0), FAR) ** 2 * min(beams, 360)
    return -area if _is_level(compose(base_from_link[sensor.link], sensor.link_from_sensor)) else -1e-9


def _bumper(link: str, foreign: Foreign, base_from_link: Transform) -> Section:
    """The sector, as seen from base_link, that the shapes of the link take; all round where they have none."""
    shapes = foreign.model.links[link].collisions or foreign.model.links[link].visuals
    corners = [apply(base_from_link, triangles(shape)[0])[:, :2] for shape in shapes]
    x, y = np.concatenate([np.zeros((0, 2)), *corners]).T
    bearings = np.sort(np.arctan2(y, x))
    gaps = np.diff(bearings, append=bearings[:1] + 2 * np.pi)
    if not len(gaps) or gaps.max() < LEAST_GAP:
        return {"name": link, "angle_min": -3.1416, "angle_max": 3.1416}
    after = int(np.argmax(gaps))
    first = float(bearings[(after + 1) % len(bearings)])
    width = max(2 * np.pi - float(gaps[after]), LEAST_SECTOR)
    return {"name": link, "angle_min": round(first, 4), "angle_max": round(first + width, 4)}


def _is_level(base_from_sensor: Transform) -> bool:
    return abs(float(rotate(base_from_sensor.rotation, np.array((0.0, 0.0, 1.0)))[2])) > LEVEL


def _by_names(foreign: Foreign) -> Iterator[ForeignSensor]:
    """Links that are called after a sensor which no tag tells of."""
    told = {_kind(sensor)[0] for sensor in foreign.sensors}
    for kind, words in NAMES.items():
        links = [n for n in foreign.model.links if any(w in n.lower() for w in words) and "optical" not in n.lower()]
        if kind not in told and links:
            link = next((n for n in links if "link" in n.lower() or "frame" in n.lower()), links[0])
            foreign.notes.add(f"guessed: a {kind} with the figures of a common one, by the name of a link", link)
            yield ForeignSensor(LINK_KINDS[kind], link)


def _kind(sensor: ForeignSensor) -> tuple[str, Callable[[ForeignSensor, Foreign], Section] | None]:
    kind = sensor.kind.lower()
    if kind == "sonar" or (kind in LIDARS and _gives_one_range(sensor)):
        return "sonar", _sonar
    if kind in LIDARS and sensor.element is not None and sensor.element.find(".//horizontal") is not None:
        beams, fan = _fan(sensor)
        if beams <= 1 or (fan < BEAM and _number(sensor, "range/max", FAR) < NEAR):
            return "range", _range_finder
        if fan < NARROW and beams < FEW:
            return "sonar", _sonar
    if kind in LIDARS:
        return "lidar", _lidar
    if kind in CAMERAS:
        return "camera", _camera
    if kind == "imu":
        return "imu", _imu
    if kind in ("gps", "navsat"):
        return "gnss", lambda sensor, foreign: {}
    return kind, None


def _gives_one_range(sensor: ForeignSensor) -> bool:
    """Whether a plugin makes one range of the rays: sonars and infrared, which Gazebo classic has no sensor for."""
    plugins = sensor.element.iter("plugin") if sensor.element is not None else ()
    return any("_range" in (p.get("filename") or "") or (p.findtext("output_type") or "").strip().endswith("Range") for p in plugins)


def _is_link_itself(sensor: ForeignSensor) -> bool:
    """Whether a link's frame is the sensor's: links that are called after a sensor."""
    named = any(word in sensor.link.lower() for words in NAMES.values() for word in words)
    return named and bool(np.linalg.norm(sensor.link_from_sensor.translation) < 1e-6)


def _mount(base_from_sensor: Transform) -> Section:
    xyz, rpy = base_from_sensor.translation, np.array(to_euler(base_from_sensor.rotation))
    return {"xyz": [round(float(v), 6) + 0.0 for v in xyz], "rpy": [round(float(v), 6) + 0.0 for v in rpy]}


def _number(sensor: ForeignSensor, way: str, default: float) -> float:
    """The first of the places ``a|b`` in which a finite number stands."""
    for each in way.split("|"):
        text = sensor.element.findtext(f".//{each}") if sensor.element is not None else None
        try:
            value = float(text) if text else np.nan
        except ValueError:
            continue
        if np.isfinite(value):
            return value
    return default


def _tell_odd(sensor: ForeignSensor, foreign: Foreign) -> None:
    """Figures of which a common one is taken."""
    for tag in sensor.element.iter(*FIGURES) if sensor.element is not None else ():
        text = (tag.text or "").strip()
        try:
            is_number = bool(np.isfinite(float(text or "0")))
        except ValueError:
            is_number = False
        if not is_number or (tag.tag == "samples" and float(text or "1") <= 0):
            foreign.notes.add("figures of sensors that cannot be, taken as of a common one", f"{tag.tag} {text} of {sensor.link}")


def _rate(sensor: ForeignSensor, default: float, fastest: float, foreign: Foreign) -> float:
    rate = _number(sensor, "update_rate", default) or default
    if rate > fastest:
        foreign.notes.add(f"rates above {fastest:g} Hz lowered to that", f"{sensor.kind} on {sensor.link}, {rate:g} Hz")
    return min(rate, fastest)


def _fan(sensor: ForeignSensor) -> tuple[float, float]:
    """Beams of a level row, and the angle [rad] over which they lie."""
    beams = _number(sensor, "horizontal/samples", 360) * _number(sensor, "horizontal/resolution", 1.0)
    return beams if beams > 0 else 360.0, _number(sensor, "horizontal/max_angle", 2 * np.pi) - _number(sensor, "horizontal/min_angle", 0.0)


def _lidar(sensor: ForeignSensor, foreign: Foreign) -> Section:
    if sensor.element is None or sensor.element.find(".//horizontal") is None:
        return {"preset": "lds01"}
    beams, fan = _fan(sensor)
    beams = round(beams)
    if _number(sensor, "vertical/samples", 1) > 1:
        foreign.notes.add("a lidar of several rows becomes one of the level row", sensor.link)
    if beams > MOST_BEAMS:
        foreign.notes.add(f"beams lowered to {MOST_BEAMS}", sensor.link)
    beams = min(max(beams, 1), MOST_BEAMS)
    sweep = min(fan, 2 * np.pi)
    return {
        "hz": _rate(sensor, 5.0, FASTEST, foreign),
        "beams": beams,
        "angle_min": _number(sensor, "horizontal/min_angle", 0.0),
        "angle_increment": sweep / max(beams if sweep > 2 * np.pi - 0.1 / max(beams, 1) else beams - 1, 1) or 0.01,
        "range_min": max(_number(sensor, "range/min", 0.1), 0.0),
        "range_max": max(_number(sensor, "range/max", 10.0), 0.2),
        "noise": abs(_number(sensor, "noise/stddev", 0.01)),
    }


def _range_finder(sensor: ForeignSensor, foreign: Foreign) -> Section:
    low = max(_number(sensor, "range/min", 0.02), 0.0)
    return {
        "hz": _rate(sensor, 10.0, FASTEST, foreign),
        "range_min": low,
        "range_max": max(_number(sensor, "range/max", 4.0), low + 0.01),
        "noise": abs(_number(sensor, "noise/stddev", 0.01)),
    }


def _sonar(sensor: ForeignSensor, foreign: Foreign) -> Section:
    low, high = _number(sensor, "range/min|sonar/min", 0.02), _number(sensor, "range/max|sonar/max", 4.0)
    cone = 2 * np.arctan2(_number(sensor, "sonar/radius", 0.25 * high), high)
    fan = _number(sensor, "horizontal/max_angle", cone / 2) - _number(sensor, "horizontal/min_angle", -cone / 2)
    return {
        "hz": _rate(sensor, 10.0, FASTEST, foreign),
        "fov": round(float(np.clip(fan, 0.01, 3.0)), 6),
        "range_min": max(low, 0.0),
        "range_max": max(high, low + 0.1),
        "noise": abs(_number(sensor, "noise/stddev", 0.01)),
    }


def _imu(sensor: ForeignSensor, foreign: Foreign) -> Section:
    return {
        "hz": _rate(sensor, 100.0, FASTEST, foreign),
        "gyro_noise": abs(_number(sensor, "angular_velocity/z/noise/stddev|rate/stddev", 0.002)),
        "gyro_bias": abs(_number(sensor, "angular_velocity/z/noise/bias_mean", 0.001)),
        "accel_noise": abs(_number(sensor, "linear_acceleration/x/noise/stddev|accel/stddev", 0.02)),
        "accel_bias": min(abs(_number(sensor, "linear_acceleration/x/noise/bias_mean", 0.02)), 0.2),
        "mag_noise": 5.0e-7,
    }


def _camera(sensor: ForeignSensor, foreign: Foreign) -> Section:
    kind = sensor.kind.lower()
    section = {
        "hz": _rate(sensor, 5.0, FASTEST_CAMERA, foreign),
        "width": int(np.clip(_number(sensor, "image/width", 320), 16, 1920)),
        "height": int(np.clip(_number(sensor, "image/height", 240), 16, 1080)),
        "fov": float(np.clip(_number(sensor, "horizontal_fov", 1.2), 0.1, 3.0)),
        "far": float(np.clip(_number(sensor, "clip/far", 20.0), 1.0, 1000.0)),
    }
    return {**section, "depth": True} if "depth" in kind or "rgbd" in kind else section
