"""THE TABLE of the failsafes of a ground vehicle; docs/failsafes.md shows it."""

from dataclasses import dataclass

from schemas.messages import Event
from services.autopilot.failsafes import Action, Rule

POSE_LOST = 1.0  # s
OFFBOARD_SILENT = 0.5  # s


@dataclass(frozen=True, slots=True)
class Known:
    """What the rules look at."""

    link_timeout: float = 5.0  # s
    moves: bool = True
    """Armed, and not in Hold."""
    silence: float = 0.0  # s since a ground station was heard; 0 while none ever was
    unplaced: float = 0.0  # s without a pose, in a mode that needs one
    unsteered: float = 0.0  # s without a command, in Offboard
    fence: bool = False
    """It has been stopped before the fence."""


GROUND_RULES: tuple[Rule[Known], ...] = (
    Rule(
        "link",
        wrong=lambda k: k.moves and k.silence > k.link_timeout,
        mended=lambda k: k.silence <= k.link_timeout,
        begins="ground station lost",
        ends="ground station back",
        figures=lambda k: f"silent for {k.silence:.0f} s",
        action=lambda k: Action.HOLD,
        parameters=("link_timeout",),
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
        clears=1.0,
    ),
)
