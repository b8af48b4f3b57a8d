"""The Clearpath Jackal of the BARN challenge: what it measures, and how its four wheels skid.

Figures are those of the packages jackal_description, jackal_control and of the challenge's own start script, on whose command the
scanner stands 0.065 m behind the front mount. PyBullet's contacts do not carry a skid-steered vehicle: with four wheels its turns
come out at 0.3 to 1.3 of the rate at which Coulomb friction balances, by the number of the solver's iterations. So the motion in
the plane is computed here, with friction under each wheel against the velocity at which it slides, and PyBullet tells what touches.
"""

import numpy as np
from numpy.typing import NDArray

from benchmarks.planning.barn.controllers import Robot, Scanner
from uvf.control.drive_limits import DriveLimits, VelocityRamp
from uvf.maths.compiled import compiled
from uvf.maths.geodesy import GRAVITY
from uvf.maths.kinematics import DifferentialDrive, Twist

Floats = NDArray[np.float64]

MASS = 16.523 + 4 * 0.477  # kg
INERTIA = 0.4485 + 4 * (0.0013 + 0.477 * (0.131**2 + 0.187795**2))  # kg m^2, about the vertical
WHEEL_RADIUS, TRACK, WHEEL_BASE = 0.098, 0.37559, 0.262  # m
MASS_FORWARD = 0.012  # m, of the centre of mass
TRACK_FACTOR = 1.5
"""The wheel controller takes the track for so much wider, which is what skidding makes of it: 1 + (wheel base / track)^2 = 1.49."""
MU = 0.5  # of tyre and floor
CREEP = 0.05  # m/s of sliding at which a tyre gives 0.7 of its friction
LAG = 0.05  # s, time constant of a wheel's speed
SUBSTEPS = 5

SCANNER = Scanner(
    forward=0.055,
    angle_min=-2.35619,
    angle_increment=2 * 2.35619 / 719,
    beams=720,
    range_min=0.1,
    range_max=30.0,
    noise=0.001,
)
JACKAL = Robot(
    half_length=0.254,
    half_width=0.216,
    max_linear=2.0,
    max_angular=4.0,
    max_linear_acceleration=MU * GRAVITY,
    max_angular_acceleration=25.0,
    scanner=SCANNER,
)
COMMANDED = DriveLimits(JACKAL.max_linear, JACKAL.max_angular, 20.0, 25.0)
"""How the wheel controller lets the command rise, more than the tyres carry."""
WHEELS = DifferentialDrive(WHEEL_RADIUS, TRACK_FACTOR * TRACK)


class Drive:
    """The robot's motion in the plane by its commands."""

    def __init__(self, pose: tuple[float, float, float], dt: float) -> None:
        """pose: x, y [m], yaw [rad] of base_link at rest; dt: s, of a step."""
        self._dt = dt
        self._ramp = VelocityRamp(COMMANDED)
        self._state = np.array((*pose, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0))

    @property
    def pose(self) -> Floats:
        """(3,) x, y [m], yaw [rad, not wrapped] of base_link; a view of what the next step changes."""
        return self._state[:3]

    @property
    def twist(self) -> Twist:
        """Velocity forward [m/s] and turn rate [rad/s] of base_link."""
        return Twist(float(self._state[3]), float(self._state[5]))

    @property
    def rolled(self) -> tuple[float, float]:
        """Angles [rad] by which the left and the right wheels have turned."""
        return float(self._state[8]), float(self._state[9])

    def step(self, command: Twist) -> None:
        """Moves on by one step; the command is clipped to the limits, v and w each for itself, as the wheel controller does."""
        linear = min(max(command.linear, -COMMANDED.linear), COMMANDED.linear)
        angular = min(max(command.angular, -COMMANDED.angular), COMMANDED.angular)
        wheels = WHEELS.wheels(self._ramp.lead(Twist(linear, angular), self._dt))
        _skid(self._state, wheels.left, wheels.right, self._dt)


@compiled
def _skid(state: Floats, left: float, right: float, dt: float) -> None:
    """Moves ``state`` (10,) on: x, y, yaw, velocity forward and left, turn rate, speeds and angles of left and right wheels.

    left, right: reference [rad/s] of the wheels. Each wheel carries its static part of the weight; the velocity is that of the
    middle between the wheels, whose distance to the centre of mass counts in the loads and in the moment alone.
    """
    h = dt / SUBSTEPS
    keep = np.exp(-h / LAG)
    front = 0.5 * (0.5 + MASS_FORWARD / WHEEL_BASE)  # part of the weight on each front wheel
    for _ in range(SUBSTEPS):
        state[6] = left + (state[6] - left) * keep
        state[7] = right + (state[7] - right) * keep
        forward, sideways, moment = 0.0, 0.0, 0.0
        for wheel in range(4):
            x = WHEEL_BASE / 2 if wheel < 2 else -WHEEL_BASE / 2
            y = TRACK / 2 if wheel % 2 == 0 else -TRACK / 2
            load = MASS * GRAVITY * (front if wheel < 2 else 0.5 - front)
            rolling = WHEEL_RADIUS * (state[6] if wheel % 2 == 0 else state[7])
            u, v = state[3] - state[5] * y - rolling, state[4] + state[5] * x
            grip = -MU * load / np.sqrt(u * u + v * v + CREEP * CREEP)
            forward += grip * u
            sideways += grip * v
            moment += (x - MASS_FORWARD) * grip * v - y * grip * u
        along, aside, turn = state[3], state[4], state[5]
        spin = moment / INERTIA
        state[3] = along + h * (forward / MASS + aside * turn + MASS_FORWARD * turn * turn)
        state[4] = aside + h * (sideways / MASS - along * turn - MASS_FORWARD * spin)
        state[5] = turn + h * spin
        c, s = np.cos(state[2] + h * state[5] / 2), np.sin(state[2] + h * state[5] / 2)
        state[0] += h * (c * state[3] - s * state[4])
        state[1] += h * (s * state[3] + c * state[4])
        state[2] += h * state[5]
        state[8] += h * state[6]
        state[9] += h * state[7]
