"""Modes and requests in the operator's words."""

from collections.abc import Mapping
from typing import Any

from google.protobuf.message import Message

from schemas.messages import ArmRequest, CancelRequest, GoalRequest, Mode, ModeRequest
from services.gcs.state.state import VehicleModel
from uvf.runtime.messages.enum_names import enum_name

MODES: Mapping[str, Mapping[str, Any]] = {
    "ground": {"Hold": Mode.MODE_HOLD, "Mission": Mode.MODE_MISSION, "Manual": Mode.MODE_MANUAL},
    "fixed_wing": {"Hold": Mode.MODE_HOLD, "Mission": Mode.MODE_MISSION, "Return": Mode.MODE_RETURN, "Manual": Mode.MODE_MANUAL},
}
FOLLOWER: Mapping[str, Any] = {"Hold": Mode.MODE_HOLD, "Follow leader": Mode.MODE_FOLLOW, **MODES["fixed_wing"]}
"""Of an aircraft that the mission gives a leader."""


def describe(request: Message) -> str:
    """A request in words for the operator."""
    match request:
        case GoalRequest():
            return f"go to ({request.position.x:.1f}, {request.position.y:.1f}) m"
        case ModeRequest():
            return f"mode {mode_name(request.mode)}"
        case ArmRequest():
            return "arm" if request.arm else "disarm"
        case CancelRequest():
            return "cancel the goal"
    return request.DESCRIPTOR.name


def mode_name(mode: Any) -> str:
    """``MODE_RETURN`` -> ``Return``, an unknown one ``Mode 99``."""
    return enum_name(Mode, mode).capitalize()


def modes_of(vehicle: VehicleModel) -> Mapping[str, Any]:
    """The modes that a vehicle offers, by the labels of their buttons."""
    return FOLLOWER if vehicle.leader else MODES[vehicle.member.file.kind]
