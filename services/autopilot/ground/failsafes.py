"""THE TABLE of the failsafes of a ground vehicle; docs/reference/failsafes.md shows it."""

from dataclasses import dataclass, field

from schemas.messages import Event
from services.autopilot.failsafes import FailsafeAction, FailsafeRule
from services.autopilot.ground.params import GroundAutopilotParams

POSE_LOST = 1.0  # s
OFFBOARD_SILENT = 0.5  # s
TIPPED = 0.5  # s
GIVES_UP = 30.0  # s stuck, after which whoever drives by itself is believed not to get free
CALMER = 0.8  # of tilt_max
RECHARGED = 0.03  # of charge, beyond a limit
ACTIONS = {
    "wait": FailsafeAction.WARN,
    "warn": FailsafeAction.WARN,
    "hold": FailsafeAction.HOLD,
    "return": FailsafeAction.RETURN,
    "off": FailsafeAction.OFF,
}


@dataclass(frozen=True, slots=True)
class GroundFailsafeInputs:
    """The values that the failsafe rules of a ground vehicle are evaluated on."""

    params: GroundAutopilotParams = field(default_factory=GroundAutopilotParams)
    moves: bool = True
    """Armed, and not in Hold."""
    by_itself: bool = True
    """In Mission or Return: by map and scan."""
    by_hand: bool = False
    silence: float = 0.0  # s since a ground station was heard; 0 while none ever was
    stick_released: bool = False
    """It has been driven by hand, and is not any more."""
    pose_age: float = 0.0  # s without a pose, in a mode that needs one
    setpoint_age: float = 0.0  # s without a command, in Offboard
    unseen: float = 0.0  # s without a new scan
    map_age: float = 0.0  # s without a word of the mapping
    stuck_for: float = 0.0  # s
    stuck: str = ""  # how
    tilt: float = 0.0  # rad
    charge: float = 1.0  # 0..1
    fence: bool = False
    """It has been stopped before the fence."""
    edge: bool = False
    """It has been stopped before an edge."""


