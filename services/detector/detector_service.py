"""Camera pictures and frames of a vehicle -> the coloured markers that it has found, and where they stand."""

import math
from typing import Annotated

from msgspec import Meta

from schemas import topics
from schemas.messages import CameraCalibration, CompressedImage, Detection, Detections, Event
from uvf.maths.rotations import rotate
from uvf.maths.se3 import Transform
from uvf.models.keys import key
from uvf.models.params import Params
from uvf.models.yaml_data import BadInput
from uvf.runtime.contract.declaration import Reads, Writes, every, frames, optional, topic
from uvf.runtime.contract.service import Service
from uvf.runtime.messages.convert import array, seconds, stamp, vector
from uvf.runtime.messages.frames import FrameBuffer
from uvf.runtime.messages.readings.pictures import PinholeRays, rgb_picture
from uvf.runtime.messages.waiting import WaitingForFrames
from uvf.vision import ColourRange, MarkerMap, MarkerModel, Sighting, colour_blobs

WORLD = "world"
WAITING_MOST = 16
MOST = 200  # markers that are told of

Metres = Annotated[float, Meta(gt=0, le=1e4)]


class DetectorParams(Params, frozen=True):
    """Parameters of the detector: which colour markers have, what they are like, and which of them count as found."""

    hue: Annotated[float, Meta(ge=0, le=6.2832), key("rad", "Hue of the markers: 0 red, 2.09 green, 4.19 blue, 5.24 magenta.")] = 5.24
    hue_width: Annotated[float, Meta(gt=0, le=1), key("rad", "Farthest that a hue may be from it.")] = 0.35
    saturation: Annotated[float, Meta(ge=0, le=1), key("", "Least saturation.")] = 0.4
    value: Annotated[float, Meta(ge=0, le=1), key("", "Least brightness.")] = 0.2
    pixels: Annotated[int, Meta(ge=1, le=10_000), key("", "Least pixels of a marker.")] = 6
    height: Annotated[Metres, key("m", "Height of a marker.")] = 1.0
    ground: Annotated[float, Meta(ge=-1e4, le=1e4), key("m", "Height of the ground that markers stand on, above the world's origin.")] = 0.0
    ground_sigma: Annotated[Metres, key("m", "1 sigma of the ground's height.")] = 0.5
    pose_sigma: Annotated[Metres, key("m", "1 sigma of the vehicle's own place.")] = 0.2
    angle_sigma: Annotated[float, Meta(gt=0, le=0.5), key("rad", "1 sigma of the direction in which something is seen.")] = 0.01
    reach: Annotated[Metres, key("m", "Distance beyond which nothing is taken for a marker.")] = 60.0
    least_apart: Annotated[Metres, key("m", "Two markers nearer to each other are one.")] = 1.5
    views: Annotated[int, Meta(ge=1, le=100), key("", "Places from which a marker has been seen, before it counts as found.")] = 3
    sigma: Annotated[Metres, key("m", "1 sigma of its place, horizontal, within which it counts as found.")] = 0.5


