"""Maps that share tiles until they differ."""

from dataclasses import replace

import numpy as np

from tests.services.slam.drives import drive
from uvf.maths.se2 import IDENTITY, Pose2
from uvf.slam.maps.shared_kernels import slot_of
from uvf.slam.maps.shared_tiles import SharedEvidence, SharedTiles
from uvf.slam.maps.tile_kernels import TILE
from uvf.slam.reading import Beams

EVIDENCE = SharedEvidence(17, -8, -60, 70)
READING = drive(1)[0]
MEMORY = 20e6


def cells(tiles, k, reach=100):
    """(2 reach, 2 reach) log-odds about the origin of map k."""
    grid = tiles.grid(k)
    span = range(-reach, reach)
    return np.array([[grid[0][slot_of(r, c, grid), r % TILE, c % TILE, 0] for c in span] for r in span])


def two_maps():
    tiles = SharedTiles(2, np.int16, 0.05, MEMORY)
    tiles.draw(0, READING, IDENTITY, EVIDENCE)
    tiles.take(np.array((0, 0)))
    return tiles


def test_a_copy_is_the_same_map_and_takes_no_tile():
    tiles = SharedTiles(2, np.int16, 0.05, MEMORY)
    tiles.draw(0, READING, IDENTITY, EVIDENCE)
    before = tiles.tiles
    assert not cells(tiles, 1).any()
    tiles.take(np.array((0, 0)))
    assert tiles.tiles == before > 0
    assert cells(tiles, 0).max() == 17
    assert (cells(tiles, 0) == cells(tiles, 1)).all()


def test_what_is_drawn_into_one_map_does_not_show_in_the_other():
    tiles = two_maps()
    before = cells(tiles, 0)
    tiles.draw(1, READING, Pose2(0.3, 0.2, 0.4), EVIDENCE)
    assert (cells(tiles, 0) == before).all()
    assert (cells(tiles, 1) != before).any()
    tiles.draw(0, READING, Pose2(0.3, 0.2, 0.4), EVIDENCE)
    assert (cells(tiles, 0) == cells(tiles, 1)).all()


def test_only_tiles_that_are_touched_are_copied_and_the_dead_give_theirs_back():
    tiles = two_maps()
    tiles.draw(0, READING, Pose2(500.0, 0.0, 0.0), EVIDENCE)
    apart = tiles.tiles
    tiles.draw(1, READING, IDENTITY, EVIDENCE)
    assert tiles.tiles > apart
    tiles.take(np.array((1, 1)))
    assert tiles.tiles == two_maps().tiles


def test_a_map_grows_to_all_sides_without_losing_anything():
    tiles = two_maps()
    before = cells(tiles, 0)
    for far in (Pose2(-40.0, 0.0, 0.0), Pose2(0.0, -90.0, 0.0), Pose2(33.0, 70.0, 0.0)):
        assert tiles.draw(0, READING, far, EVIDENCE) is not None
    assert (cells(tiles, 0) == before).all()
    assert (cells(tiles, 1) == before).all()


def test_what_lies_nowhere_is_not_drawn():
    tiles = two_maps()
    for pose in (Pose2(float("nan"), 0.0, 0.0), Pose2(1e12, 0.0, 0.0), Pose2(0.0, 0.0, float("inf"))):
        assert tiles.draw(0, READING, pose, EVIDENCE) is None
    assert (cells(tiles, 0) == cells(tiles, 1)).all()


def test_beams_that_end_where_they_begin_draw_nothing():
    tiles, nothing = two_maps(), Beams((0.0, 0.0), READING.beams.bearings, 0.0, 1e-6)
    assert tiles.draw(0, replace(READING, beams=nothing), IDENTITY, EVIDENCE) is None
    assert (cells(tiles, 0) == cells(tiles, 1)).all()


def test_evidence_stays_within_its_bounds():
    tiles = SharedTiles(1, np.int8, 0.05, MEMORY)
    for _ in range(9):
        tiles.draw(0, READING, IDENTITY, EVIDENCE)
    assert (cells(tiles, 0).min(), cells(tiles, 0).max()) == (-60, 70)
