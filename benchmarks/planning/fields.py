"""Fields to cover: those of a data folder, and random ones."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from uvf.maths.geodesy import LocalTangent
from uvf.models.importing.areas import DrawnArea, read_areas
from uvf.planning.coverage.field import CoverageField, make_field

RANDOM = 20


def field_of(area: DrawnArea) -> CoverageField:
    """The field of an area as drawn, about its own middle."""
    longitude, latitude = area.middle if area.in_degrees else (0.0, 0.0)
    outline, holes = area.rings_about(LocalTangent.from_degrees(latitude, longitude, 0.0))
    return make_field(outline, holes)


def drawn_fields(data: Path) -> Iterator[tuple[str, CoverageField]]:
    """Every polygon in the files of ``data``/coverage, by name; files with lines alone have none."""
    for path in sorted((data / "coverage").iterdir()):
        if path.suffix in (".json", ".geojson", ".xml") and "olygon" in path.read_text(encoding="utf-8"):
            for area in read_areas(path):
                yield area.name, field_of(area)


def random_field(seed: int) -> CoverageField:
    """A concave outline about 400 m across, of 8 to 20 corners at random distances from the middle, with up to three holes."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(8, 21))
    angles = np.linspace(0.0, 2 * np.pi, count, endpoint=False) + 0.3 * rng.uniform(-1, 1, count) * 2 * np.pi / count
    radii = rng.uniform(130.0, 330.0, count)
    stretch = rng.uniform(0.6, 1.6)
    outline = np.column_stack((stretch * radii * np.cos(angles), radii * np.sin(angles) / stretch))
    holes = []
    for _ in range(int(rng.integers(0, 4))):
        corners = int(rng.integers(3, 8))
        around = np.linspace(0.0, 2 * np.pi, corners, endpoint=False) + rng.uniform(0, 2 * np.pi)
        middle, size = rng.uniform(-120.0, 120.0, 2), rng.uniform(15.0, 45.0)
        holes.append(middle + size * rng.uniform(0.6, 1.0, corners)[:, None] * np.column_stack((np.cos(around), np.sin(around))))
    return make_field(outline, holes)
