"""Modes and requests in the operator's words."""

from collections.abc import Mapping
from math import atan2, degrees, hypot
from typing import Any

from google.protobuf.message import Message

from schemas.messages import (
    ArmRequest,
    CancelRequest,
    ClockRequest,
    FenceRequest,
    GimbalCommand,
    GoalRequest,
    LaunchRequest,
    MappingRequest,
    MissionRequest,
    Mode,
    ModeRequest,
    PlaceRequest,
    RallyRequest,
    RelocalizeRequest,
    SaveMapRequest,
    SetCurrentRequest,
    Vector3,
    VehicleCommandRequest,
    WindRequest,
)
from uvf.runtime.messages.enum_names import enum_name

GIMBAL_MODES: Mapping[str, Any] = {"Follow": GimbalCommand.FOLLOW, "Lock": GimbalCommand.LOCK, "Body": GimbalCommand.BODY}
"""What a gimbal's angles are relative to, by the page's words."""


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
        case ClockRequest():
            action = enum_name(ClockRequest.Action, request.action)
            return f"simulation rate {request.rate:g}" if request.action == ClockRequest.SET_RATE else f"{action} the simulation"
        case WindRequest():
            return f"wind of {hypot(request.velocity.x, request.velocity.y):.1f} m/s from {bearing_from(request.velocity):03.0f}°"
        case LaunchRequest():
            return f"start mission {request.mission}"
        case SaveMapRequest():
            return f"save the map as {request.name}"
        case PlaceRequest():
            return f"it stands at ({request.pose.position.x:.1f}, {request.pose.position.y:.1f}) m"
        case MappingRequest():
            begins = f"begin another map{f' with {request.method}' if request.method else ''}"
            return {MappingRequest.HOLD: "hold the map", MappingRequest.GO_ON: "go on mapping"}.get(request.action, begins)
        case RelocalizeRequest():
            return "look for it in the whole map"
        case MissionRequest():
            return f"mission of {len(request.mission.items)} items"
        case FenceRequest():
            return f"fence of {len(request.fence.zones)} zones"
        case RallyRequest():
            return f"{len(request.rally.points)} rally points"
        case SetCurrentRequest():
            return f"go on with item {request.index + 1}"
        case VehicleCommandRequest() if request.HasField("home"):
            return f"home at ({request.home.position.x:.1f}, {request.home.position.y:.1f}) m"
    return request.DESCRIPTOR.name


def bearing_from(wind: Vector3) -> float:
    """Where a wind [m/s, world] comes from [deg from north, clockwise]."""
    return degrees(atan2(-wind.x, -wind.y)) % 360


def mode_name(mode: Any) -> str:
    """``MODE_RETURN`` -> ``Return``, an unknown one ``Mode 99``."""
    return enum_name(Mode, mode).capitalize()
