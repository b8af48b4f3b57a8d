"""A rover that has explored a world drives to random goals on its own map and localization: physics, SLAM, planner and autopilot.

In lockstep. Goals lie on the floor that the rover can reach and its map knows. ``reached %``: it says so, and truly is within 0.3 m.
``m``, ``s``: straight distance and time of those that were reached. ``closest m``: least true distance of its outline to anything;
``touched``: goals on the way to which its bumper says so. The truth draws the goals and judges, and nobody else hears it. A rover
that a failsafe has put on hold, or disarmed, has missed its goal, and is told to go on before the next one, as an operator would do.
One that people have knocked over (``tipped``), or that no longer knows where it is (``lost``, by more than 1 m), has missed its goal
too; another one explores the world anew and takes the rest.
"""

import tempfile
from dataclasses import dataclass, field
from functools import partial
from math import acos, hypot
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import yaml
from google.protobuf.message import Message
from numpy.typing import NDArray

from launch import catalogue
from launch.commands.bench import Case, Figures
from launch.commands.bench_selection import Selection
from schemas import topics
from schemas.messages import ArmRequest, Contact, GoalRequest, Grid, Mode, ModeRequest, NavState, NavStatus, PoseInFrame, Reply, Vector3
from schemas.topics import Request
from uvf.maths.rotations import rotate
from uvf.maths.se2 import Pose2, inverse, transform
from uvf.models.scenario import Scenario, load_scenario
from uvf.models.urdf.model import load_urdf
from uvf.models.urdf.outline import plan_outline
from uvf.models.world.geometry import FloorPlan, floor_plan, reachable_places
from uvf.planning.costmap.footprint import RobotFootprint
from uvf.runtime.bus.interface import Sample
from uvf.runtime.messages.convert import occupancy_cells, wxyz, yaw_of
from uvf.runtime.time.lockstep import Lockstep

Floats = NDArray[np.float64]
Row = dict[str, float]

OPTIONS = frozenset({"trials", "seed"})
VEHICLE = "rover"
BEGUN = {
    "house": ("burger", (2.2, 1.3, 0.5)),
    "watkins": ("burger_depth", (1.0, 1.2, 0.0)),
    "plaza": ("my3bot_depth", (5.0, 10.0, 0.0)),
    "world": ("my3bot_depth", (16.0, 12.0, 0.0)),
}
"""Vehicle and start (x, y [m], yaw [rad]) in each world: one that sees what the place has in store, kerbs and pallets too."""
EXPLORED = 200.0  # s
GOALS = 50
PATIENCE = 300.0  # s for a goal, across the plaza at 0.4 m/s too
THERE = 0.3  # m
SETTLED = 0.2  # s after a change of the mode
TIPPED, LOST = 1.0, 1.0  # rad from upright, m between where it is and where it has itself
APART = 0.15  # m beyond the rover's radius that a goal lies from obstacles
CELL = 0.05  # m
WORLDS = tuple(f"goals:{world}" for world in BEGUN)
KINDS = ("sim_ground", "slam", "planner", "autopilot")


