"""The real renderer's depth pictures in the house, in lockstep, against the house's geometry."""

from dataclasses import replace

import numpy as np
import pytest

from launch import catalogue
from schemas import topics
from schemas.messages import FrameTransform, FrameTransforms, NavState, OctreeMap
from services.sim_camera.build import build as build_cameras
from services.slam.octree.build import build as build_octree
from uvf.maths.raycast import Rays, cast
from uvf.maths.rotations import from_euler, matrix, rotate
from uvf.models.scenario import ROOT, load_scenario
from uvf.models.shapes.scene import scene
from uvf.models.world.geometry import solids
from uvf.runtime.contract.declaration import Writes, topic
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.contract.service import Service
from uvf.runtime.messages.convert import quaternion, stamp, vector
from uvf.runtime.messages.sensor_frames import sensor_frames
from uvf.runtime.time.lockstep import Lockstep
from uvf.slam.octree.files import read_octree
from uvf.slam.octree.leaves import boxes, leaves_of
from uvf.slam.octree.octree import FREE, OCCUPIED

SITE = load_scenario(ROOT / "missions" / "mapping.yaml")
SENSORS = SITE.members["burger"].file.sensors
CELL = 0.05
REACH = 5.0  # m
SECONDS = 8.0


def pose_at(t):
    """Turns once about itself in the living room and goes on a little."""
    return np.array((2.2 + 0.1 * t, 1.3 + 0.02 * t, 0.0)), from_euler(0.0, 0.0, 2 * np.pi * t / SECONDS)


class Turner(Service):
    """Its true motion, and the frames of a vehicle that knows where it is."""

    name = "turner"
    hz = 50.0

    class Outputs(Writes):
        truth: NavState | None = topic(topics.TRUTH)
        body: FrameTransform | None = topic(topics.TF_BODY)
        sensors: FrameTransforms | None = topic(topics.TF_STATIC)

    def step(self, t: float, now) -> Outputs:
        position, turn = pose_at(t)
        state = NavState(timestamp=stamp(t), position=vector(position), orientation=quaternion(turn))
        body = FrameTransform(timestamp=stamp(t), parent_frame_id="world", child_frame_id="burger/base_link")
        body.translation.CopyFrom(vector(position))
        body.rotation.CopyFrom(quaternion(turn))
        return self.Outputs(truth=state, body=body, sensors=sensor_frames("burger", SENSORS, t) if t <= 0.02 else None)


def last_map(lockstep, until):
    """The burger's map as it is told last before ``until`` [s]."""
    maps = []
    lockstep.bus.subscribe(topics.OCTREE.at("burger"), topics.OCTREE.qos, lambda s: maps.append(OctreeMap.FromString(s.payload)))
    lockstep.run(until)
    lockstep.close()
    return read_octree(maps[-1].data, "map")


@pytest.fixture(scope="module")
def mapped():
    octree = [host for host in build_octree(SITE) if host.vehicle == "burger"]
    return last_map(Lockstep([*build_cameras(SITE), *octree, ServiceInstance(Turner, Turner, "burger")]), SECONDS + 3.0)


def surface_distance(solid, points):
    """(n,) m from points to a box's or an upright cylinder's surface."""
    local = (points - solid.position) @ matrix(solid.orientation)
    if solid.shape == "cylinder":
        radius, height = solid.size
        local = np.column_stack((np.hypot(local[:, 0], local[:, 1]), local[:, 2]))
        over = np.abs(local) - np.array((radius, height / 2))
    else:
        over = np.abs(local) - np.array(solid.size) / 2
    return np.abs(np.linalg.norm(np.maximum(over, 0.0), axis=1) + np.minimum(over.max(axis=1), 0.0))


def to_surface(points):
    """(n,) m to the nearest surface of the house or to its floor."""
    return np.min([np.abs(points[:, 2]), *(surface_distance(solid, points) for solid in solids(SITE.world))], axis=0)


def test_what_is_occupied_lies_on_a_surface_of_the_house(mapped):
    leaves = leaves_of(mapped)
    middles = boxes(leaves, CELL)[0][leaves.values >= 0]
    nearest = to_surface(middles)
    assert len(middles) > 5000
    assert (nearest <= 2 * CELL).mean() > 0.995
    assert np.quantile(nearest, 0.9) < CELL


def test_what_the_camera_has_seen_of_the_house_is_occupied(mapped):
    camera = SENSORS.camera
    rng, reaches = np.random.default_rng(1), np.tan(camera.fov / 2)
    found = []
    for t in np.arange(0.4, SECONDS, 0.4):
        position, turn = pose_at(t)
        eye = position + rotate(turn, np.array(camera.mount.xyz))
        side, up = rng.uniform(-1, 1, (2, 200)) * reaches
        rays = np.column_stack((np.ones(200), side, 0.75 * up)) @ matrix(turn).T
        rays /= np.linalg.norm(rays, axis=1)[:, None]
        ranges = cast(scene(solids(SITE.world)), [], Rays(eye, rays), REACH - 0.1)
        ends = eye + rays * ranges[:, None]
        found.append(ends[np.isfinite(ranges)])
    points = np.concatenate(found)
    steps = np.arange(-2, 3) * CELL
    near = np.zeros(len(points), dtype=bool)
    for offset in np.stack(np.meshgrid(steps, steps, steps), axis=-1).reshape(-1, 3):
        near |= mapped.states(points + offset) == OCCUPIED
    assert len(points) > 2000
    assert near.mean() > 0.98


def test_the_air_that_it_looked_through_is_free(mapped):
    rng = np.random.default_rng(2)
    around = pose_at(SECONDS / 2)[0] + np.column_stack((rng.uniform(-0.6, 0.6, (500, 2)), rng.uniform(0.1, 0.15, 500)))
    states = mapped.states(around[to_surface(around) > 2 * CELL])
    assert len(states) > 250
    assert (states == FREE).mean() > 0.98 and not (states == OCCUPIED).any()


def test_a_rover_that_explores_by_itself_maps_what_is_there():
    """With the pose that its own SLAM gives it."""
    alone = replace(SITE, members={"burger": SITE.members["burger"]})
    kinds = [catalogue.kind(name) for name in ("sim_ground", "sim_camera", "slam", "octree", "planner", "autopilot")]
    octree = last_map(Lockstep(catalogue.hosts(alone, kinds)), 12.2)
    leaves = leaves_of(octree)
    nearest = to_surface(boxes(leaves, CELL)[0][leaves.values >= 0])
    assert len(nearest) > 5000
    assert (nearest <= 2 * CELL).mean() > 0.99
