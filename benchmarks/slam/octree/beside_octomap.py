"""Maps in space: UVF's blocks beside OctoMap's octree (octomap-python) on the same scans, in one run.

``pictures``: 100 depth pictures of 160 x 120 from free places of the house, no return beyond 5 m. ``sweeps``: 100 sweeps of a 30 m lidar
with 361 beams below an aircraft that passes over the house in 20 m. Each scan is put into the one and then into the other; times are this
process's CPU time. ``handing over`` is what octomap-python needs to copy a scan's points, which OctoMap's time includes and the ratio does
not. OctoMap's memory is what it counts itself, its nodes without what the allocator adds; UVF's is all that is allocated. ``unlike`` counts
leaves that are not the same in both, by place, size and log-odds; ``same bytes`` is 1 when the .ot and .bt files are equal.
"""

import time
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from uvf.maths.raycast import Rays, Scene, cast
from uvf.maths.rotations import from_euler, matrix
from uvf.models.scenario import ROOT
from uvf.models.shapes.scene import scene
from uvf.models.world.file import load_world
from uvf.models.world.geometry import floor_plan, solids
from uvf.models.yaml_data import BadInput
from uvf.slam.octree.files import read_octree, to_bt, to_ot
from uvf.slam.octree.leaves import Leaves, leaves_of
from uvf.slam.octree.octree import Octree

Floats = NDArray[np.float64]
Scan = tuple[Floats, Floats]
"""Origin (3,) and ends (n, 3) of the beams [m]; those without a return end far away."""

WORLD = "house"
COUNT = 100
WIDTH, HEIGHT, FOV = 160, 120, 1.2
PICTURE_REACH, SWEEP_REACH = 5.0, 30.0  # m
EYE = 0.3  # m above the floor
FLYING = 20.0  # m
RESOLUTIONS = (0.1, 0.05)  # m


def house() -> Scene:
    """What rays meet in the house."""
    return scene(solids(load_world(ROOT / "worlds", WORLD)))


def pictures() -> Iterator[Scan]:
    """Of a camera that looks level or a little up or down, to any side."""
    plan = floor_plan(load_world(ROOT / "worlds", WORLD), 0.1, 1.0)
    rng, seen = np.random.default_rng(1), house()
    rows, columns = np.nonzero(~plan.cells)
    focal = WIDTH / 2 / np.tan(FOV / 2)
    down, across = np.mgrid[:HEIGHT, :WIDTH]
    rays = np.stack((np.full(down.shape, focal), (WIDTH - 1) / 2 - across, (HEIGHT - 1) / 2 - down), axis=2).reshape(-1, 3)
    rays /= np.linalg.norm(rays, axis=1)[:, None]
    for place in rng.choice(len(rows), COUNT, replace=False):
        origin = np.array((plan.x + (columns[place] + 0.5) * 0.1, plan.y + (rows[place] + 0.5) * 0.1, EYE))
        turned = rays @ matrix(from_euler(0.0, rng.uniform(-0.3, 0.3), rng.uniform(-np.pi, np.pi))).T
        yield origin, _ends(seen, origin, turned, PICTURE_REACH)


def sweeps() -> Iterator[Scan]:
    """Across the way of an aircraft that flies east over the middle of the house at 25 m/s, 40 sweeps a second."""
    seen, angles = house(), np.linspace(-np.pi / 4, np.pi / 4, 361)
    rays = np.column_stack((np.zeros(361), np.sin(angles), -np.cos(angles)))
    for i in range(COUNT):
        roll = 0.05 * np.sin(0.1 * i)
        origin = np.array((-25.0 + 25.0 / 40.0 * i, 4.5 + 0.5 * np.sin(0.05 * i), FLYING))
        yield origin, _ends(seen, origin, rays @ matrix(from_euler(roll, 0.02, 0.1)).T, SWEEP_REACH)


def _ends(seen: Scene, origin: Floats, rays: Floats, reach: float) -> Floats:
    ranges = cast(seen, [], Rays(origin, rays), reach)
    ends: Floats = origin + rays * np.where(np.isfinite(ranges), ranges, 2 * reach)[:, None]
    return ends


def _unlike(one: Leaves, other: Leaves) -> int:
    """Leaves of either that the other does not have just so."""
    _, i, j = np.intersect1d(one.codes, other.codes, assume_unique=True, return_indices=True)
    alike = (one.depths[i] == other.depths[j]) & (one.values[i] == other.values[j])
    return len(one.codes) + len(other.codes) - 2 * int(alike.sum())


def compared(make: partial[Iterator[Scan]], reach: float, data: Path | None) -> dict[str, dict[str, float]]:
    """A row for each resolution: times a scan [ms], memory [MB], and what is unlike in both."""
    try:
        import octomap
    except ImportError as error:
        raise BadInput("octomap-python is not installed: .venv/bin/pip install octomap-python") from error
    scans, rows = list(make()), {}
    Octree(0.1).insert(*scans[0], reach)
    for resolution in RESOLUTIONS:
        ours, theirs, ignored = Octree(resolution), octomap.OcTree(resolution), octomap.OcTree(resolution)
        spent = np.zeros(3)
        for origin, ends in scans:
            begun = time.process_time()
            ours.insert(origin, ends, reach)
            spent[0] += time.process_time() - begun
            begun = time.process_time()
            theirs.insertPointCloud(ends, origin, reach)
            spent[1] += time.process_time() - begun
            begun = time.process_time()
            ignored.insertPointCloud(ends, origin, 1e-6)
            spent[2] += time.process_time() - begun
        own, octo, handing = spent / len(scans) * 1e3
        unlike = _unlike(leaves_of(ours), leaves_of(read_octree(theirs.write(), "OctoMap's")))
        rows[f"{make.func.__name__} at {resolution:g} m"] = {
            "own ms": own,
            "OctoMap ms": octo,
            "handing over ms": handing,
            "ratio": (octo - handing) / own,
            "own MB": ours.memory / 1e6,
            "OctoMap MB": theirs.memoryUsage() / 1e6,
            "leaves": float(len(leaves_of(ours).codes)),
            "unlike": float(unlike),
            **_files(ours, theirs),
        }
    return rows


def _files(ours: Octree, theirs: object) -> dict[str, float]:
    """Time for both files, and whether they are the same."""
    spent, written = [], []
    for write in (lambda: _own_files(ours), lambda: (theirs.write(), theirs.writeBinary())):  # type: ignore[attr-defined]
        begun = time.process_time()
        written.append(write())
        spent.append((time.process_time() - begun) * 1e3)
    return {"own files ms": spent[0], "OctoMap files ms": spent[1], "same bytes": float(written[0] == written[1])}


def _own_files(ours: Octree) -> tuple[bytes, bytes]:
    leaves = leaves_of(ours)
    return to_ot(leaves, ours.resolution), to_bt(leaves, ours.resolution)


CASES = {
    "pictures": partial(compared, partial(pictures), PICTURE_REACH),
    "sweeps": partial(compared, partial(sweeps), SWEEP_REACH),
}
