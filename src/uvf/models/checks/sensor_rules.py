"""Where a vehicle's sensors sit: in its tree of frames, above the floor, outside of its own body; a planar lidar level."""

from collections import Counter
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from uvf.maths.raycast import Rays, cast
from uvf.maths.rotations import from_euler, matrix, rotate, wrap
from uvf.maths.se3 import Transform
from uvf.models.checks.blind_sides import BESIDE, blind_sides
from uvf.models.shapes.mesh import placed
from uvf.models.shapes.scene import scene
from uvf.models.urdf.outline import plan_outline
from uvf.models.urdf.robot import UrdfModel
from uvf.models.vehicle.sensors import Lidar, Mount, Sensors
from uvf.models.yaml_data import FileLocation, Key

APART = 0.03  # m, between a sensor's mount and the link of its name: the link may be the housing
SUNK = 0.001  # m below the floor
TILT = 0.035  # rad (2 deg), from which on the scan meets the floor or misses walls
FARTHEST = 300.0  # m; scanners for surveys outdoors reach it
OWN = 2.0  # m from the lidar, within which its own vehicle is
SHUT = 0.95  # of the beams, from which on a lidar that they keep from the world sees nothing
NEEDED = {"lidar": "preset: lds01, mount: {xyz: [0, 0, 0.2]}", "encoders": "hz: 50, ticks_per_turn: 4096"}
SPOKEN = {"other_lidars": "lidar", "sonars": "sonar", "rangefinders": "range finder"}
HOUSINGS = ("lidar", "laser", "scan", "hokuyo", "lds", "rplidar", "sick", "velodyne")

Poses = Mapping[str, Transform]


def sensor_faults(model: UrdfModel, sensors: Sensors, poses: Poses, place: FileLocation) -> Iterator[str]:
    """Faults of the sensors' mounts: frames named twice or apart from the links of their names, places below the floor.

    And of a scanner: shut up in the body, tilted, or seeing farther than any.
    """
    seen: dict[str, str] = {}
    for keys, sensor in mounted(sensors):
        where = place.at(*keys, "frame")
        if sensor.frame in seen:
            yield f"{where}: '{sensor.frame}' is the frame of {seen[sensor.frame]} too; give each a name of its own"
        seen[sensor.frame] = str(keys[0])
        link = poses.get(sensor.frame)
        apart = np.linalg.norm(link.translation - np.array(sensor.mount.xyz)) if link is not None else 0.0
        if apart > APART:
            mend = f"change its place in the URDF and write mount: {{link: {sensor.frame}}}, or give it another frame"
            what = f"link '{sensor.frame}' of the URDF is {apart:.3f} m from the mount"
            yield f"{where}: {what}; to move the {SPOKEN.get(str(keys[0]), keys[0])}, {mend}"
        if (z := sensor.mount.xyz[2]) < -SUNK:
            yield f"{place.at(*keys, 'mount')}: z {z:.4g} m is below the floor, which is z = 0 of base_link; raise it"
    for keys, lidar in mounted(sensors):
        if not isinstance(lidar, Lidar):
            continue
        yield from _lidar_faults(lidar, place.at(*keys))
        met = [name for name in _links_met(model, lidar, poses) if name]
        if len(met) >= SHUT * lidar.beams:
            link_name = Counter(met).most_common(1)[0][0]
            yield (f"{place.at(*keys, 'mount')}: the lidar is inside of link '{link_name}' and would see nothing else; mount it outside")


def _lidar_faults(lidar: Lidar, place: FileLocation) -> Iterator[str]:
    """A scan that is not level, or ranges in another unit. A scanner upside down is level."""
    up = rotate(from_euler(*lidar.mount.rpy), np.array((0.0, 0.0, 1.0)))
    tilt = float(np.arctan2(np.hypot(up[0], up[1]), abs(up[2])))
    if tilt > TILT:
        also = "" if lidar.mount.link is None else f", here and of link '{lidar.mount.link}' in the URDF"
        remedy = f"set roll and pitch to 0{also}"
        yield f"{place.at('mount')}: the lidar is tilted by {tilt:.2g} rad; a planar scan has to be level: {remedy}"
    if lidar.range_max > FARTHEST:
        remedy = f"give metres (if this is in millimetres: {lidar.range_max / 1000:g})"
        yield f"{place.at('range_max')}: {lidar.range_max:g} m is farther than any planar scanner sees ({FARTHEST:g} m); {remedy}"


