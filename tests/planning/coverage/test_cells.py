import numpy as np
import pytest
import shapely

from tests.planning.coverage.shapes import HOLE, SQUARE, comb
from uvf.planning.coverage.cells import decompose, visiting_order
from uvf.planning.coverage.field import make_field


def test_a_hole_makes_four_cells_that_surround_it():
    cells = decompose(make_field(SQUARE, [HOLE]).edges, 0.0)
    assert sorted(round(cell.area) for cell in cells) == sorted((300 * 60, 100 * 70, 140 * 70, 300 * 70))
    assert [sorted(cell.neighbours) for cell in cells] == [[1, 2], [0, 3], [0, 3], [1, 2]]
    assert visiting_order(cells) == [0, 1, 3, 2]


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("direction", [0.0, 0.7, 2.1])
def test_cells_cover_the_field_once(seed, direction):
    field = comb(np.random.default_rng(seed))
    cells = decompose(field.edges, direction)
    shapes = [shapely.Polygon(cell.outline(direction)).buffer(0.0) for cell in cells]
    assert sum(shape.area for shape in shapes) == pytest.approx(field.area)
    assert sum(cell.area for cell in cells) == pytest.approx(field.area)
    assert shapely.union_all(shapes).symmetric_difference(field.shape).area < 1e-6 * field.area
    assert sorted(visiting_order(cells)) == list(range(len(cells)))


def test_a_comb_has_a_cell_for_each_tooth_and_parts_are_apart():
    three = [[0, 0], [90, 0], [90, 50], [70, 50], [70, 20], [50, 20], [50, 50], [40, 50], [40, 20], [20, 20], [20, 50], [0, 50]]
    teeth = decompose(make_field(np.array(three)).edges, 0.0)
    assert len(teeth) == 4
    assert teeth[0].neighbours == {1, 2, 3}
    split = make_field(SQUARE, [np.array([[100, -1], [110, -1], [110, 201], [100, 201]])])
    assert [cell.neighbours for cell in decompose(split.edges, np.pi / 2)] == [set(), set()]
