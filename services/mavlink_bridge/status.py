"""How an autopilot is, as the system's status: from its heartbeat and what it tells beside; what is unknown is said to be."""

import math
from dataclasses import dataclass

from schemas.messages import Breach, Kind, MissionProgress, Mode, VehicleStatus
from services.mavlink_bridge.connection import Wire
from services.mavlink_bridge.frame import Chart
from services.mavlink_bridge.limits import is_sound
from services.mavlink_bridge.modes import Modes
from services.mavlink_bridge.telemetry import FRESH, Telemetry
from uvf.mavlink import dialect as mav

KIND = {mav.MAV_TYPE_FIXED_WING: Kind.KIND_FIXED_WING, mav.MAV_TYPE_GROUND_ROVER: Kind.KIND_GROUND} | dict.fromkeys(
    range(mav.MAV_TYPE_VTOL_TAILSITTER_DUOROTOR, mav.MAV_TYPE_VTOL_TILTWING + 1), Kind.KIND_FIXED_WING
)
TROUBLE = {
    mav.MAV_STATE_CRITICAL: "the autopilot reports a critical state",
    mav.MAV_STATE_EMERGENCY: "the autopilot reports an emergency",
    mav.MAV_STATE_FLIGHT_TERMINATION: "the autopilot has terminated the flight",
}
PREARM = mav.MAV_SYS_STATUS_PREARM_CHECK
NOT_TOLD = 0xFFFF
STATES = {
    mav.MISSION_STATE_NOT_STARTED: MissionProgress.NOT_STARTED,
    mav.MISSION_STATE_ACTIVE: MissionProgress.ACTIVE,
    mav.MISSION_STATE_PAUSED: MissionProgress.PAUSED,
    mav.MISSION_STATE_COMPLETE: MissionProgress.COMPLETE,
}


@dataclass
class Told:
    """What an autopilot has told, from which its status is made."""

    wire: Wire
    telemetry: Telemetry
    modes: Modes
    heartbeat: mav.MAVLink_heartbeat_message

    @property
    def kind(self) -> Kind:
        """Kind of the vehicle; KIND_UNSPECIFIED for a type without a counterpart."""
        return KIND.get(self.heartbeat.type, Kind.KIND_UNSPECIFIED)

    @property
    def mode(self) -> Mode:
        """Mode that the autopilot is in."""
        return self.modes.mode_of(self.heartbeat.custom_mode)

    @property
    def armed(self) -> bool:
        """Whether it is armed."""
        return bool(self.heartbeat.base_mode & mav.MAV_MODE_FLAG_SAFETY_ARMED)

    @property
    def landed(self) -> bool:
        """Whether it stands on the ground; an autopilot that does not say so stands while it is disarmed, a ground vehicle always."""
        state = self.telemetry.newest(mav.MAVLINK_MSG_ID_EXTENDED_SYS_STATE)
        if self.kind == Kind.KIND_GROUND:
            return True
        if state is None or state.landed_state == mav.MAV_LANDED_STATE_UNDEFINED:
            return not self.armed
        return bool(state.landed_state == mav.MAV_LANDED_STATE_ON_GROUND)


def status_of(told: Told, chart: Chart | None, first: int) -> VehicleStatus:
    """The status as a message; first: number of the wire item where the mission begins. Without a chart it has no positions."""
    telemetry = told.telemetry
    volts, _, remaining = telemetry.charge()
    status = VehicleStatus(
        kind=told.kind,
        mode=told.mode,
        armed=told.armed,
        landed=told.landed,
        command_source="autopilot",
        reason=f"mode {told.modes.name_of(told.heartbeat.custom_mode)}",
        battery_remaining=remaining,
        battery_voltage=0.0 if math.isnan(volts) else volts,
        system_id=told.wire.system,
        prearm=_prearm(told),
    )
    if told.heartbeat.system_status in TROUBLE:
        status.failsafes.append(TROUBLE[told.heartbeat.system_status])
    _steering(status, telemetry, first)
    if chart is not None:
        if telemetry.home is not None:
            status.home.CopyFrom(chart.world(*telemetry.home))
        if (circle := telemetry.circle(chart)) is not None:
            status.circle.CopyFrom(circle)
    return status


def _steering(status: VehicleStatus, telemetry: Telemetry, first: int) -> None:
    hud = telemetry.newest(mav.MAVLINK_MSG_ID_VFR_HUD, FRESH)
    if hud is not None:
        status.throttle = min(hud.throttle * 0.01, 1.0)
    steers = telemetry.newest(mav.MAVLINK_MSG_ID_NAV_CONTROLLER_OUTPUT, FRESH)
    if steers is not None and is_sound(steers.xtrack_error, steers.alt_error):
        status.cross_track, status.altitude_error = steers.xtrack_error, -steers.alt_error
        status.distance_to_waypoint = steers.wp_dist
    current = telemetry.newest(mav.MAVLINK_MSG_ID_MISSION_CURRENT)
    if current is not None and current.seq != NOT_TOLD:
        status.waypoint = max(current.seq - first, 0)
    fence = telemetry.newest(mav.MAVLINK_MSG_ID_FENCE_STATUS)
    if fence is not None:
        status.breach = fence.breach_type if fence.breach_status and fence.breach_type in Breach.values() else Breach.BREACH_NONE
        status.breaches = fence.breach_count


def _prearm(told: Told) -> list[str]:
    """The autopilot's own words, as far as it has said them."""
    status = told.telemetry.newest(mav.MAVLINK_MSG_ID_SYS_STATUS)
    if status is None or not status.onboard_control_sensors_enabled & PREARM or status.onboard_control_sensors_health & PREARM:
        return []
    said = [text.text for text in told.wire.texts if text.text.lower().startswith(("prearm", "preflight"))]
    return list(dict.fromkeys(said)) or ["the autopilot's checks before arming fail"]


def progress_of(told: Told, items: int, mission_id: int, first: int, reached: int) -> MissionProgress | None:
    """The mission's progress as a message; None until the autopilot has told it.

    first: number of the wire item where the mission begins; reached: that of the last item reached, -1 = none.
    """
    current = told.telemetry.newest(mav.MAVLINK_MSG_ID_MISSION_CURRENT)
    if current is None:
        return None
    at = min(max(current.seq - first, 0), items) if current.seq != NOT_TOLD else 0
    return MissionProgress(
        state=_state(told, current.mission_state, items, at),
        current=at,
        total=items,
        reached=min(max(reached - first, -1), items - 1) if reached >= 0 else -1,
        mission_id=mission_id,
    )


def _state(told: Told, wire_state: int, items: int, at: int) -> MissionProgress.State:
    """An autopilot that does not tell it is judged by its mode."""
    if items == 0:
        return MissionProgress.NO_MISSION
    if wire_state in STATES:
        return STATES[wire_state]
    if told.mode == Mode.MODE_MISSION and told.armed:
        return MissionProgress.ACTIVE
    return MissionProgress.PAUSED if at > 0 else MissionProgress.NOT_STARTED