@dataclass
class Heard:
    """The newest messages of the rover, and where it truly was (n, 4): t [s], x, y [m], yaw [rad]."""

    status: NavStatus = field(default_factory=NavStatus)
    grid: Grid = field(default_factory=Grid)
    true: list[tuple[float, float, float, float]] = field(default_factory=list)
    touched: bool = False
    tilt: float = 0.0  # rad from upright
    estimate: tuple[float, float] = (np.nan, np.nan)
    """Where it has itself, x, y [m, world]."""

    def listen(self, lockstep: Lockstep) -> None:
        """From now on."""
        for key, qos, hear in (
            (topics.NAV_STATUS.at(VEHICLE), topics.NAV_STATUS.qos, self._status),
            (topics.MAP.at(VEHICLE), topics.MAP.qos, self._map),
            (topics.TRUTH.at(VEHICLE), topics.TRUTH.qos, self._truth),
            (topics.CONTACT.at(VEHICLE), topics.CONTACT.qos, self._contact),
            (topics.POSE.at(VEHICLE), topics.POSE.qos, self._pose),
        ):
            lockstep.bus.subscribe(key, qos, hear)

    def _status(self, sample: Sample) -> None:
        self.status = NavStatus.FromString(sample.payload)

    def _map(self, sample: Sample) -> None:
        self.grid = Grid.FromString(sample.payload)

    def _truth(self, sample: Sample) -> None:
        state = NavState.FromString(sample.payload)
        self.true.append((sample.stamp_ns / 1e9, state.position.x, state.position.y, yaw_of(state.orientation)))
        self.tilt = acos(min(max(float(rotate(wxyz(state.orientation), np.eye(3)[2])[2]), -1.0), 1.0))

    def _pose(self, sample: Sample) -> None:
        place = PoseInFrame.FromString(sample.payload).pose.position
        self.estimate = place.x, place.y

    @property
    def is_lost(self) -> bool:
        """Whether it is elsewhere than it has itself."""
        _, x, y, _ = self.true[-1]
        return hypot(x - self.estimate[0], y - self.estimate[1]) > LOST

    def _contact(self, sample: Sample) -> None:
        self.touched |= Contact.FromString(sample.payload).touching


class Errands:
    """The run in one world."""

    def __init__(self, site: Scenario, seed: int) -> None:
        self._site, self._rng = site, np.random.default_rng(seed)
        self.heard = Heard()
        camera = site.members[VEHICLE].file.sensors.camera
        kinds = (*KINDS, "sim_camera") if camera is not None and camera.depth else KINDS  # other pictures are of no use here
        self._lockstep = Lockstep(catalogue.hosts(site, [catalogue.kind(kind) for kind in kinds]))
        self.heard.listen(self._lockstep)
        self._lockstep.run(EXPLORED)

    def close(self) -> None:
        """Ends the services."""
        self._lockstep.close()

    def draw(self, n: int) -> Floats:
        """(n, 2) m, world: places that can be reached and that the map shows free."""
        member = self._site.members[VEHICLE]
        assert member.file.ground is not None
        plan, start = floor_plan(self._site.world, CELL), member.entry.start
        x, y = plan.centres()
        inside = reachable_places(plan, start.x, start.y, member.file.ground.radius + APART)
        floor = np.column_stack((x[inside], y[inside]))
        grid, cells = self.heard.grid, occupancy_cells(self.heard.grid)
        there = transform(inverse(Pose2(start.x, start.y, start.yaw)), floor) - (grid.pose.position.x, grid.pose.position.y)
        columns, rows = np.floor(there / grid.cell_size.x).astype(np.int64).T
        on_map = (rows >= 0) & (columns >= 0) & (rows < cells.shape[0]) & (columns < cells.shape[1])
        free = np.zeros(len(floor), dtype=np.bool_)
        free[on_map] = (cells[rows[on_map], columns[on_map]] >= 0) & (cells[rows[on_map], columns[on_map]] < 50)
        drawn: Floats = floor[free][self._rng.integers(0, int(free.sum()), n)]
        return drawn

    def drive(self, goal: Floats) -> tuple[bool, float, float]:
        """Whether the goal was reached, and truly so; its distance [m] at the start, and the time [s] that it took."""
        begun, x, y, _ = self.heard.true[-1]
        self._ask(topics.ARM, ArmRequest(arm=True, source="bench"))
        self._ask(topics.SET_MODE, ModeRequest(mode=Mode.MODE_MISSION, source="bench"))
        self._lockstep.run(begun + SETTLED)
        begun = self.heard.true[-1][0]
        replies = self._ask(topics.GOAL, GoalRequest(position=Vector3(x=goal[0], y=goal[1]), yaw=float("nan"), source="bench"))
        self._lockstep.run(begun + 1.0)
        if not replies or not replies[0].accepted:
            return False, float(np.hypot(goal[0] - x, goal[1] - y)), 0.0
        self._lockstep.run(begun + PATIENCE, lambda t: self._is_driving())
        ended, at_x, at_y, _ = self.heard.true[-1]
        reached = self.heard.status.state == NavStatus.REACHED and np.hypot(at_x - goal[0], at_y - goal[1]) < THERE
        return bool(reached), float(np.hypot(goal[0] - x, goal[1] - y)), ended - begun

    def _ask(self, request: Request[Any, Reply], message: Message) -> list[Reply]:
        """The list into which the reply comes."""
        replies: list[Reply] = []
        now = round(self.heard.true[-1][0] * 1e9)

        def keep(reply: bytes | None, reason: str, at: int) -> None:
            if reply is not None:
                replies.append(Reply.FromString(reply))

        self._lockstep.bus.call(request.at(VEHICLE), message.SerializeToString(), now, keep)
        return replies

    def _is_driving(self) -> bool:
        return self.heard.status.job == "goal" and self.heard.status.state not in (NavStatus.REACHED, NavStatus.CANCELLED)

    def closest(self) -> float:
        """Least true distance [m] of the outline to an occupied cell of the world's floor plan."""
        member = self._site.members[VEHICLE]
        assert member.file.ground is not None
        outline = plan_outline(load_urdf(member.folder / member.file.ground.urdf))
        assert outline is not None
        return closest(floor_plan(self._site.world, CELL / 2), RobotFootprint.polygon(outline), np.array(self.heard.true)[::10, 1:])