class DetectorService(Service):
    """One per vehicle with a camera: coloured patches of its pictures become markers in the world, seen from several places."""

    name = "detector"
    hz = 5.0
    given_up = "the vehicle finds no markers any more"

    class Inputs(Reads):
        """Pictures, intrinsics and frames."""

        image: list[CompressedImage] = optional(every(topics.IMAGE))
        info: CameraCalibration | None = optional(topics.CAMERA_INFO)
        frames: FrameBuffer = frames()

    class Outputs(Writes):
        """Markers found, and events."""

        detections: Detections | None = topic(topics.DETECTIONS)
        events: list[Event] | None = topic(topics.EVENTS.by("detector"))

    class Recalls(Reads):
        """What an instance before this one has found."""

        detections: Detections | None = topic(topics.DETECTIONS)

    params: DetectorParams
    fixed_params = frozenset({"height", "ground", "ground_sigma", "pose_sigma", "angle_sigma", "reach", "least_apart"})

    def __init__(self, params: DetectorParams) -> None:
        self.params = params
        p = params
        self._map = MarkerMap(MarkerModel(p.height, p.ground, p.ground_sigma, p.pose_sigma, p.angle_sigma, p.reach, p.least_apart))
        self._waiting = WaitingForFrames[CompressedImage](WAITING_MOST)
        self._told = Detections()
        self._faults: set[str] = set()

    def step(self, t: float, now: Inputs) -> Outputs:
        """One cycle at ``t`` [s, simulation]: looks at the pictures of which it is known by now where they were taken."""
        for picture in now.image:
            self._waiting.add(seconds(picture.timestamp), picture)
        out = self.Outputs(events=[])
        if now.info is not None:
            out.events = self._look(t, now.info, now.frames)
        found = self._found(t)
        if found.detections != self._told.detections:
            out.events = [*(out.events or ()), *self._news(t, found)]
            self._told = out.detections = found
        return out

    def recall(self, left: Recalls) -> None:
        """Goes on with the markers found."""
        if left.detections is None:
            return
        self._told = left.detections
        known = [(d.id, array(d.position), d.sigma, d.views) for d in left.detections.detections[:MOST]]
        self._map.resume([each for each in known if all(map(math.isfinite, (*each[1], each[2]))) and each[2] > 0])

    def _look(self, t: float, info: CameraCalibration, frames: FrameBuffer) -> list[Event]:
        events: list[Event] = []
        for picture, world_from_camera in self._waiting.placed(t, lambda waiting: (waiting, _place(waiting, frames))):
            try:
                for sighting in self._sightings(picture, info, world_from_camera):
                    self._map.see(sighting)
            except BadInput as error:
                events += self._tell(t, "a picture is left out", str(error))
        if self._waiting.lost:
            events += self._tell(t, "pictures are left out: nobody knows where they were taken", self._waiting.lost)
        return events

    def _sightings(self, picture: CompressedImage, info: CameraCalibration, world_from_camera: Transform) -> list[Sighting]:
        """Raises BadInput for a picture that is none."""
        rays = PinholeRays(info)
        p = self.params
        found = []
        for blob in colour_blobs(rgb_picture(picture, info), ColourRange(p.hue, p.hue_width, p.saturation, p.value), p.pixels):
            ray = rotate(world_from_camera.rotation, rays.at(blob.column, blob.row))
            height = None if blob.is_cut else math.atan(blob.height / rays.focal)
            found.append(Sighting(world_from_camera.translation, ray, height))
        return found

    def _found(self, t: float) -> Detections:
        counting = [marker for marker in self._map.markers if marker.views >= self.params.views and marker.sigma <= self.params.sigma]
        told = [Detection(id=m.id, position=vector(m.position), sigma=m.sigma, views=m.views) for m in counting[:MOST]]
        return Detections(timestamp=stamp(t), detections=told)

    def _news(self, t: float, found: Detections) -> list[Event]:
        known = {each.id for each in self._told.detections}
        return [
            Event(
                timestamp=stamp(t),
                severity=Event.NOTICE,
                text=f"marker {each.id} found at ({each.position.x:.1f}, {each.position.y:.1f})",
                cause=f"seen from {each.views} places",
                source=self.name,
            )
            for each in found.detections
            if each.id not in known
        ]

    def _tell(self, t: float, text: str, cause: str) -> list[Event]:
        """Each kind of trouble once."""
        if text in self._faults:
            return []
        self._faults.add(text)
        return [Event(timestamp=stamp(t), severity=Event.WARNING, text=text, cause=cause, source=self.name)]


def _place(picture: CompressedImage, frames: FrameBuffer) -> Transform:
    """World from the camera as it was when the picture was taken. Raises FrameError as long as that is not known."""
    return frames.lookup(WORLD, picture.frame_id, seconds(picture.timestamp))
