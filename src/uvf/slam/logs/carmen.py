"""CARMEN logs (.clf, .log): FLASER, ROBOTLASER1, ODOM and PARAM lines -> a LaserLog.

What is known of these files, and breaks a run or a score in silence when it is not heeded:

- The order is the file's, unless the odometry says otherwise (time_order); stamps may fall, and single ones may be garbled.
- The stamp is the ipc one, the third word from the end; relations between robot poses are keyed by it.
- The pose is the robot's: the second triple of a line. The first is the laser's, in corrected logs the corrected one.
- Where the laser sits is said by PARAM robot_frontlaser_offset, _side_offset and _angular_offset, and by ROBOTLASER1 itself.
  CARMEN's drivers turn the beams of a laser that hangs upside down (PARAM laserN_flipped) before they are logged.
- FLASER does not say where its beams point: an even number of beams leaves out the last one of the half circle.
- What is at the largest range is no return (no_return).
- Odometry may begin anywhere: here it begins at zero.
"""

from collections.abc import Sequence
from math import pi, radians
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from uvf.maths.se2 import Pose2
from uvf.maths.se2_arrays import composed, inverted
from uvf.models.yaml_data import BadInput
from uvf.slam.logs.carmen_lines import LaserFan, LaserRecord, Lines, read_lines
from uvf.slam.logs.jumps import without_jumps
from uvf.slam.logs.laser_log import LaserLog, OdometryTrack
from uvf.slam.logs.no_return import farthest_return
from uvf.slam.logs.time_order import clock_resets, garbled, mended, rising, taking_order
from uvf.slam.reading import Beams, Reading

Floats = NDArray[np.float64]

LONG_GAP = 60.0
"""s without a sweep that are worth a note."""
MOUNT_SPREAD = 0.01
"""m and rad: largest standard deviation of the laser's place on the robot, if it is to be believed."""
LARGEST_ROBOT = 100.0
"""m: a laser is not mounted farther away than this."""
VIEWS = {180: 180.0, 181: 180.0, 360: 180.0, 361: 180.0, 721: 180.0, 540: 270.0, 541: 270.0, 1080: 270.0, 1081: 270.0}
"""deg that so many beams of a usual lidar look over."""
USUAL_RANGES = 100.0
"""m: the indoor lidars of such logs do not see farther."""


def read_carmen(path: str | Path) -> LaserLog:
    """Log of a CARMEN file. Lines that cannot be read are left out and counted in the notes. Raises BadInput for one without sweeps."""
    path = Path(path)
    try:
        with path.open(encoding="ascii", errors="replace") as file:
            lines = read_lines(file)
    except OSError as error:
        raise BadInput(f"log {path}: {error.strerror}") from error
    if not lines.sweeps:
        raise BadInput(f"log {path}: {_why_nothing(path, lines)}")
    return _assembled(path, lines)


def _why_nothing(path: Path, lines: Lines) -> str:
    if path.stat().st_size == 0:
        return "is empty"
    if lines.faults:
        return f"no scan can be read: {'; '.join(_faults(lines))}"
    return "no FLASER or ROBOTLASER1 line in it: not a CARMEN log with laser and odometry"


def _faults(lines: Lines) -> list[str]:
    return [f"{len(n)} lines with {reason} (first: line {n[0]})" for reason, n in lines.faults.items()]


def _assembled(path: Path, lines: Lines) -> LaserLog:
    stamps = np.array([s.stamp for s in lines.sweeps])
    poses = np.array([s.odom_from_base for s in lines.sweeps])
    order = taking_order(stamps, poses)
    stamps, sweeps = stamps[order], [lines.sweeps[i] for i in order]
    times = rising(mended(stamps))
    poses, leapt = without_jumps(times, poses[order])
    start = inverted(poses[0])
    readings = [
        Reading(t, sweep.ranges, shape, Pose2(*pose))
        for t, sweep, shape, pose in zip(
            times.tolist(), sweeps, _beams(path, sweeps, lines.params), composed(start, poses).tolist(), strict=True
        )
    ]
    notes = [f"left out {'; '.join(_faults(lines))}"] if lines.faults else []
    notes += _notes_on_order(order, stamps) + _notes_on_time(stamps) + _notes_on_beams(lines, readings)
    if len(leapt):
        notes.append(f"the odometry leaps {len(leapt)} times (first at stamp {stamps[leapt[0]]:.6f}): taken for standing still")
    if len(readings) > 1 and not np.ptp(poses, axis=0).any():
        notes.append("the odometry never moves: a method that needs it finds no way")
    return LaserLog(path.stem, readings, stamps, _track(lines, stamps, start), tuple(f"log {path}: {note}" for note in notes))


def _track(lines: Lines, stamps: Floats, start: Floats) -> OdometryTrack | None:
    """None where there is none, and where the clock was set: how its times and those of the sweeps then go together is not known."""
    if not lines.odometry:
        return None
    table = np.array(lines.odometry)
    table = table[taking_order(table[:, 0], table[:, 1:])]
    told = mended(table[:, 0])
    if len(clock_resets(told)) or len(clock_resets(mended(stamps))):
        return None
    times = rising(told)
    return OdometryTrack(times, composed(start, without_jumps(times, table[:, 1:])[0]))


