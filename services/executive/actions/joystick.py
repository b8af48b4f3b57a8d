"""Recorded drives: velocities of a joystick, sent to vehicles as they were sent then."""

import csv
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from schemas.messages import DriveCommand, Mode
from services.executive.actions.action import EngageAction, first_refusal
from services.executive.situation import TeamSituation
from uvf.models.yaml_data import BadInput
from uvf.runtime.messages.convert import stamp

Floats = NDArray[np.float64]
COLUMNS = ("t", "linear", "angular")
MOST_ROWS = 1_000_000


@dataclass(frozen=True)
class DriveTrack:
    """Velocities over time (n,): t [s] from 0 on, rising; linear [m/s], angular [rad/s]. Each holds until the next one."""

    t: Floats
    linear: Floats
    angular: Floats

    def at(self, t: float) -> tuple[float, float] | None:
        """Linear [m/s] and angular [rad/s] velocity at ``t`` [s]; None behind its end."""
        if t > self.t[-1]:
            return None
        k = int(np.searchsorted(self.t, t, side="right")) - 1
        return (float(self.linear[k]), float(self.angular[k])) if k >= 0 else (0.0, 0.0)


def load_drive_track(path: Path) -> DriveTrack:
    """Reads a CSV file with the columns t [s], linear [m/s], angular [rad/s]; others are left out. Raises BadInput."""
    try:
        with path.open(newline="", encoding="utf-8") as file:
            rows = csv.reader(file)
            header = [name.strip() for name in next(rows, [])]
            if not set(COLUMNS) <= set(header):
                raise BadInput(f"{path}:1: the first line names the columns: {','.join(COLUMNS)}")
            places = [header.index(name) for name in COLUMNS]
            numbers = [_numbers(path, n, row, places) for n, row in enumerate(rows, start=2)]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise BadInput(f"{path}: cannot be read: {error}") from error
    if not 1 <= len(numbers) <= MOST_ROWS:
        raise BadInput(f"{path}: {len(numbers)} rows; 1 to {MOST_ROWS} are possible")
    table = np.array(numbers)
    if late := np.flatnonzero(np.diff(table[:, 0]) <= 0).tolist():
        raise BadInput(f"{path}:{late[0] + 3}: t does not rise")
    return DriveTrack(table[:, 0] - table[0, 0], table[:, 1], table[:, 2])


def _numbers(path: Path, line: int, row: Sequence[str], places: Sequence[int]) -> list[float]:
    if len(row) <= max(places):
        raise BadInput(f"{path}:{line}: give three finite numbers: {','.join(COLUMNS)}")
    try:
        numbers = [float(row[place]) for place in places]
    except ValueError as error:
        raise BadInput(f"{path}:{line}: {error}") from error
    if not np.isfinite(numbers).all():
        raise BadInput(f"{path}:{line}: give three finite numbers: {','.join(COLUMNS)}")
    return numbers


class DriveAction:
    """Drives vehicles by one track, all alike."""

    def __init__(self, vehicles: Sequence[str], track: DriveTrack) -> None:
        self._vehicles, self._track = vehicles, track
        self._engages = [EngageAction(vehicle, Mode.MODE_MANUAL) for vehicle in vehicles]
        self._begun: float | None = None
        self.reason = ""

    def begin(self, now: TeamSituation) -> None:
        """Begins with taking the vehicles over."""
        self._begun = None
        for engage in self._engages:
            engage.begin(now)

    def step(self, now: TeamSituation) -> bool:
        """Whether the track is at its end; it begins once all vehicles are armed and driven by hand."""
        if self._begun is None:
            ready = [engage.step(now) for engage in self._engages]
            self.reason = next((engage.reason for engage in self._engages if engage.reason), "")
            self._begun = now.t if all(ready) else None
        driven = now.t - self._begun if self._begun is not None else 0.0
        velocity = self._track.at(driven) if self._begun is not None else (0.0, 0.0)
        if self._begun is not None:
            self.reason = f"{min(driven, self._track.t[-1]):.0f} of {self._track.t[-1]:.0f} s"
        linear, angular = velocity or (0.0, 0.0)
        command = DriveCommand(timestamp=stamp(now.t), linear=linear, angular=angular)
        now.drive.update(dict.fromkeys(self._vehicles, command))
        return velocity is None

    @property
    def refusal(self) -> str:
        """Why a vehicle cannot be driven by hand."""
        return first_refusal(self._engages)

    def stop(self, now: TeamSituation) -> None:
        """The vehicles stand."""
        for engage in self._engages:
            engage.stop(now)
        now.drive.update(dict.fromkeys(self._vehicles, DriveCommand(timestamp=stamp(now.t))))
