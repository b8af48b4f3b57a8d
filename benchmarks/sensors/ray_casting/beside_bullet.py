"""Rays of a lidar: UVF's own beside PyBullet's rayTestBatch on the same worlds, in one run: how fast, and how far they agree."""

import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.sensors.ray_casting.worlds import Twin, built_worlds, fan, grazing, low_places, meshes, mixed, random_scans, world
from uvf.maths.raycast import Rays, Scene, cast, warm_up

Floats = NDArray[np.float64]

MAX_RANGE = 12.0  # m
PLACES, ROUNDS = 20, 10
WORLDS = built_worlds()
SCANS: dict[str, tuple[Callable[[], Twin], Floats, float]] = {
    **{name: (partial(world, name), low_places(name), 0.1) for name in WORLDS},
    "mixed": (mixed, np.array(((-3.0, -3.0, -3.0), (3.0, 3.0, 3.0))), np.pi),
    "meshes": (meshes, np.array(((-3.0, -3.0, -0.5), (3.0, 3.0, 1.0))), np.pi),
}
"""World, the box of the poses [m], the largest roll and pitch [rad]."""


def speed(data: Path | None) -> dict[str, dict[str, float]]:
    """Time of a level scan: mean over 20 places of the best of 10, both taking turns; PyBullet is handed its lists ready made."""
    warm_up()
    rows = {}
    for name, (make, area, _) in SCANS.items():
        twin = make()
        sides = (twin.scene(), twin)
        points = np.random.default_rng(2).uniform(area[0], area[1], (2000, 3))
        places = points[twin.free(points)][:PLACES]
        for beams in (360, 720):
            own, bullet = np.mean([_scan_times(sides, place, beams) for place in places], axis=0) * 1e3
            rows[f"{name} {beams} beams"] = {"own ms": float(own), "PyBullet ms": float(bullet), "ratio": float(bullet / own)}
        twin.close()
    return rows


def _scan_times(sides: tuple[Scene, Twin], origin: Floats, beams: int) -> Floats:
    """[s] own and PyBullet's."""
    directions, taken = fan(beams), []
    starts, ends = np.tile(origin, (beams, 1)).tolist(), (origin + MAX_RANGE * directions).tolist()
    for _ in range(ROUNDS):
        begun = time.perf_counter()
        cast(sides[0], [], Rays(origin, directions), MAX_RANGE)
        between = time.perf_counter()
        sides[1].batch(starts, ends)
        taken.append((between - begun, time.perf_counter() - between))
    best: Floats = np.array(taken).min(axis=0)
    return best


def agreement(data: Path | None) -> dict[str, dict[str, float]]:
    """36 000 beams from 1000 random poses a world; differences of those that both meet and that graze no edge.

    Unlike are beams with which one side only meets something.
    """
    rows = {}
    for name, (make, area, tilt) in SCANS.items():
        twin = make()
        rays = random_scans(twin, np.random.default_rng(3), area, tilt)
        scene = twin.scene()
        own, bullet = cast(scene, [], rays, MAX_RANGE), twin.cast(rays, MAX_RANGE)
        graze = grazing(scene, rays, own, MAX_RANGE)
        met = np.isfinite(own) & np.isfinite(bullet)
        difference = np.abs(own[met] - bullet[met])
        median, high = np.quantile(difference[~graze[met]], (0.5, 0.999))
        unlike = np.isfinite(own) != np.isfinite(bullet)
        rows[f"{name} poses"] = {
            "median m": float(median),
            "99.9 % m": float(high),
            "grazing": float(graze.sum()),
            "unlike": float(unlike.sum()),
            "unlike, not grazing": float((unlike & ~graze).sum()),
            "beams": float(len(own)),
        }
        twin.close()
    return rows


CASES = {"speed": speed, "agreement": agreement}