def sensor_notes(model: UrdfModel, sensors: Sensors, poses: Poses, turning: set[str]) -> Iterator[str]:
    """Remarks on sensors that missions need and the vehicle lacks, and on beams that the vehicle's own body is in the way of."""
    for kind, example in NEEDED.items():
        if getattr(sensors, kind) is None:
            yield f"no {kind}: no mission takes it, for SLAM needs them; give it sensors: {kind}: {{{example}}}"
    seen_from = [(lidar, np.array([bool(name) for name in _links_met(model, lidar, poses)])) for lidar in sensors.lidars]
    for lidar, met in seen_from:
        share = float(met.mean())
        if 0.0 < share < SHUT:
            which = "lidar" if not sensors.other_lidars else f"lidar '{lidar.frame}'"
            yield f"{100 * share:.0f} % of the {which}'s beams meet the vehicle's own body"
    outline = plan_outline(model)
    if seen_from and outline is not None:
        for first, last in blind_sides(outline, seen_from):
            side = f"from {_signed(first):.0f} to {_signed(last):.0f} deg, counter-clockwise from ahead"
            yield f"no lidar sees what stands {BESIDE:g} m beside it {side}: only what was seen there before is known of"


def _signed(bearing: float) -> float:
    """Degrees, -180 to 180."""
    return float(np.degrees(wrap(bearing)))


def mounted(sensors: Sensors) -> Iterator[tuple[tuple[Key, ...], Any]]:
    """(keys in the file, sensor) of each sensor that has a mount."""
    for kind in ("lidar", "imu", "camera", "chase", "gimbal"):
        sensor = getattr(sensors, kind)
        if sensor is not None:
            yield (kind,), sensor
    for kind in ("other_lidars", "sonars", "rangefinders"):
        yield from (((kind, i), sensor) for i, sensor in enumerate(getattr(sensors, kind)))


def _links_met(model: UrdfModel, lidar: Lidar, poses: Poses) -> list[str]:
    """Of each beam: the link of the vehicle's own body that it meets first, other than the lidar's housing; "" where it meets none.

    By what is seen, for collision shapes are often hulls that bridge the slot in which a scanner is.
    """
    angles = lidar.angle_min + np.arange(lidar.beams) * lidar.angle_increment
    level = np.column_stack((np.cos(angles), np.sin(angles), np.zeros(len(angles))))
    rays = Rays(np.array(lidar.mount.xyz), level @ matrix(from_euler(*lidar.mount.rpy)).T)
    bodies = {
        name: link.visuals or link.collisions for name in poses if not _houses(model, name, lidar, poses) and (link := model.links[name])
    }
    names = [name for name, solids in bodies.items() if solids]
    ranges = [cast(scene((placed(s, poses[name]) for s in bodies[name]), None), [], rays, OWN) for name in names]
    nearest = np.argmin(ranges, axis=0) if names else np.zeros(0, dtype=int)
    return [names[link] if np.isfinite(ranges[link][beam]) else "" for beam, link in enumerate(nearest)] or [""] * lidar.beams


def _houses(model: UrdfModel, link: str, lidar: Lidar, poses: Poses) -> bool:
    """Whether a link is the lidar itself: named as its frame or mount, or after a scanner, and where the lidar is."""
    mount: Mount = lidar.mount
    if link in (lidar.frame, mount.link):
        return True
    near = np.linalg.norm(poses[link].translation - np.array(mount.xyz)) < 0.15
    return bool(near and link not in model.roots and any(word in link.lower() for word in HOUSINGS))
