"""Wheels, inertial unit, satellites and the map's correction -> odometry, pose and motion of a ground vehicle, 50 times a second."""

from math import inf, isfinite

from schemas import topics
from schemas.messages import EstimateQuality, Event, FrameTransform, Gnss, Imu, MapFix, NavState, Odometry, Pose, PoseInFrame, WheelTicks
from services.slam.odometry import messages
from services.slam.odometry.readings import Readings, satellite_fix
from uvf.estimation.odometry.calibration import Scales, SegmentMaker, WheelCalibration
from uvf.estimation.odometry.filter import DriveFilter
from uvf.estimation.odometry.params import OdometryParams
from uvf.estimation.odometry.slip import Episodes, MatchedMotion, Unseen
from uvf.estimation.odometry.states import Step
from uvf.estimation.odometry.world import MapPose, SatellitePose
from uvf.maths.geodesy import LocalTangent
from uvf.maths.kinematics import move
from uvf.maths.se2 import Pose2
from uvf.models.vehicle.file import VehicleFile
from uvf.runtime.contract.declaration import Reads, Writes, every, optional, topic
from uvf.runtime.contract.service import Service
from uvf.runtime.messages.convert import pose2_of, pose2_of_frame, seconds, stamp
from uvf.runtime.messages.wheels import counts_of, wheel_ticks
from uvf.sensors.sampling import Due

FORGOTTEN = 2.0  # s without a match, after which nobody contradicts the wheels
MAX_PREDICTION = 0.1  # s, wheel data older than this is not extrapolated further

COUNTS, BIAS, SCALES = "wheel_ticks", "gyro_bias", "scales"
"""What the odometry carries beside the pose, for an instance that is to go on after it."""


