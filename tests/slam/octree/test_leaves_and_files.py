"""Pruned leaves, OctoMap's files, and files that are none."""

from contextlib import suppress

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from tests.slam.octree.scenes import room_scan
from uvf.models.yaml_data import BadInput
from uvf.slam.octree.files import read_octree, to_bt, to_ot
from uvf.slam.octree.layout import HIGHEST, LOWEST
from uvf.slam.octree.leaves import (
    CENTRE,
    DEPTH,
    Leaves,
    TooLarge,
    bounds,
    boxes,
    coarser,
    leaves_of,
    likeliest,
    morton,
    octree_of,
    pruned,
    unmorton,
)
from uvf.slam.octree.octree import Octree

SURENESS = (np.nan, LOWEST, -0.4, 0.85, HIGHEST)


def cells_of(values, corner):
    """Leaves of single cells: a cube of values (n, n, n) at a corner (3,) [cells from the origin]; NaN is unknown."""
    places = np.argwhere(~np.isnan(values))
    codes = morton(places + corner + CENTRE)
    order = np.argsort(codes)
    known = values[tuple(places.T)].astype(np.float32)
    return Leaves(codes[order], np.full(len(codes), DEPTH, dtype=np.uint8), known[order])


def same(a, b):
    return all(x.shape == y.shape and (x == y).all() for x, y in zip(a, b, strict=True))


cubes = arrays(np.float64, st.tuples(*[st.integers(1, 9)] * 3), elements=st.sampled_from(SURENESS), fill=st.sampled_from(SURENESS))
corners = st.tuples(*[st.sampled_from((-8, -3, 0, 5, 8))] * 3)


@settings(deadline=None, max_examples=60)
@given(cubes, corners)
def test_pruned_or_not_the_cells_say_the_same(values, corner):
    leaves = pruned(cells_of(values, corner))
    octree = octree_of(leaves, 0.5)
    every_cell = (np.argwhere(np.ones(values.shape)) + corner + 0.5) * 0.5
    assert np.array_equal(octree.log_odds(every_cell), values.ravel().astype(np.float32), equal_nan=True)
    assert same(leaves_of(octree), leaves)


@settings(deadline=None, max_examples=60)
@given(cubes, corners)
def test_files_bring_back_what_was_written(values, corner):
    leaves = pruned(cells_of(values, corner))
    assert same(leaves_of(read_octree(to_ot(leaves, 0.25), "full")), leaves)
    assert same(leaves_of(read_octree(to_bt(leaves, 0.25), "binary")), likeliest(leaves, LOWEST, HIGHEST))


@settings(deadline=None, max_examples=40)
@given(cubes, corners, st.integers(12, 16))
def test_a_coarser_map_holds_the_most_occupied_of_each_cube(values, corner, depth):
    seen = coarser(pruned(cells_of(values, corner)), depth)
    side = 1 << (DEPTH - depth)
    octree = octree_of(seen, 1.0)
    places = np.argwhere(~np.isnan(values)) + corner
    for cube in {tuple(p) for p in (places // side).tolist()}:
        inside = (places // side == cube).all(axis=1)
        most = values[tuple((places[inside] - corner).T)].max()
        assert octree.log_odds(np.array([cube]) * side + 0.5) == np.float32(most)


@given(arrays(np.int64, (20, 3), elements=st.integers(0, 2**16 - 1)))
def test_morton_numbers_lead_back_and_keep_cubes_together(places):
    codes = morton(places)
    assert (unmorton(codes) == places).all()
    assert (morton(places >> 1) == codes >> 3).all()


def test_a_file_whose_lines_end_as_on_windows_is_read():
    header, _, body = GOOD.partition(b"data\n")
    assert read_octree(header.replace(b"\n", b"\r\n") + b"data\r\n" + body, "map.bt").states(np.zeros((1, 3))) == 0


def test_a_full_cube_is_one_leaf():
    leaves = pruned(cells_of(np.full((32, 32, 32), LOWEST), (0, -32, 64)))
    assert leaves.depths.tolist() == [11]
    middles, sides = boxes(leaves, 0.1)
    assert middles[0] == pytest.approx((1.6, -1.6, 8.0)) and sides[0] == pytest.approx(3.2)
    low, high = bounds(leaves, 0.1)
    assert low == pytest.approx((0, -3.2, 6.4)) and high == pytest.approx((3.2, 0, 9.6))


def test_an_empty_map_is_a_file_too():
    leaves = leaves_of(Octree(0.1))
    assert bounds(leaves, 0.1) is None
    for write in (to_bt, to_ot):
        assert read_octree(write(leaves, 0.1), "empty").is_empty


def test_a_map_that_was_read_goes_on():
    rng = np.random.default_rng(1)
    octree = Octree(0.1)
    octree.insert(*room_scan(rng))
    again = read_octree(to_ot(leaves_of(octree), 0.1), "map")
    scan = room_scan(rng)
    for each in (octree, again):
        each.insert(*scan)
    assert same(leaves_of(octree), leaves_of(again))


def test_what_reaches_too_far_for_octomap_is_said():
    octree = Octree(0.1)
    octree.insert(np.array((4000.0, 0.0, 0.0)), np.array(((4001.0, 0.0, 0.0),)))
    with pytest.raises(TooLarge, match=r"the map reaches more than 3276\.8 m from its origin"):
        leaves_of(octree)


GOOD = to_bt(pruned(cells_of(np.full((3, 3, 3), LOWEST), (0, 0, 0))), 0.1)
FULL = to_ot(pruned(cells_of(np.full((3, 3, 3), LOWEST), (0, 0, 0))), 0.1)


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (b"", "no OctoMap file"),
        (b"\x89PNG\r\n", "no OctoMap file"),
        (GOOD[:60], "the header has no line 'data'"),
        (b"# Octomap OcTree file\n" + b"\n" * 300_000, "the header has no line 'data'"),
        (GOOD[:-5], "the data are cut short"),
        (FULL[:-3], "the data are cut short"),
        (GOOD.replace(b"size ", b"size 1"), "the data are"),
        (GOOD.replace(b"id OcTree", b"id ColorOcTree"), "a tree of kind 'ColorOcTree'; only 'OcTree' is read"),
        (GOOD.replace(b"res 0.1", b"res -1"), "must be above zero"),
        (GOOD.replace(b"res 0.1", b"res nan"), "must be above zero"),
        (GOOD.replace(b"res 0.1", b"res big"), "no 'res' and 'size' as numbers"),
        (GOOD + b"\xff\xff" * 20, None),
        (FULL.replace(np.float32(LOWEST).tobytes(), np.float32(np.nan).tobytes()), "not finite"),
        (b"# Octomap OcTree file\nid OcTree\nsize 1\nres 0.1\ndata\n\0\0\0\0\0", "are known throughout"),
    ],
)
def test_a_file_that_is_none_is_refused_in_one_line(data, said):
    if said is None:
        assert not read_octree(data, "map.bt").is_empty  # what comes after the tree is nobody's business
        return
    with pytest.raises(BadInput, match=said) as refused:
        read_octree(data, "map.bt")
    assert str(refused.value).startswith("map.bt: ") and "\n" not in str(refused.value)


@settings(deadline=None, max_examples=150)
@given(st.binary(max_size=80), st.booleans(), st.integers(0, 60))
def test_any_bytes_are_a_tree_or_refused(body, is_full, size):
    first = b"# Octomap OcTree file" if is_full else b"# Octomap OcTree binary file"
    data = first + b"\nid OcTree\nsize %d\nres 0.1\ndata\n" % size + body
    with suppress(BadInput):
        read_octree(data, "map.bt")
