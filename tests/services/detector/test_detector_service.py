"""The service step by step, on messages: pictures of a post, and pictures that are none."""

import io
import math

import numpy as np
import pytest
from PIL import Image

from launch import catalogue
from schemas.messages import CameraCalibration, CompressedImage, Detection, Detections
from services.detector.build import build
from services.detector.detector_service import DetectorParams, DetectorService
from tests.runtime.stepping import recall, stepped
from tests.services.slam.octree.test_octree_service import frame
from uvf.maths.rotations import from_euler
from uvf.models.scenario import ROOT, load_scenario
from uvf.models.yaml_data import BadInput
from uvf.runtime.messages.convert import stamp, vector
from uvf.runtime.messages.frames import FrameBuffer

WIDTH, HEIGHT, FOCAL = 320, 240, 234.0
INFO = CameraCalibration(frame_id="v/camera_optical", width=WIDTH, height=HEIGHT, K=[FOCAL, 0, 159.5, 0, FOCAL, 119.5, 0, 0, 1])
UP = 20.0  # m
POST = (12.0, -3.0)
TIMES = [0.0, 0.2, 0.4, 0.6, 0.8, 1.0]
DOWN = from_euler(math.pi, 0.0, -math.pi / 2)
"""Optical frame of a camera that looks down, flying east: its x (right) to the south, its y to the west."""
MISSION = """about: A flight.
world: depot
duration: 10
vehicles:
  eye: {model: MODEL, system_id: 1, start: {x: 0.0, y: 0.0, z: 21.0, speed: 25.0}, params: PARAMS}
"""


def place(t):
    return (10.0 * t + 4.0, 0.0, UP)


def flight():
    frames = FrameBuffer()
    for t in TIMES:
        frames.add(frame(t, "world", "v/camera_optical", place(t), DOWN))
    return frames


def jpeg(pixels):
    stream = io.BytesIO()
    Image.fromarray(pixels).save(stream, format="JPEG", quality=90)
    return stream.getvalue()


def photo(t, posts=(POST,), shape=(HEIGHT, WIDTH)):
    """What the camera sees of posts whose middles are 0.5 m up: squares of 8 pixels."""
    pixels = np.full((*shape, 3), (90, 110, 80), dtype=np.uint8)
    x, y, z = place(t)
    for east, north in posts:
        column = round(159.5 + FOCAL * (y - north) / (z - 0.5))
        row = round(119.5 - FOCAL * (east - x) / (z - 0.5))
        if 4 <= column < WIDTH - 4 and 4 <= row < HEIGHT - 4:
            pixels[row - 4 : row + 4, column - 4 : column + 4] = (255, 0, 217)
    return CompressedImage(timestamp=stamp(t), frame_id="v/camera_optical", data=jpeg(pixels), format="jpeg")


@pytest.fixture
def service():
    return DetectorService(DetectorParams())


def flown(service, posts=(POST,)):
    return [stepped(service, t, image=[photo(t, posts)], info=INFO, frames=flight()) for t in TIMES]


def test_a_post_is_found_from_three_places_and_told_of_once(service):
    said = flown(service)
    told = [out["detections"] for out in said if out["detections"] is not None]
    (found,) = told[-1].detections
    assert (found.position.x, found.position.y) == pytest.approx(POST, abs=0.2)
    assert found.views >= 3 and 0.0 < found.sigma < 0.5
    events = [event.text for out in said for event in out["events"] or ()]
    assert events == ["marker 1 found at (12.0, -3.0)"]


def test_two_posts_keep_their_numbers(service):
    told = [out["detections"] for out in flown(service, (POST, (9.0, 4.0))) if out["detections"] is not None]
    assert {d.id for d in told[-1].detections} == {1, 2}
    assert sorted((round(d.position.x), round(d.position.y)) for d in told[-1].detections) == [(9, 4), (12, -3)]


@pytest.mark.parametrize(
    ("message", "why"),
    [
        (CompressedImage(timestamp=stamp(0.4), frame_id="v/camera_optical", data=b"no picture"), "cannot be read"),
        (CompressedImage(timestamp=stamp(0.4), frame_id="v/camera_optical", data=jpeg(np.zeros((8, 8, 3), np.uint8))), "8 x 8"),
        (CompressedImage(timestamp=stamp(0.4), frame_id="v/camera_optical"), "cannot be read"),
    ],
)
def test_what_is_no_picture_of_this_camera_is_left_out_and_told_once(service, message, why):
    events = [e for t in (0.4, 0.6, 0.8) for e in stepped(service, t, image=[message], info=INFO, frames=flight())["events"]]
    (event,) = events
    assert event.text == "a picture is left out" and why in event.cause
    assert stepped(service, 1.0, image=[photo(0.6)], info=INFO, frames=flight())["detections"] in (None, [])


@pytest.mark.parametrize("k", [[], [0.0] * 9, [float("nan")] * 9])
def test_intrinsics_that_are_none_are_told_of(service, k):
    info = CameraCalibration(frame_id="v/camera_optical", width=WIDTH, height=HEIGHT, K=k)
    (event,) = stepped(service, 0.4, image=[photo(0.4)], info=info, frames=flight())["events"]
    assert "nine numbers" in event.cause


def test_pictures_wait_for_their_place_and_are_given_up_in_the_end(service):
    said = [stepped(service, t, image=[photo(t)], info=INFO, frames=FrameBuffer())["events"] for t in np.arange(0.0, 6.0, 0.2).tolist()]
    (event,) = [event for events in said for event in events]
    assert event.text == "pictures are left out: nobody knows where they were taken"
    late = DetectorService(DetectorParams())
    stepped(late, 0.4, image=[photo(0.2), photo(0.4)], info=INFO, frames=FrameBuffer())
    assert stepped(late, 0.6, image=[photo(0.6)], info=INFO, frames=flight())["detections"].detections[0].views == 3


def test_a_restarted_one_goes_on_with_what_was_found():
    service = DetectorService(DetectorParams())
    broken = Detection(id=9, position=vector(np.array((math.nan, 0.0, 0.0))), sigma=0.1, views=5)
    recall(
        service, detections=Detections(detections=[Detection(id=4, position=vector(np.array((*POST, 0.5))), sigma=0.2, views=5), broken])
    )
    said = stepped(service, 0.2, image=[photo(0.2)], info=INFO, frames=flight())
    assert [d.id for d in said["detections"].detections] == [4]
    assert said["events"] in (None, [])


def of(tmp_path, model, params):
    path = tmp_path / "one.yaml"
    path.write_text(MISSION.replace("MODEL", model).replace("PARAMS", params))
    return load_scenario(path, ROOT)


def test_who_asks_for_one_gets_one(tmp_path):
    site = of(tmp_path, "milvus_surveyor", "{detector: {}}")
    assert [host.vehicle for host in build(site)] == ["eye"]
    assert "detector" in [kind.name for kind in catalogue.needed(site)]


def test_without_a_camera_it_is_refused(tmp_path):
    with pytest.raises(BadInput, match="no camera to see with"):
        build(of(tmp_path, "stick25", "{detector: {}}"))