def closest(plan: FloorPlan, footprint: RobotFootprint, poses: Floats) -> float:
    """Least distance [m] of a footprint at poses (n, 3) to the centres of occupied cells, less half a cell."""
    x, y = plan.centres()
    taken = np.column_stack((x[plan.cells], y[plan.cells]))
    sides, least = footprint.sides(), np.inf
    for px, py, yaw in poses.tolist():
        near = taken[(np.abs(taken[:, 0] - px) < 0.6) & (np.abs(taken[:, 1] - py) < 0.6)]
        if len(near):
            local = transform(inverse(Pose2(px, py, yaw)), near)
            least = min(least, float((local @ sides[:, :2].T - sides[:, 2]).max(axis=1).min()))
    return least - CELL / 4


class Driven(NamedTuple):
    """What became of a goal: reached or not, its straight distance [m], time [s], and whether something was touched on the way."""

    reached: bool
    way: float
    took: float
    touched: bool


def errands(world: str, selection: Selection, data: Path | None) -> Figures:
    """The row of a world."""
    goals, seed = selection.trials or GOALS, 1 if selection.seed is None else selection.seed
    driven, nearest, tipped, lost = list[Driven](), np.inf, 0, 0
    with tempfile.TemporaryDirectory() as name:
        model, (x, y, yaw) = BEGUN[world]
        rover = {"model": model, "system_id": 1, "start": {"x": x, "y": y, "yaw": yaw}, "job": {"explore": True}}
        path = Path(name) / f"{world}.yaml"
        path.write_text(yaml.safe_dump({"about": "Errands.", "world": world, "seed": 1, "vehicles": {VEHICLE: rover}}))
        while len(driven) < goals:
            run = Errands(load_scenario(path), seed + tipped + lost)
            for goal in run.draw(goals - len(driven)):
                run.heard.touched = False
                driven.append(Driven(*run.drive(goal), run.heard.touched))
                if run.heard.tilt > TIPPED or run.heard.is_lost:
                    tipped, lost = (tipped + 1, lost) if run.heard.tilt > TIPPED else (tipped, lost + 1)
                    break
            nearest = min(nearest, run.closest())
            run.close()
    reached = np.array([(goal.way, goal.took) for goal in driven if goal.reached]).reshape(-1, 2)
    row = {
        "reached %": 100.0 * len(reached) / len(driven),
        "m": float(reached[:, 0].mean()) if len(reached) else np.nan,
        "s": float(reached[:, 1].mean()) if len(reached) else np.nan,
        "closest m": nearest,
        "touched": float(sum(goal.touched for goal in driven)),
        "tipped": float(tipped),
        "lost": float(lost),
    }
    return {f"goals: {world}": row}


def cases(selection: Selection) -> dict[str, Case]:
    """A case for each world."""
    return dict(zip(WORLDS, (partial(errands, world, selection) for world in BEGUN), strict=True))
