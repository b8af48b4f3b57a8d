"""A wheel's motor with its gear and speed controller: a brushed DC motor has a straight torque-speed line.

Murray, Li & Sastry, A Mathematical Introduction to Robotic Manipulation, 4.2, without the winding's inductance.
"""

from math import exp

from uvf.models.vehicle.file import Motor


class WheelMotor:
    """The controller's reference follows the command with a lag; the torque that it may spend is what the motor has at this speed."""

    def __init__(self, motor: Motor, dt: float) -> None:
        """dt: s, of the physics step."""
        self._motor = motor
        self._keep = exp(-dt / motor.lag) if motor.lag else 0.0
        self.reference = 0.0
        """rad/s, what the wheel is held at if the torque is enough."""

    def step(self, command: float, speed: float) -> float:
        """Available torque [N m] to bring the wheel, now at ``speed`` [rad/s], to the new reference; command [rad/s]."""
        top = self._motor.no_load_speed
        wanted = min(max(command, -top), top)
        self.reference = wanted + (self.reference - wanted) * self._keep
        return self.torque(speed, self.reference - speed)

    def power(self, torque: float, speed: float) -> float:
        """Electric power [W] at this torque [N m] and speed [rad/s]: mechanical power and the winding's loss, which at a stand is all.

        The loss is I^2 R, and at the stall torque V^2 / R, which is stall torque times no-load speed. Energy of braking is not recovered.
        """
        loss = torque**2 * self._motor.no_load_speed / self._motor.stall_torque
        return max(torque * speed + loss, 0.0)

    def torque(self, speed: float, error: float) -> float:
        """Available torque [N m], >= 0, in the direction of ``error`` [rad/s] at ``speed`` [rad/s].

        It is full at a stand and against the rotation, where the driver limits the current.
        """
        with_it = speed if error >= 0.0 else -speed
        return self._motor.stall_torque * min(max(1.0 - with_it / self._motor.no_load_speed, 0.0), 1.0)
