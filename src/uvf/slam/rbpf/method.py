"""A Rao-Blackwellized particle filter: each particle has a path and the map that goes with it.

Grisetti, Stachniss & Burgard, "Improved Techniques for Grid Mapping with Rao-Blackwellized Particle Filters" (2007). Unlike
there, readings between two updates are matched to the best particle's map, so that each has a good pose and each update a
good start.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from math import hypot, pi, sqrt

import numpy as np
from numpy.typing import NDArray

from uvf.maths.se2 import IDENTITY, Pose2, compose, inverse
from uvf.maths.se2_arrays import composed, wrapped
from uvf.slam.logs.jumps import step_between
from uvf.slam.maps.shared_tiles import SharedEvidence, SharedTiles
from uvf.slam.maps.tile_pool import TilePool
from uvf.slam.matching.points import points_of
from uvf.slam.method import Keyframe, SlamEstimate
from uvf.slam.rbpf.fit import Gaussian, Sweep
from uvf.slam.rbpf.motion import MotionModel
from uvf.slam.rbpf.params import RbpfParams
from uvf.slam.rbpf.particle_step import draw_pose, match
from uvf.slam.rbpf.particles import Particles
from uvf.slam.rbpf.surfaces import SURFACES, ParticleMap, add_surfaces
from uvf.slam.reading import Reading

Floats = NDArray[np.float64]

EVIDENCE = SharedEvidence(hit=17, miss=-8, lowest=-60, highest=70)
"""In units of 0.05 (Thrun et al. 2005, table 9.2)."""
POINTS = 180  # of a sweep that are matched, at most
MEGABYTE = 1_000_000
STOOD = 1e-4  # m, rad: odometry that moves less has not moved


@dataclass
class RbpfSlam:
    """Rao-Blackwellized particle filter; see ``SlamMethod``."""

    params: RbpfParams = field(default_factory=RbpfParams)

    def __post_init__(self) -> None:
        p = self.params
        self.particles = Particles(p.particles)
        memory = p.mapMemory * MEGABYTE
        self.tiles = SharedTiles(p.particles, np.int8, p.delta, 2 * memory / 3)
        self.surfaces = TilePool(p.particles, SURFACES, p.delta, memory / 3)
        self._reach = min(p.maxUrange, self._reach_that_fits())
        self.resampled = 0
        """How often."""
        self._rng = np.random.default_rng(p.seed)
        self._model = MotionModel(p.srr, p.srt, p.str, p.stt)
        self._readings: list[Reading] = []
        self._placed: list[tuple[int, Pose2]] = []
        self._last: Reading | None = None
        self._driven = self._tracked = IDENTITY
        self._noise = np.zeros((3, 3))
        self._quality = 1.0

    def add(self, reading: Reading) -> SlamEstimate:
        """Tracks one reading against the best particle's map, and updates all particles if the vehicle has moved enough."""
        sweep = (points_of(reading, self._reach, POINTS), reading.beams.origin)
        last, self._last = self._last, reading
        if last is None:
            self._begin(reading)
            return self._place()
        step = step_between(last, reading) or IDENTITY
        self._driven, self._tracked = compose(self._driven, step), compose(self._tracked, step)
        if hypot(step.x, step.y) > STOOD or abs(step.yaw) > STOOD:
            self._track(sweep)
        if hypot(self._tracked.x, self._tracked.y) > self.params.linearUpdate or abs(self._tracked.yaw) > self.params.angularUpdate:
            self._update(reading, sweep)
        return self._place()

    def trajectory(self) -> Floats:
        """Poses map_from_base (readings, 3) [m, m, rad] by the path of the best particle."""
        nodes = np.array([node for node, _ in self._placed], dtype=np.int64)
        moved = np.array([pose for _, pose in self._placed]).reshape(-1, 3)
        path = self.particles.path(self.particles.best)
        return composed(path[nodes], moved) if len(nodes) else moved

    def keyframes(self) -> Iterator[Keyframe]:
        """The readings that the best particle's map is made of, from where it has them."""
        for pose, reading in zip(self.particles.path(self.particles.best).tolist(), self._readings, strict=True):
            yield Keyframe(Pose2(*pose), reading)

    def keyframe_count(self) -> int:
        """Number of readings that the maps are made of."""
        return len(self._readings)

    @property
    def notes(self) -> list[str]:
        """Remarks where the memory was too small for the maps, a line each."""
        full, found = f"the {self.params.mapMemory:g} MB of mapMemory", []
        if self._readings and self._reach < min(self.params.maxUrange, self._readings[0].beams.range_max):
            found.append(f"beams are used up to {self._reach:.0f} m only: more of {len(self.particles)} particles does not fit into {full}")
        if self.tiles.forgotten or self.surfaces.forgotten:
            found.append(f"{full} are full: maps forget what was seen longest ago, and loops that lead back there are not closed")
        return found

    def finish(self) -> None:
        """Does nothing: no work has been put off."""

    def _begin(self, reading: Reading) -> None:
        """All particles begin with one map."""
        self._draw(0, reading)
        self._take(np.zeros(len(self.particles), dtype=np.int64))
        self._keep(reading)

    def _keep(self, reading: Reading) -> None:
        self.particles.keep()
        self._readings.append(reading)
        self._driven = self._tracked = IDENTITY

    def _place(self) -> SlamEstimate:
        self._placed.append((self.particles.steps - 1, self._tracked))
        return SlamEstimate(compose(self._pose(self.particles.best), self._tracked), self.particles.spread() + self._noise, self._quality)

    def _track(self, sweep: Sweep) -> None:
        """Between updates: where the best particle's map has the sweep."""
        best = self.particles.best
        prior, before = self._prior(best), self._pose(best)
        matched = match(np.array(compose(before, self._tracked)), sweep, self._map(best), prior, self.params)
        self._noise, self._quality = matched.covariance(prior, self.params), matched.share
        self._tracked = compose(inverse(before), Pose2(*matched.pose.tolist()))

    def _update(self, reading: Reading, sweep: Sweep) -> None:
        """Algorithm 1: every particle finds its place, those that fit best live on."""
        factors = np.zeros(len(self.particles))
        poses = np.empty((len(self.particles), 3))
        for k in range(len(self.particles)):
            prior, maps = self._prior(k), self._map(k)
            matched = match(np.array(compose(self._pose(k), self._tracked)), sweep, maps, prior, self.params)
            poses[k], factors[k] = draw_pose(matched, sweep, maps, prior, self.params, self._rng)
        poses[:, 2] = wrapped(poses[:, 2])
        self.particles.poses = poses
        self.particles.reweigh(factors)
        self._keep(reading)
        for k in range(len(self.particles)):
            self._draw(k, reading)
        if self.particles.effective < self.params.resampleThreshold * len(self.particles):
            self._take(self.particles.resample(self._rng))
            self.resampled += 1

    def _draw(self, k: int, reading: Reading) -> None:
        if reading.ranges.shape != reading.beams.bearings.shape:
            return
        drawn = self.tiles.draw(k, reading, self._pose(k), EVIDENCE, self._reach)
        if drawn is not None:
            add_surfaces(drawn, self.surfaces, k)

    def _map(self, k: int) -> ParticleMap:
        return self.tiles.grid(k), self.surfaces.grid(k)

    def _take(self, ancestors: NDArray[np.int64]) -> None:
        self.tiles.take(ancestors)
        self.surfaces.take(ancestors)

    def _reach_that_fits(self) -> float:
        """m; so far that a sweep of each particle fills three quarters of the tiles, so that none draws in vain."""
        side, own = self.tiles.kind.side * self.tiles.cell, 0.75 * self.tiles.capacity / len(self.particles)
        return side * max(1.0, sqrt(own / pi) - 1.0)

    def _pose(self, k: int) -> Pose2:
        return Pose2(*self.particles.poses[k].tolist())

    def _prior(self, k: int) -> Gaussian:
        """p(x_t | x_t-1, u_t) of particle k."""
        mean = compose(self._pose(k), self._driven)
        return np.array(mean), np.linalg.inv(self._model.covariance(self._driven)).astype(np.float64)
