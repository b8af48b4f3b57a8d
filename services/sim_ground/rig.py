"""One ground vehicle's sensors: which of them are due at a step, and what they say."""

import copy
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from typing import NamedTuple, Self

import numpy as np
from google.protobuf.message import Message
from numpy.typing import NDArray

from schemas import topics
from schemas.messages import FrameTransforms
from services.sim_ground import readings
from services.sim_ground.body import BodyState, Touch
from services.sim_ground.imu import ImuModel
from uvf.maths.geodesy import LocalTangent
from uvf.maths.kinematics import spin_velocity
from uvf.maths.raycast import MovingBody, Scene
from uvf.maths.rotations import rotate
from uvf.models.scenario import MissionVehicle, Scenario
from uvf.models.vehicle.battery import Charge
from uvf.models.vehicle.file import GroundBody
from uvf.models.vehicle.sensors import Encoders, GnssSensor, ImuSensor, Lidar, RangeFinder, Sampled, Sonar
from uvf.runtime.messages.link_frames import Links
from uvf.runtime.messages.outputs import Value
from uvf.runtime.messages.readings.sensors import battery_message, gnss_message, imu_message, range_message, scan_message
from uvf.sensors.body_track import BodyTrack
from uvf.sensors.fitted import line_of, receiver
from uvf.sensors.instruments import Receiver
from uvf.sensors.range_sensors import LidarModel, RangeModel
from uvf.sensors.sampling import DelayLine, Due

Floats = NDArray[np.float64]

STEP_HZ = 100.0
STANDS_BELOW = 0.05  # m/s


class Moment(NamedTuple):
    """What there is to measure: the body, the moving bodies (computed when a ray is cast), and all contacts."""

    body: BodyState
    others: Callable[[], list[MovingBody]] = list
    touches: Sequence[Touch] = ()
    motor_energy: float = 0.0  # J that the motors have drawn since the moment before


Read = Callable[[float, Moment], Message]


class FittedSensor(NamedTuple):
    """A sensor: how it reads the moment, and its delay line."""

    read: Read
    line: DelayLine[Message]

    def step(self, t: float, moment: Moment) -> Message | None:
        """The reading that arrives at the step at ``t`` [s], if any."""
        return self.line.step(t, lambda: self.read(t, moment))