class OdometryService(Service):
    """Wheel odometry. The pose is the odometry seen through the newest ``map_from_odom``, or fused with satellites where there are any."""

    name = "odometry"
    hz = 50.0
    given_up = "the vehicle stands where it would drive by itself"

    class Inputs(Reads):
        """Encoder ticks, IMU samples, the map's correction, where scans were matched, and GNSS fixes."""

        wheels: WheelTicks = topic(topics.WHEELS)
        imu: list[Imu] = optional(every(topics.IMU))
        correction: FrameTransform | None = optional(topics.TF_MAP)
        fix: MapFix | None = optional(topics.MAP_POSE)
        gnss: list[Gnss] | None = optional(every(topics.GNSS))

    class Outputs(Writes):
        """Odometry, frame, pose, motion, quality and events."""

        odometry: Odometry | None = topic(topics.ODOMETRY)
        moving: FrameTransform | None = topic(topics.TF_ODOM)
        pose: PoseInFrame | None = topic(topics.POSE)
        nav_state: NavState | None = topic(topics.NAV_STATE)
        quality: EstimateQuality | None = topic(topics.QUALITY)
        events: list[Event] | None = topic(topics.EVENTS.by("odometry"))

    class Recalls(Reads):
        """Latched messages from which a restarted instance resumes."""

        odometry: Odometry | None = topic(topics.ODOMETRY)
        correction: FrameTransform | None = topic(topics.TF_MAP)

    params: OdometryParams
    fixed_params = frozenset({"filter", "bias_start", "scale_start", "position_start", "heading_start"})

    def __init__(
        self, vehicle: str, file: VehicleFile, world_from_map: Pose2, params: OdometryParams, tangent: LocalTangent | None = None
    ) -> None:
        """tangent: at the world's origin, for satellites."""
        if file.ground is None:
            raise ValueError(f"{vehicle} is not a ground vehicle")
        self.params = params
        drive = file.ground.drive.kinematics
        self._vehicle, self._track, self._goes_sideways = vehicle, drive.track, drive.goes_sideways
        self._readings = Readings(file.ground, file.sensors.imu.mount if file.sensors.imu else None)
        self._filter = DriveFilter(params.filter, params.noise(0.0), self._track)
        self._map = MapPose(world_from_map)
        self._satellites: SatellitePose | None = None
        if file.sensors.gnss is not None and tangent is not None:
            second = DriveFilter(params.filter, params.noise(0.0), self._track, file.sensors.gnss)
            self._satellites = SatellitePose(
                second, file.sensors.gnss, tangent, (world_from_map, params.position_start, params.heading_start)
            )
        self._scales, self._applied = Scales(), Scales()
        self._begin_calibration()
        self._matched, self._matched_at, self._episodes = MatchedMotion(), -inf, Episodes()
        self._unseen: Unseen | None = None
        self._driven = 0.0
        self._quality_due = Due(topics.QUALITY.hz)

    def step(self, t: float, now: Inputs) -> Outputs:
        """One cycle at ``t`` [s, simulation]: filters the new readings, and publishes the pose predicted to ``t``."""
        self._set_up()
        events: list[Event] = []
        if (step := self._readings.take(now.wheels, now.imu)) is not None:
            self._move(seconds(now.wheels.timestamp), step)
            cause = self._filter.doubt or (self._unseen.cause if self._unseen is not None else None)
            if (episode := self._episodes.step(cause, step.dt)) is not None:
                events.append(messages.slipping(t, episode.cause))
        if now.correction is not None:
            self._correct(now.correction)
        if now.fix is not None:
            self._compare(now.fix)
        if t - self._matched_at > FORGOTTEN:
            self._unseen = None
        if self._satellites is not None:
            self._satellites.take([satellite_fix(m) for m in now.gnss or []], self._filter.pose)
        events += self._calibrate(t)
        ahead = min(t - seconds(now.wheels.timestamp), MAX_PREDICTION)
        out = self._told(t, move(self._filter.pose, self._filter.velocity, ahead))
        out.events = events
        return out

    def recall(self, left: Recalls) -> None:
        """Resumes at the last pose published; the distance driven since then is in the ticks counted since then."""
        if left.odometry is not None:
            self._resume(left.odometry)
        if left.correction is not None:
            self._correct(left.correction)

    def _resume(self, odometry: Odometry) -> None:
        """Nothing from a message that somebody else has left: it lacks the ticks."""
        known = {pair.key: pair.value for pair in odometry.metadata}
        try:
            bias, counts = float(known[BIAS]), [int(text) for text in known[COUNTS].split()]
            applied = Scales(*map(float, known[SCALES].split())) if SCALES in known else Scales()
        except (KeyError, ValueError, TypeError):
            return
        pose = pose2_of(odometry.pose)
        if not all(map(isfinite, (*pose, odometry.pose.position.z))):
            return
        self._readings.height = odometry.pose.position.z
        self._filter.resume(pose, messages.pose_covariance(odometry), bias if isfinite(bias) else 0.0)
        self._applied = applied if all(0.7 < scale < 1.4 for scale in applied) else Scales()
        self._readings.last = wheel_ticks(seconds(odometry.timestamp), counts, 0.0)

    def _set_up(self) -> None:
        """Parameters as they are now, and the wheels by them and by what has been found."""
        noise = self.params.noise(self._readings.resolution)
        scales = Scales(*(a * b for a, b in zip(self.params.scales, self._applied, strict=True)))
        for drive in self._drives:
            drive.noise = noise
        if scales != self._scales:
            for drive in self._drives:
                drive.believe_radii()
                drive.track = self._track * scales.track
            self._scales = scales
            self._begin_calibration()

    @property
    def _drives(self) -> list[DriveFilter]:
        return [self._filter] if self._satellites is None else [self._filter, self._satellites.drive]

    def _move(self, t: float, told: Step) -> None:
        step = told._replace(travel=told.travel._replace(left=told.left * self._scales.left, right=told.right * self._scales.right))
        self._driven += abs(step.left + step.right) / 2
        for drive in self._drives:
            drive.is_unseen = self._unseen is not None
            drive.step(step)
        self._matched.roll(t, (step.left + step.right) / 2)
        if self._satellites is not None:
            self._satellites.note(t, self._filter.pose)
        slipping = self._episodes.active or self._filter.doubt is not None
        self._segments.roll(step.left, step.right, self._filter.pose.yaw, slipping)

    def _correct(self, correction: FrameTransform) -> None:
        newest, t = pose2_of_frame(correction), seconds(correction.timestamp)
        if not all(map(isfinite, newest)):
            return
        pose = self._filter.pose
        if not self._map.correct(newest, self._filter.covariance):
            return
        self._segments.match(self._map.map_from(pose))
        if self._satellites is not None:
            drift = self.params.map_sigma + self.params.map_drift * self._driven**0.5
            self._satellites.mapped(t, self._map.world_from(pose), drift)

    def _compare(self, fix: MapFix) -> None:
        """Whether a match of a scan shows the motion that the wheels tell of."""
        t, matched = seconds(fix.timestamp), Pose2(fix.x, fix.y, fix.yaw)
        if t == self._matched_at or not all(map(isfinite, matched)) or not self._matched.reaches(t):
            return
        self._matched_at = t
        self._unseen = self._matched.compare(t, matched)
        if self._unseen is not None:
            for drive in self._drives:
                drive.see(self._unseen.speed)

    def _begin_calibration(self) -> None:
        """On top of the scales in force."""
        self._calibration = WheelCalibration(self._track * self._scales.track)
        self._segments = SegmentMaker(self._calibration)
        self._has_told = False

    def _calibrate(self, t: float) -> list[Event]:
        """Scales that have become certain are told once, and put in force where this is wanted."""
        if self.params.calibrate == "off" or self._goes_sideways or self._has_told or not self._calibration.is_certain:
            return []
        self._has_told = True
        if not self._calibration.differs:
            return []
        applies = self.params.calibrate == "apply"
        event = messages.calibrated(t, self._calibration, self._scales, applies)
        if applies:
            self._applied = Scales(*(a * b for a, b in zip(self._applied, self._calibration.scales, strict=True)))
        return [event]

    def _told(self, t: float, odom_from_base: Pose2) -> Outputs:
        drive, last = self._filter, self._readings.last or WheelTicks()
        left_over = {COUNTS: " ".join(map(str, counts_of(last))), BIAS: repr(drive.bias)}
        if self._applied != Scales():
            left_over[SCALES] = " ".join(map(repr, self._applied))
        pose, sigma = self._map.world_from(odom_from_base), self._map.sigma(drive.covariance, self.params.map_sigma)
        known, ratio = self._map.is_known(drive.covariance), 0.0
        if self._satellites is not None:
            pose = self._satellites.shown(drive.pose, odom_from_base, self.params.correction_speed / self.hz)
            sigma, known, ratio = self._satellites.sigma, self._satellites.is_known(t), self._satellites.ratio
        stance = messages.Stance(self._readings.height, *self._readings.tilt)
        in_odom, state = stance.pose(odom_from_base), messages.nav_state(t, pose, stance, drive.velocity, sigma)
        in_world = Pose(position=state.position, orientation=state.orientation)
        return self.Outputs(
            odometry=messages.odometry(t, self._vehicle, in_odom, drive, left_over),
            moving=messages.moving(t, self._vehicle, in_odom),
            pose=PoseInFrame(timestamp=stamp(t), frame_id="world", pose=in_world),
            nav_state=state,
            quality=messages.quality(t, sigma, drive, (known, ratio)) if self._quality_due.at(t) else None,
        )
