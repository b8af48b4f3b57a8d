"""Depth pictures and sweeps as beams."""

import io
import zlib

import numpy as np
import pytest
from PIL import Image

from schemas.messages import CameraCalibration, CompressedImage, LaserScan
from services.slam.octree.beams import depth_beams, sweep_beams
from uvf.models.yaml_data import BadInput
from uvf.runtime.messages.convert import stamp

WIDTH, HEIGHT, FOCAL = 40, 30, 35.0
K = [FOCAL, 0.0, (WIDTH - 1) / 2, 0.0, FOCAL, (HEIGHT - 1) / 2, 0.0, 0.0, 1.0]
NOISE = np.random.default_rng(1).integers(0, 60000, (HEIGHT, WIDTH))
INFO = CameraCalibration(width=WIDTH, height=HEIGHT, K=K)


def png(millimetres, dtype=np.uint16):
    stream = io.BytesIO()
    Image.fromarray(np.asarray(millimetres).astype(dtype)).save(stream, format="PNG")
    return CompressedImage(timestamp=stamp(1.0), frame_id="v/camera_optical", data=stream.getvalue(), format="png")


def test_a_plane_comes_out_as_a_plane():
    normal, offset = np.array((0.2, -0.3, 1.0)), 3.0  # n . p = offset
    rows, columns = np.mgrid[:HEIGHT, :WIDTH]
    rays = np.stack(((columns - K[2]) / FOCAL, (rows - K[5]) / FOCAL, np.ones((HEIGHT, WIDTH))), axis=2)
    beams = depth_beams(png(np.round(1000 * offset / (rays @ normal))), INFO, 20.0)
    assert beams.ends.shape == (WIDTH * HEIGHT, 3)
    assert np.abs(beams.ends @ normal - offset).max() < 1e-3
    assert beams.ends[0, 0] < 0 < beams.ends[-1, 0] and beams.ends[0, 1] < 0 < beams.ends[-1, 1]


def test_pixels_without_depth_look_beyond_the_reach():
    depths = np.full((HEIGHT, WIDTH), 1000)
    depths[3, 4] = 0
    beams = depth_beams(png(depths), INFO, 5.0)
    beyond = np.linalg.norm(beams.ends, axis=1) > beams.reach
    assert np.flatnonzero(beyond).tolist() == [3 * WIDTH + 4]


def huge():
    """A picture whose header says that it is 60000 x 60000."""
    data = bytearray(png(np.ones((HEIGHT, WIDTH))).data)
    data[16:24] = (60000).to_bytes(4, "big") * 2
    data[29:33] = zlib.crc32(data[12:29]).to_bytes(4, "big")
    return CompressedImage(frame_id="v/camera_optical", data=bytes(data))


@pytest.mark.parametrize(
    ("picture", "info", "said"),
    [
        (png(np.ones((5, 6))), INFO, "a depth picture of 6 x 5, but its camera has 40 x 30"),
        (png(np.ones((HEIGHT, WIDTH)), np.uint8), INFO, "must be grey with 16 bits; this one is L"),
        (CompressedImage(frame_id="v/camera_optical", data=b"no picture"), INFO, "cannot be read as PNG"),
        (CompressedImage(frame_id="v/camera_optical", data=png(NOISE).data[:300]), INFO, "cannot be read as PNG"),
        (huge(), INFO, "cannot be read as PNG"),
        (png(np.ones((HEIGHT, WIDTH))), CameraCalibration(width=WIDTH, height=HEIGHT, K=[0.0] * 9), "focal lengths above zero"),
        (png(np.ones((HEIGHT, WIDTH))), CameraCalibration(width=WIDTH, height=HEIGHT), "K must hold nine numbers"),
    ],
)
def test_a_broken_picture_is_refused_in_one_line(picture, info, said):
    with pytest.raises(BadInput, match=said) as refused:
        depth_beams(picture, info, 5.0)
    assert "\n" not in str(refused.value)


def test_a_sweep_lies_in_the_lidars_plane_and_tells_what_has_not_come_back():
    ranges = [1.0, 0.0, float("nan"), float("inf"), 2.0, 30.0]
    beams = sweep_beams(LaserScan(start_angle=0.0, end_angle=np.pi / 2, ranges=ranges), 10.0)
    lengths = np.linalg.norm(beams.ends, axis=1)
    assert (lengths <= beams.reach).tolist() == [True, False, False, False, True, False]
    assert beams.ends[0] == pytest.approx((1.0, 0.0, 0.0))
    assert (beams.ends[:, 2] == 0.0).all() and beams.ends[5, 1] > 10.0