class Rig:
    """The sensors of one vehicle; each draws from generators of its own, so that none disturbs another."""

    def __init__(self, site: Scenario, member: MissionVehicle, ground: GroundBody, scene: Scene) -> None:
        """scene: what stands in the world."""
        self._links = Links(member.folder / ground.urdf, ground.turning_joints)
        self.ground = ground
        self._site = site
        self._scene = scene
        self._member = member
        self._bumpers = member.file.sensors.bumpers
        imu = member.file.sensors.imu
        self.is_quick = imu is not None and imu.hz > STEP_HZ
        self._early: list[Message] = []
        self._touches: list[Touch] = []
        self._truth_due = Due(topics.TRUTH.hz)
        self._contact_due = Due(topics.CONTACT.hz)
        self._joints_due = Due(topics.JOINTS.hz)
        self._battery_due = Due(topics.BATTERY.hz)
        self.charge = Charge(ground.battery, member.entry.start.charge) if ground.battery is not None else None
        self._tracks: list[BodyTrack] = []
        """Of the body, for lidars that take their time."""
        self._fitted = dict(self._fit())
        sonars, finders = member.file.sensors.sonars, member.file.sensors.rangefinders
        self._rangers = {
            "other_scans": [self._other_lidar(lidar) for lidar in member.file.sensors.other_lidars],
            "sonar": [self._ranger("sonar", s) for s in sonars],
            "range": [self._ranger("range", f) for f in finders],
        }

    def _fit(self) -> Iterator[tuple[str, FittedSensor]]:
        """What there is one of, by output name."""
        sensors = self._member.file.sensors
        if sensors.imu is not None:
            yield "imu", self._with_line(self._imu(sensors.imu), sensors.imu, "imu")
        if sensors.lidar is not None:
            yield "scan", self._with_line(self._lidar(sensors.lidar, self._rng("lidar")), sensors.lidar, "lidar")
        if sensors.encoders is not None:
            yield "wheels", self._with_line(self._encoders(sensors.encoders), sensors.encoders, "encoders")
        if sensors.gnss is not None:
            yield "gnss", self._with_line(self._gnss(sensors.gnss), sensors.gnss, "gnss")

    @property
    def is_flat(self) -> bool:
        """Whether the battery is empty."""
        return self.charge is not None and self.charge.remaining == 0

    def frames(self, t: float) -> FrameTransforms:
        """The fixed frames of the vehicle, stamped ``t`` [s]."""
        return self._links.resting(self._member.name, self._member.file.sensors, t)

    def glance(self, t: float, body: BodyState) -> None:
        """Reads an IMU that is faster than the steps, between two of them at ``t`` [s]; the reading is published at the next step."""
        if self.is_quick and (message := self._fitted["imu"].step(t, Moment(body))) is not None:
            self._early.append(message)

    def read(self, t: float, moment: Moment) -> Mapping[str, Value]:
        """Readings that arrive at the step at ``t`` [s], by output name.

        A contact is kept until it has been published, so that a short one between two messages is not lost.
        """
        self._touches += moment.touches
        for track in self._tracks:
            track.add(t, moment.body)
        found: dict[str, Value] = {}
        for output, sensor in self._fitted.items():
            message = sensor.step(t, moment)
            early = self._early if output == "imu" else []
            if early:
                found[output] = [*early, message] if message is not None else early
                self._early = []
            elif message is not None:
                found[output] = message
        for output, rangers in self._rangers.items():
            if heard := [message for ranger in rangers if (message := ranger.step(t, moment)) is not None]:
                found[output] = heard
        if self._truth_due.at(t):
            found["truth"] = readings.truth_message(t, moment.body)
        if self.charge is not None:
            self.charge.draw(moment.motor_energy * STEP_HZ, 1 / STEP_HZ, self._charger(moment.body))
            if self._battery_due.at(t):
                found["battery"] = battery_message(t, self.charge)
        if self._contact_due.at(t):
            found["contact"] = readings.contact_message(t, self._bumpers, self._touches)
            self._touches = []
        if self._joints_due.at(t):
            found["joints"] = joints = readings.joints_message(t, self.ground, moment.body)
            found["joint_frames"] = self._links.turned(self._member.name, joints)
        return found

    def _charger(self, body: BodyState) -> float:
        """W, of the charger on which the vehicle stands; 0 without one."""
        if float(np.linalg.norm(body.velocity)) > STANDS_BELOW:
            return 0.0
        x, y = body.position[:2].tolist()
        return max((c.power for c in self._site.mission.chargers if math.hypot(x - c.x, y - c.y) <= c.radius), default=0.0)

    def _rng(self, *names: str) -> np.random.Generator:
        return self._site.rng(self._member.name, *names)

    def _with_line(self, read: Read, sensor: Sampled, *names: str) -> FittedSensor:
        return FittedSensor(read, line_of(sensor, self._rng(*names, "dropout")))

    def _frame(self, frame: str) -> str:
        return f"{self._member.name}/{frame}"

    def _imu(self, imu: ImuSensor) -> Read:
        return partial(_read_imu, self._frame(imu.frame), ImuModel(imu, np.array(self._site.world.magnetic_field), self._rng("imu")))

    def _lidar(self, lidar: Lidar, rng: np.random.Generator) -> Read:
        model = LidarModel(lidar, self._scene, rng)
        if lidar.sweep_time > 0.0:
            self._tracks.append(model.track)
        return partial(_read_lidar, self._frame(lidar.frame), lidar, model)

    def _other_lidar(self, lidar: Lidar) -> FittedSensor:
        return self._with_line(self._lidar(lidar, self._rng("lidar", lidar.frame)), lidar, "lidar", lidar.frame)

    def _encoders(self, encoders: Encoders) -> Read:
        return partial(_read_encoders, encoders, self.ground.drive.channels)

    def _gnss(self, gnss: GnssSensor) -> Read:
        origin = self._site.world.origin
        tangent = LocalTangent.from_degrees(origin.latitude, origin.longitude, origin.altitude)
        return partial(_read_gnss, gnss, receiver(gnss, tangent, self._rng("gnss")))

    def _ranger(self, kind: str, sensor: Sonar | RangeFinder) -> FittedSensor:
        model = RangeModel(sensor, self._scene, self._rng(kind, sensor.frame))
        return self._with_line(partial(_read_range, self._frame(sensor.frame), sensor, model), sensor, kind, sensor.frame)

    def __deepcopy__(self, memo: dict[int, object]) -> Self:
        """A rig that goes on from here by itself: generators and readings under way are its own, what does not change is shared."""
        memo |= {id(part): part for part in (self._site, self._scene, self._member, self._links, self.ground)}
        twin = object.__new__(type(self))
        twin.__dict__ = copy.deepcopy(self.__dict__, memo)
        return twin


def _read_imu(frame: str, model: ImuModel, t: float, moment: Moment) -> Message:
    return imu_message(frame, model.read(t, moment.body))


def _read_lidar(frame: str, lidar: Lidar, model: LidarModel, t: float, moment: Moment) -> Message:
    """Of the sweep that ends at ``t`` [s]; its stamp is that of the first beam."""
    if lidar.sweep_time > 0.0:
        return scan_message(t - lidar.sweep_time, frame, lidar, model.sweep(t, moment.others()))
    return scan_message(t, frame, lidar, model.scan(moment.body, moment.others()))


def _read_encoders(encoders: Encoders, channels: Sequence[int], t: float, moment: Moment) -> Message:
    return readings.wheels_message(t, encoders, channels, moment.body)


def _read_gnss(gnss: GnssSensor, receiver: Receiver, t: float, moment: Moment) -> Message:
    body, arm = moment.body, np.array(gnss.mount.xyz)
    position = body.position + rotate(body.world_from_body, arm)
    velocity = body.velocity + rotate(body.world_from_body, spin_velocity(body.angular_velocity, arm))
    return gnss_message(gnss, receiver.read(t, position, velocity))


def _read_range(frame: str, sensor: Sonar | RangeFinder, model: RangeModel, t: float, moment: Moment) -> Message:
    return range_message(t, frame, sensor, model.range(moment.body, moment.others()))
