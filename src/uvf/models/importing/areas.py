"""Areas that others drew: polygons of GeoJSON (RFC 7946), KML 2.2 and GML 2 files, and of plain YAML, in metres of a local frame."""

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import msgspec
import numpy as np
from lxml import etree
from msgspec import Meta
from numpy.typing import NDArray

from uvf.maths.geodesy import LocalTangent
from uvf.models.yaml_data import BadInput, load_yaml

Floats = NDArray[np.float64]

WIDEST = 1.0  # degrees: coordinates that reach farther are metres of a local frame
MOST_BYTES = 20_000_000
JSON, XML, YAML = (".json", ".geojson"), (".kml", ".gml", ".xml"), (".yaml", ".yml")
OUTER, INNER = ("outerBoundaryIs", "exterior"), ("innerBoundaryIs", "interior")

Corner = tuple[Annotated[float, Meta(ge=-1e6, le=1e6)], Annotated[float, Meta(ge=-1e6, le=1e6)]]


class AreaFile(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """An area in a YAML file: corners [x, y] in metres, east and north of the world's origin."""

    outline: list[Corner]
    holes: list[list[Corner]] = []


@dataclass(frozen=True)
class DrawnArea:
    """One polygon of a file: ``outline`` (n, 2) and ``holes`` (n, 2), in degrees (longitude, latitude) or in metres (east, north)."""

    name: str
    outline: Floats
    holes: tuple[Floats, ...]
    in_degrees: bool

    @property
    def middle(self) -> tuple[float, float]:
        """Middle of the bounding box, in the units of the outline."""
        x, y = ((self.outline.min(axis=0) + self.outline.max(axis=0)) / 2).tolist()
        return x, y

    def rings_about(self, origin: LocalTangent) -> tuple[Floats, tuple[Floats, ...]]:
        """Outline and holes (n, 2) [m], east and north in the frame that touches the Earth at ``origin``; metres are left as they are."""
        if not self.in_degrees:
            return self.outline, self.holes
        return _local(self.outline, origin), tuple(_local(hole, origin) for hole in self.holes)


def read_areas(path: Path) -> list[DrawnArea]:
    """Every polygon of a .geojson, .json, .kml, .gml, .xml or .yaml file; lines and points are left out. Raises BadInput.

    Coordinates of JSON and XML are degrees, longitude first; where they reach over more than a degree, metres of a local frame.
    """
    ending = path.suffix.lower()
    if ending not in (*JSON, *XML, *YAML):
        raise BadInput(f"{path}: an area is a polygon in a .geojson, .json, .kml, .gml, .xml or .yaml file; name one of these")
    if ending in YAML:
        file = load_yaml(path, AreaFile)
        return [DrawnArea(path.stem, _ring(file.outline), tuple(_ring(hole) for hole in file.holes), False)]
    data = _bytes(path)
    polygons = list(_of_json(data, path) if ending in JSON else _of_xml(data, path))
    if not polygons:
        raise BadInput(f"{path}: there is no polygon in it; draw the area as a polygon, not as a line or a point")
    return [_area(f"{path.stem} {number}" if len(polygons) > 1 else path.stem, rings, path) for number, rings in enumerate(polygons)]


def _bytes(path: Path) -> bytes:
    try:
        if path.stat().st_size > MOST_BYTES:
            raise BadInput(f"{path}: larger than {MOST_BYTES // 1_000_000} MB; keep only the polygon in it")
        return path.read_bytes()
    except OSError as error:
        raise BadInput(f"{path}: cannot be read: {error.strerror}") from error


def _area(name: str, rings: Sequence[Any], path: Path) -> DrawnArea:
    try:
        arrays = [_ring(ring) for ring in rings]
    except (TypeError, ValueError, IndexError) as error:
        raise BadInput(f"{path}: polygon '{name}': its corners are not pairs of numbers; write longitude and latitude of each") from error
    if not arrays or any(len(ring) == 0 for ring in arrays):
        raise BadInput(f"{path}: polygon '{name}' has a ring without corners; give three at least")
    spread = float(np.ptp(arrays[0], axis=0).max())
    far = max(float(np.abs(ring[:, 0]).max()) > 360.0 or float(np.abs(ring[:, 1]).max()) > 90.0 for ring in arrays)
    return DrawnArea(name, arrays[0], tuple(arrays[1:]), not far and spread <= WIDEST)


def _ring(corners: Sequence[Any]) -> Floats:
    return np.array([(float(corner[0]), float(corner[1])) for corner in corners], dtype=np.float64).reshape(-1, 2)


def _of_json(data: bytes, path: Path) -> Iterator[Sequence[Any]]:
    """The rings of each polygon, wherever it stands in the document."""
    try:
        document = json.loads(data)
    except (ValueError, RecursionError) as error:
        raise BadInput(f"{path}: not valid JSON: {' '.join(str(error).split())}; export it again") from error
    waiting = [document]
    while waiting:
        each = waiting.pop(0)
        if not isinstance(each, dict):
            continue
        kind, rings = each.get("type"), each.get("coordinates")
        if kind == "Polygon" and isinstance(rings, list):
            yield rings
        elif kind == "MultiPolygon" and isinstance(rings, list):
            yield from (polygon for polygon in rings if isinstance(polygon, list))
        for inner in ("features", "geometries"):
            if isinstance(each.get(inner), list):
                waiting += each[inner]
        waiting.append(each.get("geometry"))


def _of_xml(data: bytes, path: Path) -> Iterator[Sequence[Any]]:
    """The rings of each <Polygon> of KML or GML 2, in whatever namespace."""
    try:
        root = etree.fromstring(data, etree.XMLParser(remove_comments=True, remove_pis=True, resolve_entities=False))
    except (etree.XMLSyntaxError, ValueError) as error:
        line = getattr(error, "lineno", None) or 1
        raise BadInput(f"{path}:{line}: not valid XML: {' '.join(str(error).split())}; mend the tag there") from error
    for polygon in root.iter("{*}Polygon"):
        outer = [ring for name in OUTER for ring in polygon.iter(f"{{*}}{name}")]
        inner = [ring for name in INNER for ring in polygon.iter(f"{{*}}{name}")]
        yield [_coordinates(ring, path) for ring in (*outer[:1], *inner)]


def _coordinates(ring: Any, path: Path) -> list[list[str]]:
    text = next((each.text for each in ring.iter("{*}coordinates")), None)
    if text is None:
        raise BadInput(f"{path}:{ring.sourceline}: a ring without <coordinates>; export it as KML or GML 2")
    return [corner.split(",") for corner in text.split()]


def _local(ring: Floats, origin: LocalTangent) -> Floats:
    return np.array([origin.enu(latitude, longitude, origin.altitude)[:2] for longitude, latitude in np.radians(ring).tolist()])
