"""What planner and tracker say to each other, as messages and as the library has it."""

import numpy as np
from numpy.typing import NDArray

from schemas.messages import NavDirective, NavReport, Pose, PosesInFrame, Vector3
from uvf.maths.se2 import Pose2, transform
from uvf.planning.local.controller import Drive
from uvf.planning.navigation.directive import Action, Directive, Report
from uvf.runtime.messages.convert import planar_pose, stamp

Floats = NDArray[np.float64]

ACTIONS = {
    Action.STOP: NavDirective.STOP,
    Action.FOLLOW: NavDirective.FOLLOW,
    Action.SPIN: NavDirective.SPIN,
    Action.BACK_UP: NavDirective.BACK_UP,
}
DRIVES = {
    Drive.DRIVING: NavReport.DRIVING,
    Drive.NO_PATH: NavReport.NO_PATH,
    Drive.NO_VALID_CONTROL: NavReport.NO_VALID_CONTROL,
    Drive.STOPPED: NavReport.STOPPED,
    Drive.ARRIVED: NavReport.ARRIVED,
}
_ACTIONS_SAID = {said: action for action, said in ACTIONS.items()}
_DRIVES_SAID = {said: drive for drive, said in DRIVES.items()}
NOTHING_DONE = Report(-1)


def directive_message(t: float, directive: Directive) -> NavDirective:
    """At ``t`` [s]; the path goes its own way."""
    message = NavDirective(timestamp=stamp(t), number=directive.number, action=ACTIONS[directive.action], amount=directive.amount)
    if directive.until is not None:
        message.until = directive.until
    if directive.clear_beyond is not None:
        message.clear_beyond = directive.clear_beyond
    return message


def directive_of(message: NavDirective) -> Directive:
    """Without a path; an action that is not known means to stop."""
    clear_beyond = message.clear_beyond if message.HasField("clear_beyond") else None
    until = max(message.until, 0.0) if message.HasField("until") else None
    action = _ACTIONS_SAID.get(message.action, Action.STOP)
    return Directive(message.number, action, amount=message.amount, until=until, clear_beyond=clear_beyond)


def report_message(t: float, report: Report) -> NavReport:
    """At ``t`` [s]."""
    number = max(report.number, 0)
    return NavReport(timestamp=stamp(t), number=number, drive=DRIVES[report.how], done=report.done, impossible=report.impossible)


def report_of(message: NavReport | None) -> Report:
    """Of a tracker that says nothing: that nothing is done."""
    if message is None:
        return NOTHING_DONE
    return Report(message.number, _DRIVES_SAID.get(message.drive, Drive.NO_PATH), message.done, message.impossible)


def path_message(t: float, directive: Directive, world_from_map: Pose2) -> PosesInFrame:
    """The path to follow at ``t`` [s], in the world frame, or an empty one.

    Its last pose has an orientation when a heading is wanted there; the others are the line's points.
    """
    message = PosesInFrame(timestamp=stamp(t), frame_id="world")
    if directive.action == Action.FOLLOW:
        message.poses.extend(line_of(world_from_map, directive.path))
        if directive.heading is not None:
            end = message.poses[-1].position
            message.poses[-1].CopyFrom(planar_pose(end.x, end.y, directive.heading + world_from_map[2]))
    return message


def line_of(world_from_map: Pose2, path: Floats) -> list[Pose]:
    """Points (n, 2) [m, map] as poses in the world frame, without a heading."""
    return [Pose(position=Vector3(x=x, y=y)) for x, y in transform(world_from_map, path).tolist()]
