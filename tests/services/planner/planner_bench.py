"""A planner that is stepped by hand in a room, and what is asked of it; its map lies turned in the world."""

import numpy as np

from schemas.messages import (
    CancelRequest,
    GoalRequest,
    Mode,
    PoseInFrame,
    PreviewRequest,
    Vector3,
    VehicleStatus,
)
from services.planner.params import PlannerParams
from services.planner.planned_vehicle import PlannedVehicle
from services.planner.planner_service import PlannerService
from tests.runtime.stepping import stepped
from tests.services.planner.plans import room
from tests.services.planner.seeing import NO_OTHERS, NOTHING_ELSE, sensors_of
from uvf.maths.se3 import Transform
from uvf.planning.costmap.footprint import RobotFootprint
from uvf.runtime.messages.convert import occupancy_grid, planar_pose, stamp

READY = VehicleStatus(mode=Mode.MODE_MISSION, armed=True, command_source="planner")
NOBODY = {"team": {}, "team_nav": {}, "team_path": {}, "team_map": {}}
NOTHING = (
    NOTHING_ELSE | NOBODY | dict.fromkeys(("scan", "report", "keep_out", "shared", "team_place", "mission", "progress", "bounds", "rally"))
)
START = (10.0, 20.0, np.pi / 2)
"""The map lies here in the world, turned: map x is world y."""


def planner(explores=False, offset=0.0, sensors=NO_OTHERS, footprint=None):
    """Of a vehicle, round and of 0.1 m where nothing else is said, with a lidar ``offset`` [m] ahead of its centre."""
    footprint = footprint or RobotFootprint.circle(0.1)
    seeing = sensors_of(footprint, Transform(np.array((1.0, 0.0, 0.0, 0.0)), np.array((offset, 0.0, 0.1))), sensors=sensors)
    return PlannerService(START, PlannedVehicle(footprint, seeing, 0.45, explores, "v"), PlannerParams())


CANCEL = CancelRequest(source="test")


class Bench:
    """Steps a planner at 4 Hz in a room of 4 x 3 m; the vehicle stands at ``here`` [m, map] unless it is moved."""

    def __init__(self, explores=False, sensors=NO_OTHERS):
        self.service = planner(explores, sensors=sensors)
        self.t = 0.0
        self.here = (1.0, 1.0)
        self.yaw = START[2]  # rad, world
        self.grid = occupancy_grid(room(4.0, 3.0), 0.05, 0.0, 0.0, "v/map", 0.0)
        self.said = {}
        self.events = []
        self.asked = []

    def step(self, n=1, status=READY, goal=(), route=(), follow=(), cancel=(), preview=(), **heard):
        for _ in range(n):
            self.t += 0.25
            pose = PoseInFrame(timestamp=stamp(self.t), pose=planar_pose(*world(*self.here), self.yaw))
            asks = {"goal": list(goal), "route": list(route), "follow": list(follow), "cancel": list(cancel), "preview": list(preview)}
            told = NOTHING | {"status": status, "pose": [pose], "map": self.grid} | asks | heard
            self.said = stepped(self.service, self.t, **told)
            self.events += [e.text for e in self.said["events"]]
            self.asked += self.said["set_mode"]
        return self

    @property
    def path(self):
        """(n, 2) m, map."""
        return np.array([(p.position.y - START[1], START[0] - p.position.x) for p in self.said["path"].poses])

    @property
    def state(self):
        return self.said["nav_status"].state


def world(x, y):
    return (START[0] - y, START[1] + x)


def asked(x, y, yaw=float("nan")):
    position = world(x, y)
    return GoalRequest(position=Vector3(x=position[0], y=position[1]), yaw=yaw, source="test")


def preview(x, y, start=None):
    position, begin = (Vector3(**dict(zip("xy", world(*place), strict=True))) if place else None for place in ((x, y), start))
    return PreviewRequest(position=position, start=begin, source="test")
