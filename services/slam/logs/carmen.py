"""CARMEN logs (.clf, .log): FLASER, ROBOTLASER1, ODOM and PARAM lines -> a LaserLog.

What is known of these files, and breaks a run or a score in silence when it is not heeded:

- The order is the file's, unless the odometry says otherwise (time_order); stamps may fall.
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

from services.slam.logs.carmen_lines import Fan, Lines, Sweep, read_lines
from services.slam.logs.laser_log import LaserLog, OdometryTrack
from services.slam.logs.leaps import leaps, without_leaps
from services.slam.logs.no_return import farthest_return
from services.slam.logs.time_order import clock_resets, rising, taking_order
from services.slam.reading import Beams, Reading
from uvf.maths.planar import Pose2
from uvf.maths.planar_arrays import composed, inverted
from uvf.runtime.params import BadInput

Floats = NDArray[np.float64]

LONG_GAP = 60.0
"""s without a sweep that are worth a note."""
MOUNT_SPREAD = 0.01
"""m and rad: largest standard deviation of the laser's place on the robot, if it is to be believed."""


def read_carmen(path: Path) -> LaserLog:
    """Lines that cannot be read are left out, counted and told in the notes. Raises BadInput for a file without a usable sweep."""
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
        return f"no sweep can be read: {'; '.join(_faults(lines))}"
    return "no FLASER or ROBOTLASER1 line in it: not a CARMEN log with laser and odometry"


def _faults(lines: Lines) -> list[str]:
    return [f"{len(n)} lines with {reason} (first: line {n[0]})" for reason, n in lines.faults.items()]


def _assembled(path: Path, lines: Lines) -> LaserLog:
    stamps = np.array([s.stamp for s in lines.sweeps])
    poses = np.array([s.odom_from_base for s in lines.sweeps])
    order = taking_order(stamps, poses)
    stamps, poses = stamps[order], poses[order]
    sweeps = [lines.sweeps[i] for i in order]
    times, start = rising(stamps), inverted(poses[0])
    notes = _notes(path, lines, order, stamps, poses)
    beams = _beams(sweeps, lines.params)
    odom_from_base = composed(start, without_leaps(stamps, poses))
    readings = [
        Reading(t, sweep.ranges, shape, Pose2(*pose))
        for t, sweep, shape, pose in zip(times.tolist(), sweeps, beams, odom_from_base.tolist(), strict=True)
    ]
    return LaserLog(path.stem, readings, stamps, _track(lines, start), notes)


def _track(lines: Lines, start: Floats) -> OdometryTrack | None:
    if not lines.odometry:
        return None
    table = np.array(lines.odometry)
    table = table[taking_order(table[:, 0], table[:, 1:])]
    return OdometryTrack(rising(table[:, 0]), composed(start, without_leaps(table[:, 0], table[:, 1:])))


def _notes(path: Path, lines: Lines, order: NDArray[np.int64], stamps: Floats, poses: Floats) -> tuple[str, ...]:
    notes = [f"left out {'; '.join(_faults(lines))}"] if lines.faults else []
    if (np.diff(order) < 0).any():
        notes.append("lines out of order: put into the order of their stamps, in which the odometry is shorter")
    elif backwards := int((np.diff(stamps) < 0.0).sum()):
        notes.append(f"{backwards} stamps fall: read in the order of the file, in which the odometry is shorter")
    if len(resets := clock_resets(stamps)):
        notes.append(f"the clock is set back {len(resets)} times (first at stamp {stamps[resets[0]]:.6f})")
    if len(gaps := np.flatnonzero(np.diff(stamps) > LONG_GAP)):
        longest = gaps[np.diff(stamps)[gaps].argmax()]
        notes.append(f"no sweep for more than {LONG_GAP:g} s {len(gaps)} times (longest after stamp {stamps[longest]:.6f})")
    if len(leapt := leaps(stamps, poses)):
        notes.append(f"the odometry leaps {len(leapt)} times (first at stamp {stamps[leapt[0]]:.6f}): taken for standing still")
    return tuple(f"log {path}: {note}" for note in notes)


def _beams(sweeps: Sequence[Sweep], params: dict[str, str]) -> list[Beams]:
    """For each sweep; equal ones are one object."""
    farthest = min(farthest_return([s.ranges for s in sweeps]), _number(params, "robot_front_laser_max", np.inf))
    base_from_laser = _mount(sweeps, params)
    known: dict[tuple[int, Fan | None], Beams] = {}
    for sweep in sweeps:
        key = (len(sweep.ranges), sweep.fan)
        if key not in known:
            fan = sweep.fan or _half_circle(key[0], params)
            bearings = base_from_laser[2] + fan.start + fan.step * np.arange(key[0], dtype=np.float64)
            limit = min(farthest, fan.range_max if fan.range_max > 0.0 else np.inf)
            known[key] = Beams((base_from_laser[0], base_from_laser[1]), bearings, 0.0, limit)
    return [known[len(sweep.ranges), sweep.fan] for sweep in sweeps]


def _half_circle(n: int, params: dict[str, str]) -> Fan:
    """The fan of a FLASER line: PARAM laserN_fov and laserN_resolution [deg] where they fit ``n`` beams, else 180 deg.

    180 and 360 beams end a step before +90 deg; 181 and 361 reach it. 541 beams are 270 deg in half degrees.
    """
    front = params.get("robot_frontlaser_id", "1")
    view, step = (_number(params, f"laser_laser{front}_{what}", 0.0) for what in ("fov", "resolution"))
    if not (step > 0.0 and abs(view / step - n) <= 1.01):
        view = 270.0 if n in (540, 541) else 180.0
        step = view / (n - n % 2)
    return Fan(-radians(view) / 2, radians(step), np.inf)


def _mount(sweeps: Sequence[Sweep], params: dict[str, str]) -> tuple[float, float, float]:
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
    return forward, side, turn if abs(turn) <= 2 * pi else radians(turn)


def _number(params: dict[str, str], key: str, otherwise: float) -> float:
    try:
        value = float(params.get(key, otherwise))
    except ValueError:
        return otherwise
    return value if np.isfinite(value) else otherwise
