"""Worlds and controllers of our own."""

import json

import numpy as np

from benchmarks.planning.barn.worlds import World
from uvf.maths.se2 import Pose2

START = Pose2(1.0, -2.0, 0.5)


def ahead(forward, left=0.0):
    """The place [m] so far ahead of START."""
    c, s = np.cos(START.yaw), np.sin(START.yaw)
    return START.x + c * forward - s * left, START.y + s * forward + c * left


def world(goal=6.0, discs=(), **more):
    """Discs are (forward, left, radius) as seen from the start."""
    rows = np.array([(*ahead(x, y), radius) for x, y, radius in discs]).reshape(-1, 3)
    return World("made_up", START, ahead(goal), rows, optimal_time=goal / 2, **more)


class Commands:
    """A controller that does what a function of time says, and keeps what it is given."""

    def __init__(self, at):
        self._at = at
        self.given = []

    def reset(self, goal_in_odom):
        self.goal = goal_in_odom

    def command(self, t, ranges, odom_from_base, velocity):
        self.given.append((t, ranges, odom_from_base, velocity))
        return self._at(t)


def folder(tmp_path, worlds=None, lengths="world,path_length_m\n4,11.0\n7,12.5\n", dynamic=None):
    """A folder of data with worlds 4 and 7."""
    below = tmp_path / "barn"
    below.mkdir()
    if worlds is None:
        line = np.column_stack((np.full(20, -2.25), np.linspace(5.0, 5.0, 20)))
        worlds = {"world_4": line.astype(np.float32), "world_7": np.array([(-2.25, 0.5)]), "path_7": np.array([(15, 0), (15, 40)])}
    np.savez(below / "barn_worlds.npz", **worlds)
    (below / "worlds.csv").write_text(lengths)
    keys = [[0.0, 11.0, 5.0], [10.0, 11.0, -5.0]]
    obstacle = {"radius": 0.5, "period": 10.0, "keyframes": keys}
    dynamic = {"2": {"difficulty": "easy", "obstacles": [obstacle]}} if dynamic is None else dynamic
    (below / "dynabarn.json").write_text(json.dumps(dynamic))
    return tmp_path