GROUND_RULES: tuple[FailsafeRule[GroundFailsafeInputs], ...] = (
    FailsafeRule(
        "link",
        trigger=lambda k: k.moves and k.silence > k.params.link_timeout,
        clear=lambda k: k.silence <= k.params.link_timeout,
        raised_text="ground station lost",
        cleared_text="ground station back",
        detail=lambda k: f"silent for {k.silence:.0f} s",
        action=lambda k: ACTIONS[k.params.link_action],
        parameters=("link_timeout", "link_action"),
    ),
    FailsafeRule(
        "sticks",
        trigger=lambda k: k.moves and k.stick_released and k.params.stick_action != "wait",
        clear=lambda k: not k.stick_released,
        raised_text="manual control lost",
        cleared_text="manual control back, or another mode",
        detail=lambda k: f"no command for {k.params.stick_timeout:g} s",
        action=lambda k: ACTIONS[k.params.stick_action],
        parameters=("stick_timeout", "stick_action"),
    ),
    FailsafeRule(
        "pose",
        trigger=lambda k: k.moves and k.pose_age > POSE_LOST,
        clear=lambda k: k.pose_age == 0.0,
        raised_text="position lost: stands",
        cleared_text="position back",
        detail=lambda k: f"no pose for {k.pose_age:.1f} s",
        clear_delay=1.0,
        severity=Event.CRITICAL,
    ),
    FailsafeRule(
        "scan",
        trigger=lambda k: k.moves and k.by_itself and k.unseen > k.params.scan_timeout,
        clear=lambda k: k.unseen <= k.params.scan_timeout,
        raised_text="lidar silent or frozen: stands",
        cleared_text="lidar back",
        detail=lambda k: f"no new scan for {k.unseen:.1f} s",
        severity=Event.CRITICAL,
        parameters=("scan_timeout",),
    ),
    FailsafeRule(
        "map",
        trigger=lambda k: k.moves and k.by_itself and k.map_age > k.params.map_timeout,
        clear=lambda k: k.map_age <= k.params.map_timeout,
        raised_text="map no longer kept: stands",
        cleared_text="map kept again",
        detail=lambda k: f"mapping silent for {k.map_age:.0f} s",
        severity=Event.CRITICAL,
        parameters=("map_timeout",),
    ),
    FailsafeRule(
        "offboard",
        trigger=lambda k: k.moves and k.setpoint_age > OFFBOARD_SILENT,
        clear=lambda k: k.setpoint_age == 0.0,
        raised_text="no setpoint from outside",
        cleared_text="setpoints no longer missed",
        detail=lambda k: f"silent for {k.setpoint_age:.1f} s",
        action=lambda k: FailsafeAction.HOLD,
    ),
    FailsafeRule(
        "fence",
        trigger=lambda k: k.fence,
        clear=lambda k: not k.fence,
        raised_text="fence ahead: stopped",
        cleared_text="clear of the fence",
        detail=lambda k: "it may drive where that leads away",
        action=lambda k: ACTIONS[k.params.fence_action],
        parameters=("max_distance", "fence_action"),
        clear_delay=1.0,
    ),
    FailsafeRule(
        "edge",
        trigger=lambda k: k.edge,
        clear=lambda k: not k.edge,
        raised_text="no floor ahead: stopped",
        cleared_text="floor ahead again",
        detail=lambda k: "a range finder that looks down sees none; it may drive away from there",
        action=lambda k: FailsafeAction.WARN,
        clear_delay=1.0,
    ),
    FailsafeRule(
        "stuck",
        trigger=lambda k: k.moves and k.stuck_for > k.params.stuck_time,
        clear=lambda k: k.stuck_for == 0.0,
        raised_text="stuck",
        cleared_text="no longer stuck, or to try again",
        detail=lambda k: f"{k.stuck} for {k.stuck_for:.0f} s",
        action=lambda k: FailsafeAction.WARN if k.by_hand or (k.by_itself and k.stuck_for < GIVES_UP) else FailsafeAction.STAND,
        parameters=("stuck_time",),
    ),
    FailsafeRule(
        "tipped",
        trigger=lambda k: k.tilt > k.params.tilt_max,
        clear=lambda k: k.tilt < CALMER * k.params.tilt_max,
        raised_text="tipped: motors off",
        cleared_text="upright again",
        detail=lambda k: f"{k.tilt:.1f} rad from upright",
        action=lambda k: FailsafeAction.OFF,
        after=lambda k: TIPPED,
        clear_delay=1.0,
        severity=Event.CRITICAL,
        parameters=("tilt_max",),
    ),
    FailsafeRule(
        "battery_low",
        trigger=lambda k: k.charge < k.params.battery_low,
        clear=lambda k: k.charge > k.params.battery_low + RECHARGED,
        raised_text="battery low",
        cleared_text="battery no longer low",
        detail=lambda k: f"{100 * k.charge:.0f} % left",
        action=lambda k: ACTIONS[k.params.low_action],
        after=lambda k: 3.0,
        clear_delay=3.0,
        parameters=("battery_low", "low_action"),
    ),
    FailsafeRule(
        "battery_critical",
        trigger=lambda k: k.charge < k.params.battery_critical,
        clear=lambda k: k.charge > k.params.battery_critical + RECHARGED,
        raised_text="battery critical",
        cleared_text="battery no longer critical",
        detail=lambda k: f"{100 * k.charge:.0f} % left",
        action=lambda k: ACTIONS[k.params.critical_action],
        after=lambda k: 3.0,
        clear_delay=3.0,
        severity=Event.CRITICAL,
        parameters=("battery_critical", "critical_action"),
    ),
    FailsafeRule(
        "battery_emergency",
        trigger=lambda k: k.charge < k.params.emergency_charge,
        clear=lambda k: k.charge > k.params.emergency_charge + RECHARGED,
        raised_text="battery emergency",
        cleared_text="battery emergency over",
        detail=lambda k: f"{100 * k.charge:.0f} % left",
        action=lambda k: ACTIONS[k.params.emergency_action],
        after=lambda k: 3.0,
        clear_delay=3.0,
        severity=Event.CRITICAL,
        parameters=("emergency_charge", "emergency_action"),
    ),
)
STANDS = ("scan", "map")
"""Rows during which nothing drives by itself."""
