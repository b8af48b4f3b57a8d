"""Joints that are moved on command: where they are told to go, and where they are led on the way."""

from collections.abc import Mapping

from schemas.messages import JointState, JointStates, MoveJointsRequest
from uvf.control.drive_limits import approach
from uvf.models.vehicle.joints import MovedJoint, target_fault
from uvf.runtime.messages.convert import stamp
from uvf.runtime.messages.joints import positions_of


class JointMover:
    """Leads joints at their own speed; one that has not been told of is not led. Positions are in rad, or m of a prismatic joint."""

    def __init__(self, joints: Mapping[str, MovedJoint]) -> None:
        self._joints = joints
        self._positions: dict[str, float] = {}
        """Where the joints that have been told of are to be now."""
        self._targets: dict[str, float] = {}

    def ask(self, request: MoveJointsRequest, measured: JointStates | None) -> str:
        """Sends joints elsewhere, from where they are led or else from where they are measured. Returns why not; "" when they go."""
        targets = {joint.name: joint.position for joint in request.joints}
        if reason := target_fault(self._joints, targets):
            return reason
        there = positions_of(measured) if measured is not None else {}
        self._positions = {name: there.get(name, 0.0) for name in targets} | self._positions
        self._targets |= targets
        return ""

    def command(self, t: float, dt: float, stands: bool) -> JointStates | None:
        """Their positions ``dt`` [s] later, at ``t`` [s]; None until one has been told of. stands: they stay where they are, for good."""
        if stands:
            self._targets = dict(self._positions)
        for name, target in self._targets.items():
            self._positions[name] = approach(self._positions[name], target, self._joints[name].speed * dt)
        joints = [JointState(name=name, position=position) for name, position in self._positions.items()]
        return JointStates(timestamp=stamp(t), joints=joints) if joints else None