def _notes_on_order(order: NDArray[np.int64], stamps: Floats) -> list[str]:
    if (np.diff(order) < 0).any():
        return ["lines out of order: put into the order of their stamps, in which the odometry is shorter"]
    if backwards := int((np.diff(mended(stamps)) < 0.0).sum()):
        return [f"{backwards} stamps fall: read in the order of the file, in which the odometry is shorter"]
    return []


def _notes_on_time(stamps: Floats) -> list[str]:
    notes, told = [], mended(stamps)
    if len(wrong := garbled(stamps)):
        notes.append(f"{len(wrong)} stamps are far from those before and after (first: {stamps[wrong[0]]:g}): taken to be in the middle")
    if len(resets := clock_resets(told)):
        notes.append(f"the clock is set back {len(resets)} times (first at stamp {stamps[resets[0]]:.6f})")
    if len(gaps := np.flatnonzero(np.diff(told) > LONG_GAP)):
        longest = gaps[np.diff(told)[gaps].argmax()]
        notes.append(f"no scan for more than {LONG_GAP:g} s {len(gaps)} times (longest after stamp {stamps[longest]:.6f})")
    return notes


def _notes_on_beams(lines: Lines, readings: Sequence[Reading]) -> list[str]:
    guessed = {len(s.ranges) for s in lines.sweeps if s.fan is None} - VIEWS.keys()
    counts = [str(n) for n in sorted(guessed) if _fan_of_params(n, lines.params) is None]
    notes = [f"no lidar is known of {', '.join(counts)} beams: taken for half a circle"] if counts else []
    seen = np.concatenate([r.ranges[r.returned] for r in readings])
    if not len(seen):
        notes.append("no beam comes back from anything: there is nothing to map")
    elif np.median(seen) > USUAL_RANGES:
        notes.append(f"half of the ranges are longer than {np.median(seen):.0f} m; CARMEN's are in metres")
    return notes


def _beams(path: Path, sweeps: Sequence[LaserRecord], params: dict[str, str]) -> list[Beams]:
    """For each sweep; equal ones are one object."""
    range_max = _number(params, "robot_front_laser_max", 0.0)
    farthest = min(farthest_return([s.ranges for s in sweeps]), range_max if range_max > 0.0 else np.inf)
    base_from_laser = _mount(sweeps, params)
    x, y, yaw = base_from_laser
    if not (max(abs(x), abs(y)) < LARGEST_ROBOT and abs(yaw) <= 2 * pi):
        raise BadInput(f"log {path}: the laser is said to sit at ({x:g}, {y:g}) m, {yaw:g} rad; mend PARAM robot_frontlaser_...offset")
    known: dict[tuple[int, LaserFan | None], Beams] = {}
    for sweep in sweeps:
        key = (len(sweep.ranges), sweep.fan)
        if key not in known:
            fan = sweep.fan or _half_circle(key[0], params)
            bearings = base_from_laser[2] + fan.start + fan.step * np.arange(key[0], dtype=np.float64)
            limit = min(farthest, fan.range_max if fan.range_max > 0.0 else np.inf)
            known[key] = Beams((base_from_laser[0], base_from_laser[1]), bearings, 0.0, limit)
    return [known[len(sweep.ranges), sweep.fan] for sweep in sweeps]


def _half_circle(n: int, params: dict[str, str]) -> LaserFan:
    """The fan of a FLASER line: by the parameters where they fit, else that of a usual lidar with ``n`` beams, else 180 deg.

    An even number of beams ends a step before the end of the view; an odd one reaches it.
    """
    view, step = _fan_of_params(n, params) or ((view := VIEWS.get(n, 180.0)), view / (n - n % 2))
    return LaserFan(-radians(view) / 2, radians(step), np.inf)


def _fan_of_params(n: int, params: dict[str, str]) -> tuple[float, float] | None:
    """View and step [deg] by PARAM laserN_fov and laserN_resolution, where they fit ``n`` beams."""
    front = params.get("robot_frontlaser_id", "1")
    view, step = (_number(params, f"laser_laser{front}_{what}", 0.0) for what in ("fov", "resolution"))
    return (view, step) if step > 0.0 and abs(view / step - n) <= 1.01 else None


def _mount(sweeps: Sequence[LaserRecord], params: dict[str, str]) -> tuple[float, float, float]:
    """base_from_laser (x, y, yaw): between the two poses of ROBOTLASER1 lines if that stays the same, else by the PARAM lines."""
    pairs = [(s.odom_from_base, s.odom_from_laser) for s in sweeps if s.odom_from_laser is not None]
    if pairs:
        base, laser = np.array(pairs).transpose(1, 0, 2)
        seen = composed(inverted(base), laser)
        spread = composed(inverted(seen[0]), seen)
        if (spread.std(axis=0) < MOUNT_SPREAD).all():
            x, y, yaw = composed(seen[0], np.median(spread, axis=0)).tolist()
            return x, y, yaw
    forward, side, turn = (_number(params, f"robot_frontlaser_{what}offset", 0.0) for what in ("", "side_", "angular_"))
    return forward, side, turn if abs(turn) <= 2 * pi else radians(turn)  # written by hand, it may be in degrees


def _number(params: dict[str, str], key: str, otherwise: float) -> float:
    try:
        value = float(params.get(key, otherwise))
    except ValueError:
        return otherwise
    return value if np.isfinite(value) else otherwise
