"""Keyframes, their submaps, and what of them has moved."""

from dataclasses import replace

import numpy as np

from tests.slam.matching.walls import ROOM, seen
from uvf.maths.se2 import Pose2, compose
from uvf.slam.graph.nodes import HALF, KeyframeNodes, Node
from uvf.slam.matching.cloud import cloud_of

WAY = [Pose2(0.1 * i, 0.02 * i, 0.01 * i) for i in range(2 * HALF + 6)]


def keyframes(change=lambda i, reading: reading):
    nodes = KeyframeNodes()
    for i, pose in enumerate(WAY):
        reading = change(i, seen(ROOM, pose))
        nodes.add(Node(reading, cloud_of(reading), 0.1 * i, 0.01 * i), pose)
    return nodes


def test_a_submap_is_kept_while_its_keyframes_lie_as_they_did():
    nodes = keyframes()
    drawn = nodes.submap(HALF)
    nodes.poses[:] = [compose(Pose2(3.0, -2.0, 1.0), pose) for pose in nodes.poses]
    assert nodes.submap(HALF) is drawn


def test_a_submap_is_drawn_anew_when_one_of_its_keyframes_has_moved_against_the_others():
    nodes = keyframes()
    drawn = nodes.submap(HALF)
    nodes.poses[2] = compose(nodes.poses[2], Pose2(0.05, 0.0, 0.0))
    anew = nodes.submap(HALF)
    assert anew is not drawn
    assert nodes.submap(HALF) is anew
    nodes.poses[2 * HALF + 3] = Pose2(50.0, 0.0, 0.0)
    assert nodes.submap(HALF) is anew


def test_a_submap_shows_the_walls_in_the_frame_of_its_anchor():
    nodes = keyframes()
    points = nodes.submap(HALF).surfaces.points
    c, s = np.cos(WAY[HALF].yaw), np.sin(WAY[HALF].yaw)
    x, y = (points @ np.array(((c, s), (-s, c))) + np.array(WAY[HALF][:2])).T
    walls = [np.abs(x - w) for w in (-3.0, 4.0, 1.0, 2.5)] + [np.abs(y - w) for w in (-2.0, 3.0, 2.2)]
    assert np.min(walls, axis=0).max() < 0.01


def test_who_walked_through_the_room_is_no_surface_of_it():
    def walker(i, reading):
        ranges = reading.ranges.copy()
        ranges[10 * i : 10 * i + 12] = 1.0
        return replace(reading, ranges=ranges)

    nodes = keyframes(walker)
    near = 0
    for i in range(4, len(WAY) - 4):
        still = nodes.still(i)
        near += int((np.hypot(*still.points.T) < 1.05).sum())
        assert len(still.points) > 165
    assert near < 12


def test_an_empty_room_keeps_all_its_surfaces():
    nodes = keyframes()
    assert all(len(nodes.still(i).points) > 0.98 * len(nodes.all[i].cloud.points) for i in range(len(nodes)))


def test_a_keyframe_of_which_little_came_back_is_seen_along_with_those_before_it():
    def part(i, reading):
        turn = (20 * i) % len(reading.ranges)
        beside = (np.arange(len(reading.ranges)) - turn) % len(reading.ranges) >= 0.08 * len(reading.ranges)
        return replace(reading, ranges=np.where(beside, 0.0, reading.ranges))

    nodes, k = keyframes(part), len(WAY) - 1
    own, gathered = nodes.all[k].cloud, nodes.gathered(k)
    assert own.is_scant
    assert len(gathered.points) > 6 * len(own.points)
    c, s = np.cos(WAY[k].yaw), np.sin(WAY[k].yaw)
    x, y = (gathered.points @ np.array(((c, s), (-s, c))) + np.array(WAY[k][:2])).T
    walls = [np.abs(x - w) for w in (-3.0, 4.0, 1.0, 2.5)] + [np.abs(y - w) for w in (-2.0, 3.0, 2.2)]
    assert np.min(walls, axis=0).max() < 0.01
    full = keyframes()
    assert full.gathered(k) is full.all[k].cloud
