import json

import numpy as np
import pytest

from uvf.maths.geodesy import LocalTangent
from uvf.models.importing.areas import read_areas
from uvf.models.yaml_data import BadInput

RING = [[14.79, 40.77, 0.0], [14.80, 40.77, 0.0], [14.80, 40.78, 0.0], [14.79, 40.77, 0.0]]
HOLE = [[14.796, 40.771], [14.798, 40.771], [14.798, 40.773]]
KML = """<?xml version="1.0"?><kml xmlns="http://www.opengis.net/kml/2.2"><Document><Placemark><name>a</name><Polygon>
<outerBoundaryIs><LinearRing><coordinates>14.79,40.77,0 14.80,40.77,0
 14.80,40.78,0 14.79,40.77,0</coordinates></LinearRing></outerBoundaryIs>
<innerBoundaryIs><LinearRing><coordinates>14.796,40.771 14.798,40.771 14.798,40.773</coordinates></LinearRing></innerBoundaryIs>
</Polygon></Placemark></Document></kml>"""


def written(folder, name, text):
    path = folder / name
    path.write_text(text if isinstance(text, str) else json.dumps(text))
    return path


def polygon(*rings):
    return {"type": "Polygon", "coordinates": list(rings)}


@pytest.mark.parametrize(
    "document",
    [
        polygon(RING, HOLE),
        {"type": "Feature", "properties": None, "geometry": polygon(RING, HOLE)},
        {
            "type": "FeatureCollection",
            "features": [
                {"type": "Feature", "geometry": {"type": "Point", "coordinates": [1, 2]}},
                {"type": "Feature", "geometry": polygon(RING, HOLE)},
            ],
        },
        {"type": "GeometryCollection", "geometries": [{"type": "MultiPolygon", "coordinates": [[RING, HOLE]]}]},
    ],
)
def test_a_polygon_is_found_wherever_it_stands_in_geojson(tmp_path, document):
    (area,) = read_areas(written(tmp_path, "field.geojson", document))
    assert area.in_degrees and area.name == "field"
    assert area.outline.tolist() == [corner[:2] for corner in RING]
    assert [hole.tolist() for hole in area.holes] == [HOLE]


def test_kml_and_geojson_say_the_same(tmp_path):
    (one,) = read_areas(written(tmp_path, "field.kml", KML))
    (other,) = read_areas(written(tmp_path, "field.json", polygon(RING, HOLE)))
    assert (one.outline == other.outline).all() and (one.holes[0] == other.holes[0]).all()


def test_degrees_become_metres_about_an_origin(tmp_path):
    (area,) = read_areas(written(tmp_path, "field.json", polygon(RING)))
    outline, _ = area.rings_about(LocalTangent.from_degrees(40.77, 14.79, 0.0))
    assert outline[0] == pytest.approx((0.0, 0.0), abs=1e-6)
    assert outline[1] == pytest.approx((844.3, 0.05), abs=0.2)  # 111.32 km * cos(40.77 deg) a degree
    assert outline[2][1] == pytest.approx(1110.6, abs=0.5)


def test_what_reaches_over_more_than_a_degree_is_metres(tmp_path):
    (area,) = read_areas(written(tmp_path, "ring.json", polygon([[0, 0], [10, 0], [10, 10], [0, 10]])))
    assert not area.in_degrees
    assert area.rings_about(LocalTangent.from_degrees(0, 0, 0))[0] is area.outline


def test_yaml_is_metres(tmp_path):
    (area,) = read_areas(written(tmp_path, "field.yaml", "outline: [[0, 0], [0.5, 0], [0.5, 0.5]]\nholes: [[[1, 2], [3, 4], [5, 6]]]\n"))
    assert not area.in_degrees
    assert area.holes[0].shape == (3, 2)


@pytest.mark.parametrize(
    ("name", "text", "why"),
    [
        ("a.txt", "", "name one of these"),
        ("a.json", "{", "not valid JSON"),
        ("a.json", "[" * 100_000, "not valid JSON"),
        ("a.json", {"type": "LineString", "coordinates": [[0, 0], [1, 1]]}, "no polygon"),
        ("a.json", "[1, 2]", "no polygon"),
        ("a.json", polygon([["x", 1], [2, 3], [4, 5]]), "pairs of numbers"),
        ("a.json", polygon([[1], [2, 3], [4, 5]]), "pairs of numbers"),
        ("a.json", polygon([]), "without corners"),
        ("a.json", polygon(), "without corners"),
        ("a.json", polygon([None, None, None]), "pairs of numbers"),
        ("a.kml", "<kml><Polygon>", "not valid XML"),
        ("a.kml", "<kml><Placemark/></kml>", "no polygon"),
        ("a.kml", "<kml><Polygon><outerBoundaryIs><LinearRing/></outerBoundaryIs></Polygon></kml>", "without <coordinates>"),
        ("a.yaml", "outline: [[0, 0, 0], [1, 1, 1]]", "outline"),
        ("a.yaml", "holes: []", "outline"),
    ],
)
def test_what_holds_no_polygon_is_refused_in_one_line(tmp_path, name, text, why):
    with pytest.raises(BadInput, match=why) as error:
        read_areas(written(tmp_path, name, text))
    assert name in str(error.value)


def test_a_file_that_is_not_there_is_named(tmp_path):
    with pytest.raises(BadInput, match=r"gone\.json"):
        read_areas(tmp_path / "gone.json")


def test_rings_are_arrays_of_two_columns(tmp_path):
    (area,) = read_areas(written(tmp_path, "field.json", polygon(RING)))
    assert area.outline.dtype == np.float64 and area.outline.shape == (4, 2)
