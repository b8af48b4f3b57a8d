"""Whether a ground vehicle moves as its wheels are told to, and whether it stands upright: by encoders, odometry and accelerometer."""

import math
from collections.abc import Sequence

import numpy as np

from schemas.messages import Imu, WheelTicks
from uvf.maths.filters import LowPass
from uvf.maths.kinematics import WheelSpeeds
from uvf.maths.rotations import from_euler, matrix

ASKED = 0.03  # m/s of a wheel, from which on it is asked to turn
TURNS = 0.2  # of what is asked for; less is held fast
SLIP = 0.35  # of the wheels' way, from which on they turn in vain
LAG, SPEED_LAG = 0.4, 1.0  # s
WELL = 1.0  # s of moving as asked, after which it is stuck no more
TILT_TIME = 0.3  # s
JUMP = 0.5  # m, of ticks that are counted anew


class WheelSpeedometer:
    """Low-pass filtered wheel speeds [m/s] from encoder ticks."""

    def __init__(self, radius: float) -> None:
        """radius: m."""
        self.left, self.right = LowPass(LAG), LowPass(LAG)
        self.travelled = 0.0
        """m, by the one that went further, since the start."""
        self._radius = radius
        self._last: WheelTicks | None = None

    def step(self, ticks: WheelTicks | None) -> None:
        """Takes the newest encoder ticks; the same message again changes nothing."""
        last = self._last
        if ticks is None or (last is not None and ticks.timestamp == last.timestamp):
            return
        self._last = ticks
        if last is None:
            return
        dt = (ticks.timestamp.ToNanoseconds() - last.timestamp.ToNanoseconds()) * 1e-9
        per_tick = ticks.radians_per_tick * self._radius
        left, right = (ticks.left - last.left) * per_tick, (ticks.right - last.right) * per_tick
        if dt > 0 and max(abs(left), abs(right)) < JUMP:
            self.left.step(left / dt, dt)
            self.right.step(right / dt, dt)
            self.travelled += max(abs(left), abs(right))

    @property
    def speed(self) -> float:
        """Forward speed [m/s]: the mean of both wheels."""
        return ((self.left.value or 0.0) + (self.right.value or 0.0)) / 2


class StuckDetector:
    """Detects wheels that are blocked or slip.

    ``stuck_for`` [s]: how long they have; it does not change while no motion is commanded.
    """

    def __init__(self, wheels: WheelSpeedometer) -> None:
        self.stuck_for = 0.0
        self.how = ""
        self._wheels = wheels
        self._asked = LowPass(LAG), LowPass(LAG)
        self._ahead = LowPass(SPEED_LAG)
        self._rolls = LowPass(SPEED_LAG)
        self._well = 0.0

    def forget(self) -> None:
        """Starts anew, when somebody has the vehicle try again."""
        self.stuck_for = self._well = 0.0

    def step(self, asked: WheelSpeeds, speed: float | None, dt: float) -> None:
        """One cycle of ``dt`` [s]. asked: commanded rim speeds [m/s]; speed: forward, as estimated [m/s]; None: unknown."""
        slips = self._slips(speed, dt)
        wheels = self._wheels
        left, right = (lag.step(speed, dt) for lag, speed in zip(self._asked, asked, strict=True))  # as late as what is measured
        pairs = ((left, wheels.left.value), (right, wheels.right.value))
        if wheels.left.value is None or max(map(abs, asked)) < ASKED:
            return
        fast = any(abs(a) >= ASKED and abs(v or 0.0) < TURNS * abs(a) for a, v in pairs)
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
