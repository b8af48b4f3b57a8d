"""THE TABLE of the failsafes of a ground vehicle; docs/reference/failsafes.md shows it."""

from dataclasses import dataclass, field

from schemas.messages import Event
from services.autopilot.failsafes import Action, Rule
from services.autopilot.ground.params import GroundAutopilotParams

POSE_LOST = 1.0  # s
OFFBOARD_SILENT = 0.5  # s
TIPPED = 0.5  # s
CALMER = 0.8  # of tilt_max
RECHARGED = 0.03  # of charge, beyond a limit
ACTIONS = {"wait": Action.WARN, "warn": Action.WARN, "hold": Action.HOLD, "return": Action.RETURN, "off": Action.OFF}


@dataclass(frozen=True, slots=True)
class Known:
    """What the rules look at."""

    params: GroundAutopilotParams = field(default_factory=GroundAutopilotParams)
    moves: bool = True
    """Armed, and not in Hold."""
    by_itself: bool = True
    """In Mission or Return: by map and scan."""
    by_hand: bool = False
    silence: float = 0.0  # s since a ground station was heard; 0 while none ever was
    let_go: bool = False
    """It has been driven by hand, and is not any more."""
    unplaced: float = 0.0  # s without a pose, in a mode that needs one
    unsteered: float = 0.0  # s without a command, in Offboard
    unseen: float = 0.0  # s without a new scan
    unmapped: float = 0.0  # s without a word of the mapping
    stuck_for: float = 0.0  # s
    stuck: str = ""  # how
    tilt: float = 0.0  # rad
    charge: float = 1.0  # 0..1
    fence: bool = False
    """It has been stopped before the fence."""


GROUND_RULES: tuple[Rule[Known], ...] = (
    Rule(
        "link",
        wrong=lambda k: k.moves and k.silence > k.params.link_timeout,
        mended=lambda k: k.silence <= k.params.link_timeout,
        begins="ground station lost",
        ends="ground station back",
        figures=lambda k: f"silent for {k.silence:.0f} s",
        action=lambda k: ACTIONS[k.params.link_action],
        parameters=("link_timeout", "link_action"),
    ),
    Rule(
        "sticks",
        wrong=lambda k: k.moves and k.let_go and k.params.stick_action != "wait",
        mended=lambda k: not k.let_go,
        begins="manual control lost",
        ends="manual control back, or another mode",
        figures=lambda k: f"no command for {k.params.stick_timeout:g} s",
        action=lambda k: ACTIONS[k.params.stick_action],
        parameters=("stick_timeout", "stick_action"),
    ),
    Rule(
        "pose",
        wrong=lambda k: k.moves and k.unplaced > POSE_LOST,
        mended=lambda k: k.unplaced == 0.0,
        begins="position lost: stands",
        ends="position back",
        figures=lambda k: f"no pose for {k.unplaced:.1f} s",
        clears=1.0,
        severity=Event.CRITICAL,
    ),
    Rule(
        "scan",
        wrong=lambda k: k.moves and k.by_itself and k.unseen > k.params.scan_timeout,
        mended=lambda k: k.unseen <= k.params.scan_timeout,
        begins="lidar silent or frozen: stands",
        ends="lidar back",
        figures=lambda k: f"no new scan for {k.unseen:.1f} s",
        severity=Event.CRITICAL,
        parameters=("scan_timeout",),
    ),
    Rule(
        "map",
        wrong=lambda k: k.moves and k.by_itself and k.unmapped > k.params.map_timeout,
        mended=lambda k: k.unmapped <= k.params.map_timeout,
        begins="map no longer kept: stands",
        ends="map kept again",
        figures=lambda k: f"mapping silent for {k.unmapped:.0f} s",
        severity=Event.CRITICAL,
        parameters=("map_timeout",),
    ),
    Rule(
        "offboard",
        wrong=lambda k: k.moves and k.unsteered > OFFBOARD_SILENT,
        mended=lambda k: k.unsteered == 0.0,
        begins="no setpoint from outside",
        ends="setpoints no longer missed",
        figures=lambda k: f"silent for {k.unsteered:.1f} s",
        action=lambda k: Action.HOLD,
    ),
    Rule(
        "fence",
        wrong=lambda k: k.fence,
        mended=lambda k: not k.fence,
        begins="fence ahead: stopped",
        ends="clear of the fence",
        figures=lambda k: "it may drive where that leads away",
        action=lambda k: ACTIONS[k.params.fence_action],
        parameters=("max_distance", "fence_action"),
        clears=1.0,
    ),
    Rule(
        "stuck",
        wrong=lambda k: k.moves and k.stuck_for > k.params.stuck_time,
        mended=lambda k: k.stuck_for == 0.0,
        begins="stuck",
        ends="no longer stuck, or to try again",
        figures=lambda k: f"{k.stuck} for {k.stuck_for:.0f} s",
        action=lambda k: Action.WARN if k.by_hand else Action.STAND,
        parameters=("stuck_time",),
    ),
    Rule(
        "tipped",
        wrong=lambda k: k.tilt > k.params.tilt_max,
        mended=lambda k: k.tilt < CALMER * k.params.tilt_max,
        begins="tipped: motors off",
        ends="upright again",
        figures=lambda k: f"{k.tilt:.1f} rad from upright",
        action=lambda k: Action.OFF,
        after=lambda k: TIPPED,
        clears=1.0,
        severity=Event.CRITICAL,
        parameters=("tilt_max",),
    ),
    Rule(
        "battery_low",
        wrong=lambda k: k.charge < k.params.battery_low,
        mended=lambda k: k.charge > k.params.battery_low + RECHARGED,
        begins="battery low",
        ends="battery no longer low",
        figures=lambda k: f"{100 * k.charge:.0f} % left",
        action=lambda k: ACTIONS[k.params.low_action],
        after=lambda k: 3.0,
        clears=3.0,
        parameters=("battery_low", "low_action"),
    ),
    Rule(
        "battery_critical",
        wrong=lambda k: k.charge < k.params.battery_critical,
        mended=lambda k: k.charge > k.params.battery_critical + RECHARGED,
        begins="battery critical",
        ends="battery no longer critical",
        figures=lambda k: f"{100 * k.charge:.0f} % left",
        action=lambda k: ACTIONS[k.params.critical_action],
        after=lambda k: 3.0,
        clears=3.0,
        severity=Event.CRITICAL,
        parameters=("battery_critical", "critical_action"),
    ),
    Rule(
        "battery_emergency",
        wrong=lambda k: k.charge < k.params.emergency_charge,
        mended=lambda k: k.charge > k.params.emergency_charge + RECHARGED,
        begins="battery emergency",
        ends="battery emergency over",
        figures=lambda k: f"{100 * k.charge:.0f} % left",
        action=lambda k: ACTIONS[k.params.emergency_action],
        after=lambda k: 3.0,
        clears=3.0,
        severity=Event.CRITICAL,
        parameters=("emergency_charge", "emergency_action"),
    ),
)
STANDS = ("scan", "map")
"""Rows during which nothing drives by itself."""
