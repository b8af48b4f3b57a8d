"""The velocity of a car: its speed within its acceleration, its turning by a steering that takes time and ends at a stop."""

from uvf.control.drive_limits import DriveLimits, VelocityRamp, approach
from uvf.maths.kinematics import Twist
from uvf.maths.wheels.steered import AckermannDrive
from uvf.models.vehicle.drive import AckermannFile
from uvf.models.vehicle.file import GroundBody


class SteeredRamp:
    """The commanded velocity, moved towards the requested one as fast as motor and steering can."""

    def __init__(self, limits: DriveLimits, drive: AckermannDrive, rate: float) -> None:
        """rate: rad/s of the steering."""
        self.limits = limits
        self.steering = 0.0
        """rad, left positive, of a wheel in the middle of the steered axle."""
        self._speed = 0.0
        self._drive, self._rate = drive, rate

    @property
    def velocity(self) -> Twist:
        """As commanded now."""
        return Twist(self._speed, self._speed * self._drive.curvature(self.steering))

    def lead(self, wanted: Twist, dt: float) -> Twist:
        """The next commanded velocity, ``dt`` [s] later. Who is to stand, or to turn on the spot, keeps the steering where it is."""
        self._speed = approach(self._speed, wanted.linear, self.limits.linear_acceleration * dt)
        if wanted.linear != 0.0:
            most = self._drive.max_steering
            angle = min(max(self._drive.steering(wanted.angular / wanted.linear), -most), most)
            self.steering = approach(self.steering, angle, self._rate * dt)
        return self.velocity

    def stand(self) -> None:
        """Brakes at once, as fast as the wheels can."""
        self._speed = 0.0


def velocity_ramp(body: GroundBody) -> VelocityRamp | SteeredRamp:
    """The ramp of a vehicle."""
    limits = DriveLimits(body.max_linear, body.max_angular, body.max_linear_acceleration, body.max_angular_acceleration)
    drive = body.drive
    return SteeredRamp(limits, drive.kinematics, drive.steering_rate) if isinstance(drive, AckermannFile) else VelocityRamp(limits)
