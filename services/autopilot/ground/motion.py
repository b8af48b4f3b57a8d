"""Whether a ground vehicle moves as its wheels are told to, and whether it stands upright: by encoders, odometry and accelerometer."""

import math
from collections.abc import Sequence

import numpy as np

from schemas.messages import Imu, WheelTicks
from uvf.maths.filters import LowPass
from uvf.maths.kinematics import DriveKinematics
from uvf.maths.rotations import from_euler, matrix
from uvf.runtime.messages.wheels import counts_of

ASKED = 0.03  # m/s of a wheel, from which on it is asked to turn
TURNS = 0.2  # of what is asked for; less is held fast
SLIP = 0.35  # of the wheels' way, from which on they turn in vain
LAG, SPEED_LAG = 0.4, 1.0  # s
WELL = 1.0  # s of moving as asked, after which it is stuck no more
TILT_TIME = 0.3  # s
JUMP = 0.5  # m, of ticks that are counted anew


class WheelSpeedometer:
    """Low-pass filtered wheel speeds [m/s] from encoder ticks."""

    def __init__(self, drive: DriveKinematics) -> None:
        self._speeds = [LowPass(LAG) for _ in range(drive.channels)]
        self.travelled = 0.0
        """m, by the one that went furthest, since the start."""
        self._drive = drive
        self._last: WheelTicks | None = None

    @property
    def speeds(self) -> list[float]:
        """m/s at the rims, by the drive's channels; none before there are ticks to compare."""
        return [speed.value for speed in self._speeds if speed.value is not None]

    def step(self, ticks: WheelTicks | None) -> None:
        """Takes the newest encoder ticks; the same message again changes nothing."""
        last = self._last
        if ticks is None or (last is not None and ticks.timestamp == last.timestamp):
            return
        self._last = ticks
        if last is None:
            return
        dt = (ticks.timestamp.ToNanoseconds() - last.timestamp.ToNanoseconds()) * 1e-9
        now, then = counts_of(ticks), counts_of(last)
        if not len(now) == len(then) == len(self._speeds):
            return
        per_tick = ticks.radians_per_tick * self._drive.wheel_radius
        ways = [(a - b) * per_tick for a, b in zip(now, then, strict=True)]
        if dt > 0 and max(map(abs, ways)) < JUMP:
            for speed, way in zip(self._speeds, ways, strict=True):
                speed.step(way / dt, dt)
            self.travelled += max(map(abs, ways))

    @property
    def speed(self) -> float:
        """Forward speed [m/s] by the wheels."""
        return self._drive.twist([speed / self._drive.wheel_radius for speed in self.speeds]).linear if self.speeds else 0.0


class StuckDetector:
    """Detects wheels that are blocked or slip.

    ``stuck_for`` [s]: how long they have; it does not change while no motion is commanded.
    """

    def __init__(self, wheels: WheelSpeedometer, channels: int) -> None:
        """channels: of the drive."""
        self.stuck_for = 0.0
        self.how = ""
        self._wheels = wheels
        self._asked = [LowPass(LAG) for _ in range(channels)]
        self._ahead = LowPass(SPEED_LAG)
        self._rolls = LowPass(SPEED_LAG)
        self._well = 0.0

    def forget(self) -> None:
        """Starts anew, when somebody has the vehicle try again."""
        self.stuck_for = self._well = 0.0

    def step(self, asked: Sequence[float], speed: float | None, dt: float) -> None:
        """One cycle of ``dt`` [s].

        asked: commanded rim speeds by the drive's channels [m/s]; speed: forward, as estimated [m/s]; None: unknown.
        """
        slips = self._slips(speed, dt)
        late = [lag.step(speed, dt) for lag, speed in zip(self._asked, asked, strict=True)]  # as late as what is measured
        if not (turning := self._wheels.speeds) or max(map(abs, asked)) < ASKED:
            return
        fast = any(abs(a) >= ASKED and abs(v) < TURNS * abs(a) for a, v in zip(late, turning, strict=True))
        self.how = "wheels are held fast" if fast else "wheels turn in vain"
        self._well = 0.0 if fast or slips else self._well + dt
        if fast or slips:
            self.stuck_for += dt
        elif self._well >= WELL:
            self.stuck_for = 0.0

    def _slips(self, speed: float | None, dt: float) -> bool:
        """Whether the vehicle does not come along with its wheels."""
        if speed is None or not math.isfinite(speed):
            return False
        ahead, rolls = self._ahead.step(speed, dt), self._rolls.step(self._wheels.speed, dt)
        return abs(rolls) >= ASKED and (rolls - ahead) * math.copysign(1.0, rolls) > SLIP * abs(rolls)


class TiltEstimate:
    """The angle [rad] between the body's z axis and the direction of the low-pass filtered specific force."""

    def __init__(self, imu_rpy: tuple[float, float, float]) -> None:
        self.angle = 0.0
        self._up = matrix(from_euler(*imu_rpy))[2]
        self._force = (LowPass(TILT_TIME), LowPass(TILT_TIME), LowPass(TILT_TIME))

    def step(self, imu: Sequence[Imu], dt: float) -> None:
        """Takes the IMU samples of a cycle of ``dt`` [s]."""
        for sample in imu:
            felt = sample.specific_force
            for part, value in zip(self._force, (felt.x, felt.y, felt.z), strict=True):
                if math.isfinite(value):
                    part.step(value, dt / len(imu))
        force = np.array([part.value or 0.0 for part in self._force])
        size = float(np.linalg.norm(force))
        if size > 1.0:
            self.angle = math.acos(min(max(float(self._up @ force) / size, -1.0), 1.0))
