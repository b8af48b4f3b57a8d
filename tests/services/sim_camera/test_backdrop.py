"""Ground and sky by rays: the colour at a pixel is that of the point the intrinsics say it shows."""

import msgspec
import numpy as np
import pytest

from services.sim_camera.backdrop import HAZE, SKY, Backdrop
from services.sim_camera.optics import intrinsics, project
from uvf.models.vehicle.sensors import Camera, Mount
from uvf.models.world.file import Field, Origin, WorldFile

CAMERA = Camera(mount=Mount(), hz=5.0, width=160, height=120, fov=1.2)
EAST_OPTICAL = np.column_stack(((0.0, -1.0, 0.0), (0.0, 0.0, -1.0), (1.0, 0.0, 0.0)))
EYE = np.array((0.0, 0.0, 10.0))
RED = (0.8, 0.0, 0.0)
WORLD = WorldFile(about="test", origin=Origin(0.0, 0.0), floor=(0.0, 0.0, 1.0, 1.0), ground_colour=(0.0, 0.6, 0.0))


def paint(eye=EYE, **parts):
    return Backdrop(msgspec.structs.replace(WORLD, **parts)).paint(CAMERA, eye, EAST_OPTICAL).astype(int)


@pytest.mark.parametrize(("x", "y"), [(25.0, 3.0), (40.0, -12.0), (55.0, 20.0)])
def test_a_field_shows_where_its_middle_projects(x, y):
    picture = paint(fields=[Field((x - 2, y - 2, x + 2, y + 2), RED)])
    column, row = project(intrinsics(CAMERA), EAST_OPTICAL.T @ (np.array((x, y, 0.0)) - EYE))
    seen = picture[round(row), round(column)]
    assert seen[0] > 2 * seen[1]


def test_a_patch_within_a_larger_one_is_seen_from_wherever_the_picture_begins():
    large, small = Field((10.0, -50.0, 100.0, 50.0), (0.0, 0.0, 0.8)), Field((38.0, -14.0, 42.0, -10.0), RED)
    column, row = project(intrinsics(CAMERA), EAST_OPTICAL.T @ (np.array((40.0, -12.0, 0.0)) - EYE))
    seen = paint(fields=[small, large])[round(row), round(column)]
    assert seen[0] > 2 * seen[2]
    hidden = paint(fields=[large, small])[round(row), round(column)]
    assert hidden[2] > 2 * hidden[0]


def test_the_horizon_is_in_the_middle_of_a_level_picture():
    picture = paint()
    assert (picture[:60] == SKY).all()
    assert (picture[65:, :, 1] > picture[65:, :, 2]).all()


def test_ground_fades_into_haze_by_distance():
    """At a distance of HAZE metres 37 % of the ground's own colour is left."""
    picture = paint(eye=np.array((0.0, 0.0, 500.0)))
    k = intrinsics(CAMERA)
    row = round(project(k, np.array((0.0, 500.0, np.sqrt(HAZE**2 - 500.0**2))))[1])
    wanted = np.exp(-1) * np.array((0.0, 153.0, 0.0)) + (1 - np.exp(-1)) * np.array(SKY)
    assert picture[row, 80] == pytest.approx(wanted, abs=6)


def test_tiles_pass_below_a_camera_that_moves():
    assert (paint() != paint(eye=EYE + np.array((10.0, 0.0, 0.0)))).any()


def test_below_the_ground_there_is_only_sky():
    assert (paint(eye=np.array((0.0, 0.0, -1.0))) == SKY).all()


def test_white_ground_has_no_dark_tiles():
    picture = paint(eye=np.array((0.0, 0.0, 1.0)), ground_colour=(1.0, 1.0, 1.0))
    assert picture[80:].min() > 200
