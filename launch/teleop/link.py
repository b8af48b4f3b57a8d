"""The way of ``uvf teleop`` to vehicles over the bus."""

import time

from schemas import topics
from schemas.messages import ArmRequest, Mode, ModeRequest
from uvf.client import Client
from uvf.maths.kinematics import Twist
from uvf.runtime.messages.wheels import drive_command
from uvf.runtime.state.stop_all import told

SOURCE = "teleop"
LOST_AFTER = 1.5  # s without a status
ANSWER_WITHIN = 1.0  # s


class TeleopLink:
    """The connection to vehicles over the bus."""

    def __init__(self, client: Client) -> None:
        self._client = client
        self._count: dict[str, int] = {}
        self._heard_at: dict[str, float] = {}

    def send(self, vehicle: str, command: Twist) -> None:
        """Publishes a velocity command [m/s, rad/s] for a ground vehicle."""
        self._client.send(vehicle, topics.DRIVE.by(SOURCE), drive_command(command))

    def take_over(self, vehicle: str) -> str:
        """Asks for mode MANUAL and arms; what was refused and why, "" if nothing."""
        try:
            replies = (
                self._client.ask(vehicle, topics.SET_MODE, ModeRequest(mode=Mode.MODE_MANUAL, source=SOURCE), ANSWER_WITHIN),
                self._client.ask(vehicle, topics.ARM, ArmRequest(arm=True, source=SOURCE), ANSWER_WITHIN),
            )
        except TimeoutError as error:
            return f"{vehicle}: {error}"
        return next((f"{vehicle}: {reply.reason}" for reply in replies if not reply.accepted), "")

    def state(self, vehicle: str) -> str:
        """LIVE and whose commands are in force, or for how long nothing has been heard."""
        now, count = time.monotonic(), self._client.heard(vehicle, topics.STATUS)
        if count != self._count.get(vehicle, 0):
            self._count[vehicle], self._heard_at[vehicle] = count, now
        if vehicle not in self._heard_at:
            return "NO LINK"
        age = now - self._heard_at[vehicle]
        if age > LOST_AFTER:
            return f"LINK LOST {age:.0f} s"
        status = self._client.read(vehicle, topics.STATUS)
        return (
            f"LIVE STOP ALL by {told(status.stops) or 'somebody'}" if status.stopped else f"LIVE {status.command_source or status.reason}"
        )
