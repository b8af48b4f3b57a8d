"""Commands, frames and the like by the names that people know them by."""

from uvf.mavlink import dialect as mav


def command_name(number: int) -> str:
    """Name of a command: ``DO_REPOSITION``, or ``command 44999`` for a number without a name."""
    return enum_name("MAV_CMD", number) or f"command {number}"


def frame_name(number: int) -> str:
    """Name of a frame: ``frame GLOBAL_TERRAIN_ALT``, or ``frame 99`` for a number without a name."""
    return f"frame {enum_name('MAV_FRAME', number) or number}"


def bad_frame(number: int) -> str:
    """Text why a place in a frame is refused."""
    return f"{frame_name(number)} is not supported: choose an altitude above home or above sea level"


def enum_name(enum: str, number: int) -> str:
    """Name of an enum's entry, e.g. ``GLOBAL_TERRAIN_ALT`` of MAV_FRAME; empty for a number without a name."""
    entry = mav.enums[enum].get(number)
    return entry.name.removeprefix(f"{enum}_") if entry is not None else ""
