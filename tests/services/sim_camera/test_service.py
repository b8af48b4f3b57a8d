"""The service: with a renderer of ten lines, and in lockstep with the real one in the demo's world."""

import io
from dataclasses import replace
from pathlib import Path

import msgspec
import numpy as np
import pytest
from PIL import Image

from schemas import topics
from schemas.messages import CameraCalibration, CompressedImage, NavState
from services.sim_camera.build import build
from services.sim_camera.fitted import FittedCamera
from services.sim_camera.renderer import Shot
from services.sim_camera.service import SimCamera
from tests.runtime.stepping import stepped
from uvf.models.scenario import ROOT, load_scenario
from uvf.models.vehicle.file import load_vehicle
from uvf.models.vehicle.sensors import Camera, Mount
from uvf.models.yaml_data import BadInput
from uvf.runtime.contract.declaration import Writes, topic
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.contract.service import Service
from uvf.runtime.messages.convert import seconds, stamp, vector
from uvf.runtime.time.lockstep import Lockstep

NOTHING_TOLD = {"joints": {}, "objects": None, "aircraft": None, "gimbals": {}}

CAMERA = Camera(mount=Mount(), hz=5.0, width=32, height=24, fov=1.2)
SLOW = msgspec.structs.replace(CAMERA, hz=2.5)


class GreyRenderer:
    """Everything is grey; keeps where the vehicles were put."""

    def __init__(self):
        self.placed = {}

    def place(self, t, poses):
        self.placed.update(poses)

    def turn(self, positions):
        self.turned = positions

    def show(self, guests):
        self.guests = guests

    def take(self, camera, body):
        picture = np.full((camera.height, camera.width, 3), 128, dtype=np.uint8)
        return Shot(picture, np.full((camera.height, camera.width), 2.0) if camera.depth else None)

    def close(self):
        self.placed.clear()


def service(renderer=None, **cameras):
    fitted = [FittedCamera(name, camera, np.random.default_rng(1)) for name, camera in cameras.items()]
    return SimCamera(renderer or GreyRenderer(), fitted, lambda model: Path())


def at(x, t=0.18):
    return NavState(timestamp=stamp(t), position=vector(np.array((x, 0.0, 0.0))))


def test_a_picture_is_a_jpeg_with_the_stamp_of_its_pose():
    image = stepped(service(v=CAMERA), 0.2, truth={"v": at(1.0)}, **NOTHING_TOLD)["image"]["v"]
    decoded = Image.open(io.BytesIO(image.data))
    assert (decoded.format, decoded.size, image.format) == ("JPEG", (32, 24), "jpeg")
    assert abs(np.asarray(decoded).astype(int) - 128).max() <= 2
    assert seconds(image.timestamp) == pytest.approx(0.18)
    assert image.frame_id == "v/camera_optical"


def test_without_a_pose_there_is_no_picture_of_this_vehicle():
    images = stepped(service(seen=CAMERA, lost=CAMERA), 0.2, truth={"seen": at(1.0)}, **NOTHING_TOLD)["image"]
    assert set(images) == {"seen"}


def test_vehicles_without_a_camera_are_placed_too():
    renderer = GreyRenderer()
    stepped(service(renderer, v=CAMERA), 0.2, truth={"v": at(1.0), "blind": at(7.0)}, **NOTHING_TOLD)
    assert renderer.placed["blind"].position[0] == 7.0


def test_a_slower_camera_takes_every_second_turn():
    sim = service(v=SLOW)
    taken = [len(stepped(sim, n / 5, truth={"v": at(1.0)}, **NOTHING_TOLD)["image"]) for n in range(1, 7)]
    assert taken == [0, 1, 0, 1, 0, 1]


def test_intrinsics_are_told_once():
    sim = service(v=CAMERA)
    first, second = (stepped(sim, t, truth={}, **NOTHING_TOLD)["info"] for t in (0.2, 0.4))
    assert list(first["v"].K) == pytest.approx([16 / np.tan(0.6), 0, 15.5, 0, 16 / np.tan(0.6), 11.5, 0, 0, 1])
    assert second == {}


DEEP = msgspec.structs.replace(CAMERA, depth=True)


def depths(image):
    """(height, width) mm."""
    decoded = Image.open(io.BytesIO(image.data))
    assert (decoded.format, image.format) == ("PNG", "png")
    return np.asarray(decoded).astype(int)


