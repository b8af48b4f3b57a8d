"""Scans of discs and walls in closed form, in plain numpy, for lidars of any kind; and a run of the tracker over them."""

from dataclasses import dataclass

import numpy as np

from uvf.planning.costmap.obstacle_layer import BeamObservation, ObstacleLayer
from uvf.planning.moving.tracks import MovingObjects, SeenFrom

DT = 0.05  # s from scan to scan


@dataclass(frozen=True)
class Lidar:
    """A planar lidar: view [rad], beams, farthest [m], noise [m]."""

    view: float = np.deg2rad(270.0)
    beams: int = 720
    farthest: float = 20.0
    noise: float = 0.003

    @property
    def angles(self):
        """(beams,) rad, counter-clockwise."""
        return np.linspace(-self.view / 2, self.view / 2, self.beams)

    def ranges(self, pose, discs, walls, rng):
        """(beams,) m, 0 = no return. pose: x, y, yaw; discs (n, 3) x, y, radius; walls (m, 3): normal's angle, distance, unused."""
        rays = np.column_stack((np.cos(self.angles + pose[2]), np.sin(self.angles + pose[2])))
        out = np.full(self.beams, np.inf)
        for x, y, radius in discs:
            ahead = rays @ np.array((x - pose[0], y - pose[1]))
            inside = radius**2 - ((x - pose[0]) ** 2 + (y - pose[1]) ** 2 - ahead**2)
            hit = (inside > 0.0) & (ahead > 0.0)
            out[hit] = np.minimum(out[hit], ahead[hit] - np.sqrt(inside[hit]))
        for angle, distance in walls:
            normal = np.array((np.cos(angle), np.sin(angle)))
            towards = rays @ normal
            with np.errstate(divide="ignore"):
                along = (distance - normal @ pose[:2]) / towards
            out = np.where((towards > 1e-9) & (along > 0.0), np.minimum(out, along), out)
        out = out + self.noise * rng.standard_normal(self.beams)
        return np.where(out < self.farthest, np.maximum(out, 0.0), 0.0)

    def points(self, pose, ranges):
        """(beams, 2) m, where the beams end, in the frame of the pose; those without a return at the farthest."""
        reach = np.where(ranges > 0.0, ranges, self.farthest)
        return np.array(pose[:2]) + reach[:, None] * np.column_stack((np.cos(self.angles + pose[2]), np.sin(self.angles + pose[2])))


def follow(discs_at, seconds, *, lidar=None, walls=(), pose_at=lambda t: (0.0, 0.0, 0.0), seed=0):
    """Yields (t, tracker, mask, ranges, points) after every scan. discs_at, pose_at: functions of t [s]."""
    lidar = lidar or Lidar()
    rng = np.random.default_rng(seed)
    tracker, layer = MovingObjects(), ObstacleLayer(24.0, 0.05)
    for k in range(round(seconds / DT)):
        t = k * DT
        pose = np.array(pose_at(t))
        ranges = lidar.ranges(pose, discs_at(t), walls, rng)
        points = lidar.points(pose, ranges)
        eye = pose[0], pose[1]
        layer.recentre(eye)
        mask = tracker.observe(t, points, ranges, SeenFrom(eye, layer.lately_free(t, eye, points)))
        layer.observe(BeamObservation(t, t, eye, points, (ranges > 0.0) & ~mask))
        yield t, tracker, mask, ranges, points


def nearest(found, place):
    """The row of (m, 5) nearest to a place, and how far [m] it is; (None, inf) where there is none."""
    if not len(found):
        return None, np.inf
    away = np.hypot(found[:, 0] - place[0], found[:, 1] - place[1])
    return found[int(np.argmin(away))], float(away.min())
