"""Patches of a colour: found in any light, told apart, and known to be cut off."""

import math

import numpy as np
import pytest

from uvf.vision import ColourRange, colour_blobs

MAGENTA = ColourRange(5.24, 0.35, 0.4, 0.2)
RED = ColourRange(0.0, 0.3, 0.4, 0.2)


def picture(*patches, ground=(90, 110, 80)):
    """patches: (row, column, height, width, colour)."""
    made = np.full((60, 80, 3), ground, dtype=np.uint8)
    for row, column, height, width, colour in patches:
        made[row : row + height, column : column + width] = colour
    return made


@pytest.mark.parametrize("light", [1.0, 0.6, 0.3])
def test_a_patch_is_found_in_bright_and_in_dim_light(light):
    colour = tuple(int(light * c) for c in (255, 0, 217))
    (found,) = colour_blobs(picture((10, 20, 8, 4, colour)), MAGENTA, 6)
    assert (found.column, found.row) == (21.5, 13.5)
    assert (found.width, found.height, found.pixels, found.is_cut) == (4, 8, 32, False)


@pytest.mark.parametrize("colour", [(255, 0, 0), (0, 0, 255), (160, 130, 155), (20, 0, 17), (128, 128, 128)])
def test_other_colours_pale_and_black_ones_are_left_out(colour):
    assert colour_blobs(picture((10, 20, 8, 4, colour)), MAGENTA, 6) == []


@pytest.mark.parametrize("colour", [(255, 10, 0), (255, 0, 10)])
def test_red_is_found_on_both_sides_of_where_hues_begin(colour):
    assert len(colour_blobs(picture((10, 20, 8, 4, colour)), RED, 6)) == 1
    assert len(colour_blobs(picture((10, 20, 8, 4, colour)), ColourRange(math.tau, 0.3, 0.4, 0.2), 6)) == 1


def test_two_are_told_apart_and_a_small_one_is_left_out():
    magenta = (255, 0, 217)
    found = colour_blobs(picture((10, 20, 8, 4, magenta), (30, 50, 6, 6, magenta), (50, 5, 2, 2, magenta)), MAGENTA, 6)
    assert [blob.pixels for blob in found] == [36, 32]


@pytest.mark.parametrize(("row", "column"), [(0, 20), (52, 20), (10, 0), (10, 76)])
def test_one_at_the_rim_is_cut(row, column):
    (found,) = colour_blobs(picture((row, column, 8, 4, (255, 0, 217))), MAGENTA, 6)
    assert found.is_cut


def test_a_picture_all_of_that_colour_is_one_patch_that_is_cut():
    (found,) = colour_blobs(picture(ground=(255, 0, 217)), MAGENTA, 6)
    assert found.pixels == 60 * 80 and found.is_cut


def test_of_very_many_the_largest_are_taken():
    spots = [(row, column, 2, 2, (255, 0, 217)) for row in range(2, 56, 4) for column in range(2, 76, 4)]
    found = colour_blobs(picture(*spots, (30, 40, 3, 3, (255, 0, 217))), MAGENTA, 4, most=20)
    assert len(found) == 20 and found[0].pixels > 4