def test_a_depth_picture_is_a_png_of_millimetres_beside_the_image():
    sent = stepped(service(v=DEEP), 0.2, truth={"v": at(1.0)}, **NOTHING_TOLD)
    assert sent["depth"]["v"].timestamp == sent["image"]["v"].timestamp
    assert sent["depth"]["v"].frame_id == "v/camera_optical"
    assert (depths(sent["depth"]["v"]) == 2000).all()


def test_only_a_depth_camera_sends_depth():
    assert stepped(service(v=CAMERA), 0.2, truth={"v": at(1.0)}, **NOTHING_TOLD)["depth"] == {}


def test_depth_noise_grows_with_the_square_of_the_depth():
    noisy = msgspec.structs.replace(DEEP, width=160, height=120, depth_noise=0.003)
    read = depths(stepped(service(v=noisy), 0.2, truth={"v": at(1.0)}, **NOTHING_TOLD)["depth"]["v"])
    assert read.mean() == pytest.approx(2000, abs=1)
    assert read.std() == pytest.approx(3 * 2.0**2, rel=0.05)


def test_what_is_out_of_reach_is_zero():
    near = msgspec.structs.replace(DEEP, far=1.5)
    assert (depths(stepped(service(v=near), 0.2, truth={"v": at(1.0)}, **NOTHING_TOLD)["depth"]["v"]) == 0).all()


def test_a_late_picture_keeps_the_stamp_of_its_pose():
    late = service(v=msgspec.structs.replace(CAMERA, latency=0.3))
    stamps = [
        [seconds(m.timestamp) for m in stepped(late, n / 5, truth={"v": at(1.0, n / 5 - 0.02)}, **NOTHING_TOLD)["image"].values()]
        for n in range(1, 5)
    ]
    assert stamps == [[], [], [pytest.approx(0.18)], [pytest.approx(0.38)]]


class Walker(Service):
    """Truth of a vehicle that walks along the living room."""

    name = "walker"
    hz = 50.0

    class Outputs(Writes):
        truth: NavState | None = topic(topics.TRUTH)

    def step(self, t: float, now) -> Outputs:
        state = NavState(timestamp=stamp(t), position=vector(np.array((2.2 + 0.2 * t, 1.3, 0.0))))
        return self.Outputs(truth=state)


def film(until):
    """(images, infos) of the burger's camera in the demo's world, drawn for real."""
    lockstep = Lockstep([*build(load_scenario(ROOT / "missions/demo.yaml")), ServiceInstance(Walker, Walker, "burger")])
    images, infos = [], []
    lockstep.bus.subscribe(topics.IMAGE.at("burger"), topics.IMAGE.qos, lambda s: images.append(CompressedImage.FromString(s.payload)))
    lockstep.bus.subscribe(
        topics.CAMERA_INFO.at("*"), topics.CAMERA_INFO.qos, lambda s: infos.append(CameraCalibration.FromString(s.payload))
    )
    lockstep.run(until)
    lockstep.close()
    return images, infos


def test_a_walk_through_the_house_is_filmed_the_same_twice():
    first, infos = film(1.0)
    second, _ = film(1.0)
    assert len(first) == 5
    assert {info.frame_id for info in infos} == {"burger/camera_optical", "milvus/camera_optical"}
    assert len({image.data for image in first}) == 5
    assert [image.data for image in first] == [image.data for image in second]


def spoilt(vehicle, **parts):
    """The demo with other data in a vehicle's file."""
    site = load_scenario(ROOT / "missions/demo.yaml")
    member = site.members[vehicle]
    site.members[vehicle] = replace(member, file=msgspec.structs.replace(member.file, **parts))
    return site


def test_a_camera_faster_than_its_simulator_is_refused():
    sensors = load_vehicle(ROOT / "vehicles", "burger").sensors
    odd = msgspec.structs.replace(sensors, camera=msgspec.structs.replace(CAMERA, hz=30.0))
    with pytest.raises(BadInput, match="camera: hz: 30; the cameras' simulator gives 5 at most"):
        build(spoilt("burger", sensors=odd))


def test_a_missing_mesh_is_named():
    air = load_vehicle(ROOT / "vehicles", "milvus").air
    with pytest.raises(BadInput, match=r"air: mesh: no file 'milvs\.obj' in that folder; did you mean"):
        build(spoilt("milvus", air=msgspec.structs.replace(air, mesh="milvs.obj")))


def test_without_cameras_there_is_no_service():
    site = load_scenario(ROOT / "missions/demo.yaml")
    assert build(replace(site, members={})) == []
