"""Tiles that maps share, within the memory that they may take."""

import numpy as np

from uvf.slam.maps.shared_kernels import slot_at
from uvf.slam.maps.tile_pool import EMPTY, TileKind, TilePool

PLACES = np.array([(r, c) for r in range(4) for c in range(4)])


def filled(most_tiles):
    """Two maps, of which the first has 16 tiles and the second the same."""
    kind = TileKind(16, 1, np.int16)
    pool = TilePool(2, kind, 0.05, most_tiles * (kind.size + 8))
    pool.writable(0, PLACES)
    pool.take(np.array((0, 0)))
    return pool


def test_where_memory_is_full_all_maps_lose_the_places_that_none_has_drawn_into_for_longest():
    pool = filled(24)
    pool.writable(1, PLACES[:4])
    pool.writable(0, PLACES[4:8] + 100)
    assert (pool.tiles, pool.forgotten) == (24, 0)
    pool.writable(0, PLACES[8:10] + 100)
    assert pool.tiles <= 24
    assert 0 < pool.forgotten <= 12
    for k in (0, 1):
        assert all(slot_at(r, c, pool.grid(k)) != EMPTY for r, c in PLACES[:4].tolist())
        assert any(slot_at(r, c, pool.grid(k)) == EMPTY for r, c in PLACES[4:].tolist())
    assert all(slot_at(r, c, pool.grid(0)) != EMPTY for r, c in (PLACES[4:10] + 100).tolist())


def test_what_does_not_fit_at_all_has_no_tile_and_harms_none():
    pool = filled(20)
    slots = pool.writable(1, PLACES + 50)
    more = pool.writable(0, np.array([(r, c) for r in range(6) for c in range(6)]) - 90)
    assert (slots != EMPTY).sum() == 16
    assert (more != EMPTY).sum() == 20
    assert len(set(more[more != EMPTY].tolist())) == pool.tiles == 20


def test_tiles_are_found_however_far_they_lie_apart():
    pool, far = filled(200), np.array([(10**k, -(7**k)) for k in range(6)]) * 3
    assert (pool.writable(0, far) == [slot_at(r, c, pool.grid(0)) for r, c in far.tolist()]).all()
    assert slot_at(5, 5, pool.grid(0)) == EMPTY
