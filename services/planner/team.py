"""The rest of the team, as the planner of one vehicle hears of it."""

from collections.abc import Callable
from math import isfinite

import numpy as np

from schemas.messages import NavStatus, PoseInFrame, PosesInFrame
from uvf.maths.se2 import Pose2, transform
from uvf.planning.exploration import OthersGoal
from uvf.planning.navigation.right_of_way import Traveller
from uvf.planning.smoothing import from_place

Point = tuple[float, float]
InMap = Callable[[Point], Point]

MOST = 2000  # points of another vehicle's path that are looked at


def places(own: str, poses: dict[str, PoseInFrame]) -> dict[str, Point]:
    """Where the others are [m, world]; without those whose place is none."""
    found = {name: (said.pose.position.x, said.pose.position.y) for name, said in poses.items() if name != own}
    return {name: place for name, place in found.items() if isfinite(place[0]) and isfinite(place[1])}


def exploring(own: str, said: dict[str, NavStatus], in_map: InMap) -> list[OthersGoal]:
    """Where the others go to explore; among two that want the same, the one whose name comes first has it."""
    at_it = (NavStatus.DRIVING, NavStatus.RECOVERING)
    return [
        OthersGoal(in_map((status.goal.x, status.goal.y)), name < own)
        for name, status in said.items()
        if name != own and status.job == "explore" and status.state in at_it
    ]


def travellers(paths: dict[str, PosesInFrame], team: dict[str, Point], map_from_world: Pose2) -> list[Traveller]:
    """The paths of the others from where they are on, in the map frame."""
    found = []
    for name, message in sorted(paths.items()):
        if name in team and message.poses:
            points = np.array([(pose.position.x, pose.position.y) for pose in message.poses[:MOST]])
            rest, _ = from_place(points[np.isfinite(points).all(axis=1)], team[name])
            found.append(Traveller(name, transform(map_from_world, rest)))
    return found
