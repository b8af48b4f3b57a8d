"""Where the surfaces and the propeller of an aircraft are, as ``sensor/joints`` tells; a part that has hardly turned stays as it was."""

from collections.abc import Mapping, Sequence

import numpy as np

from schemas.messages import JointStates
from services.gcs.state.vehicle_model import DisplayPose
from uvf.maths.rotations import IDENTITY, from_axis
from uvf.models.aircraft.panels import Movable
from uvf.models.vehicle.surface_joints import deflection
from uvf.runtime.messages.convert import seconds

SEEN = 0.01  # rad, turns smaller than that are not shown
MOST_TURN = 0.9  # rad of the propeller between two messages: two blades that turn faster would seem to turn back


class MovingParts:
    """The moving parts of one aircraft's display model."""

    def __init__(self, movables: Sequence[Movable]) -> None:
        self._movables = movables
        self._angles = dict.fromkeys((m.name for m in movables), 0.0)
        self._placed = {m.name: DisplayPose(m.origin, IDENTITY) for m in movables}
        self._heard: JointStates | None = None

    def places(self, joints: JointStates | None) -> Mapping[str, DisplayPose]:
        """Poses of the parts in the body frame, by name; the same objects while no visible turn happens."""
        if joints is not None and joints is not self._heard:
            angles = {joint.name: joint.position for joint in joints.joints}
            speeds = {joint.name: joint.velocity for joint in joints.joints}
            dt = seconds(joints.timestamp) - seconds(self._heard.timestamp) if self._heard is not None else 0.0
            self._heard = joints
            for movable in self._movables:
                if movable.spins:
                    turn = min(max(speeds.get(movable.name, 0.0) * dt, -MOST_TURN), MOST_TURN)
                    self._show(movable, (self._angles[movable.name] + turn) % (2 * np.pi))
                else:
                    self._show(movable, deflection(movable.name, angles))
        return self._placed

    def _show(self, movable: Movable, angle: float) -> None:
        if abs(angle - self._angles[movable.name]) > SEEN:
            self._angles[movable.name] = angle
            self._placed[movable.name] = DisplayPose(movable.origin, from_axis(movable.axis, angle))
