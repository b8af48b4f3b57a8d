"""Maps of map_server as worlds: each occupied cell is under a wall, where the yaml puts it, and no other is."""

import numpy as np
import pytest
from PIL import Image

from uvf.models.importing.map_image import greedy_rectangles
from uvf.models.importing.worlds import Options, import_world
from uvf.models.world.file import load_world
from uvf.models.world.footing import Footing
from uvf.models.yaml_data import BadInput

CELLS = np.zeros((12, 20), dtype=bool)  # row 0 at the bottom
CELLS[0] = CELLS[-1] = CELLS[:, 0] = CELLS[:, -1] = True
CELLS[3:6, 8] = CELLS[7, 3:15] = True


def taken(tmp_path, yaml, pixels, name="m.pgm"):
    Image.fromarray(np.flipud(pixels).astype(np.uint8)).save(tmp_path / name)
    (tmp_path / "m.yaml").write_text(f"image: {name}\nresolution: 0.5\n{yaml}\n")
    _, lines = import_world(tmp_path / "m.yaml", tmp_path / "worlds" / "m", Options())
    return load_world(tmp_path / "worlds", "m"), "\n".join(lines)


def occupied(world, x, y, yaw):
    """The cells, asked one by one at their centres."""
    c, s = np.cos(yaw), np.sin(yaw)
    rows, columns = CELLS.shape
    points = [((j + 0.5) * 0.5, (i + 0.5) * 0.5) for i in range(rows) for j in range(columns)]
    footing = Footing(world)
    found = [footing.room(x + c * dx - s * dy, y + s * dx + c * dy, (0.5, 0.6)) == 0 for dx, dy in points]
    return np.array(found).reshape(CELLS.shape)


@pytest.mark.parametrize("yaw", [0.0, 0.6])
@pytest.mark.parametrize("negate", [0, 1, "true"])
def test_walls_stand_on_the_occupied_cells(tmp_path, yaw, negate):
    pixels = np.where(bool(negate) != CELLS, 0, 254)
    head = f"origin: [-3.0, 2.0, {yaw}]\nnegate: {negate}\noccupied_thresh: 0.65\nfree_thresh: 0.196"
    world, notes = taken(tmp_path, head, pixels)
    assert (occupied(world, -3.0, 2.0, yaw) == CELLS).all()
    assert f"{CELLS.sum()} occupied cells of 0.5 m became {len(world.boxes)} boxes" in notes
    assert len(world.boxes) <= 6


def test_unknown_cells_are_floor_and_are_told(tmp_path):
    pixels = np.where(CELLS, 0, 254)
    pixels[8:11, 2:6] = 205
    world, notes = taken(tmp_path, "origin: [0, 0, 0]", pixels, "m.png")
    assert Footing(world).room(2.0, 4.75, (0.5, 0.6)) > 0
    assert "does not know are floor here: 12" in notes


def test_the_pixels_of_a_raw_map_are_the_values_of_its_cells(tmp_path):
    pixels = np.where(CELLS, 100, 0)
    pixels[8:11, 2:6] = 255
    world, notes = taken(tmp_path, "origin: [0, 0, 0]\nmode: raw", pixels)
    assert (occupied(world, 0.0, 0.0, 0.0) == CELLS).all()
    assert "does not know are floor here: 12" in notes


@pytest.mark.parametrize("seed", range(5))
def test_rectangles_cover_each_cell_once(seed):
    cells = np.random.default_rng(seed).random((30, 40)) < 0.6
    count = np.zeros(cells.shape, dtype=int)
    rectangles = greedy_rectangles(cells)
    for row, column, rows, columns in rectangles:
        count[row : row + rows, column : column + columns] += 1
    assert (count == cells).all()
    assert len(rectangles) < cells.sum() / 2


@pytest.mark.parametrize(
    ("yaml", "part"),
    [
        ("origin: [0, 0, 0]\nresolutoin: 1", "did you mean 'resolution'"),
        ("origin: [0, 0, 0]\nmode: tri", "no 'tri' here; did you mean 'trinary'"),
        ("origin: [0]", "write x, y"),
        ("origin: [0, 0, 0]", "cannot be read as a pic"),
    ],
)
def test_wrong_maps_are_refused(tmp_path, yaml, part):
    (tmp_path / "m.pgm").write_bytes(b"P5 no picture")
    (tmp_path / "m.yaml").write_text(f"image: m.pgm\nresolution: 0.5\n{yaml}\n")
    with pytest.raises(BadInput, match=part):
        import_world(tmp_path / "m.yaml", tmp_path / "worlds" / "m", Options())


def test_a_picture_that_is_taken_for_another_is_told(tmp_path):
    _, notes = taken(tmp_path, "origin: [0, 0, 0]", np.where(CELLS, 0, 254))
    assert "beside it is taken" not in notes
    (tmp_path / "m.yaml").write_text("image: depot.pgm\nresolution: 0.5\norigin: [0, 0, 0]\n")
    _, lines = import_world(tmp_path / "m.yaml", tmp_path / "worlds" / "again", Options())
    assert "note: there is no depot.pgm, which the map names; m.pgm beside it is taken" in lines


def test_a_map_without_anything_is_refused_and_leaves_nothing_behind(tmp_path):
    with pytest.raises(BadInput, match=r"m\.yaml: no cell is occupied, so there is nothing to take over"):
        taken(tmp_path, "origin: [0, 0, 0]", np.full((5, 5), 254))
    assert not (tmp_path / "worlds" / "m").exists()
