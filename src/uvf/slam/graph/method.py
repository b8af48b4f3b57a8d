"""Graph SLAM: scans are tracked against the last keyframes, places seen again close loops, a pose graph settles all of it."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from math import hypot
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from uvf.maths.se2 import IDENTITY, Pose2, compose, inverse
from uvf.models.keys import key
from uvf.models.params import Params
from uvf.slam.graph.closing import Closing
from uvf.slam.graph.drift import PathLengths
from uvf.slam.graph.loops import LoopSearch
from uvf.slam.graph.motion import UNKNOWN, OdometryMotion
from uvf.slam.graph.nodes import KeyframeNodes, Node
from uvf.slam.graph.restored import LOOP, add_edges, add_keyframes
from uvf.slam.graph.tracker import LocalMap, Tracker
from uvf.slam.logs.jumps import step_between
from uvf.slam.maps.session import KINDS, Edges, MappingSession
from uvf.slam.matching.cloud import cloud_of
from uvf.slam.matching.imls import Match
from uvf.slam.matching.point_map import point_map
from uvf.slam.method import Keyframe, SlamEstimate
from uvf.slam.pose_graph.edges import Edge
from uvf.slam.pose_graph.pose_graph import PoseGraph
from uvf.slam.pose_graph.uncertainty import followed, turned
from uvf.slam.reading import Reading

Floats = NDArray[np.float64]

RECENT = 12  # keyframes a sweep is matched to
STOOD = 1e-4  # m, rad: odometry that moves less has not moved
EDGE_FLOOR = (0.003, 0.001, 0.008)
"""1 sigma of an edge between two keyframes that no match betters: m, rad, rad per rad turned."""
CHANGED, MOST_CHANGED = 0.1, 0.25
"""m by which a range is another one, and the share of them that are others when it is not only people who have moved."""
DOUBTED = 0.01
"""Part of its information that is left to a step in which a match was doubted."""


class GraphParams(Params, frozen=True):
    """Parameters of ``GraphSlam``: the motion after which a scan becomes a keyframe."""

    keyframe_distance: Annotated[float, key("m", "Distance driven after which a scan becomes a keyframe.")] = 0.35
    keyframe_turn: Annotated[float, key("rad", "Angle turned after which a scan becomes a keyframe.")] = 0.2


@dataclass(frozen=True)
class _Placed:
    """A reading relative to a keyframe."""

    node: int
    node_from_base: Pose2


@dataclass
class GraphSlam:
    """Graph SLAM, the default method; see ``SlamMethod``."""

    params: GraphParams = field(default_factory=GraphParams)

    def __post_init__(self) -> None:
        self.graph, self.nodes, self.ways = PoseGraph(), KeyframeNodes(), PathLengths()
        self.tracker = Tracker()
        self.closing = Closing(self.graph, self.nodes, self.ways, LoopSearch(self.nodes))
        self._local = LocalMap(point_map([]))
        self._placed: list[_Placed] = []
        self._pose = IDENTITY
        self._last: Reading | None = None
        self._matched: Reading | None = None
        self._doubted = self._blind = False
        self._near = 0
        self._way = self._turn = 0.0
        self.quality = 1.0
        self._node_covariance = self._covariance = np.zeros((3, 3))

    def add(self, reading: Reading) -> SlamEstimate:
        """Tracks one reading, makes it a keyframe if the vehicle has moved enough, and closes loops."""
        last, step = self._last, self._step(reading)
        if len(self.nodes) == 0:
            self._matched = reading
            self._add_node(Node(reading, cloud_of(reading), 0.0, 0.0))
            return self._place(1.0)
        if step is None:
            return self._track(reading, OdometryMotion(self._pose, IDENTITY, UNKNOWN))
        stood = hypot(step[0], step[1]) < STOOD and abs(step[2]) < STOOD
        if stood and not (self._matched is None or _changed(self._matched, reading)):
            self._pose = compose(self._pose, step)
            return self._place(self.quality)
        claimed = reading.claimed_since(last) if last is not None else None
        return self._track(reading, OdometryMotion(self._pose, step, self.tracker.noise, stood, claimed))

    def _track(self, reading: Reading, motion: OdometryMotion) -> SlamEstimate:
        cloud, self._matched = cloud_of(reading), reading
        tracked = self.tracker.track(self._local, motion, cloud)
        found, self._pose = tracked.match, tracked.match.map_from_base
        self._doubted = self._doubted or tracked.doubted
        if not motion.told:
            self._blind = True
            self._count(compose(inverse(motion.before), self._pose))
        moved = self._moved()
        step_covariance = self._step_covariance(moved, found, cloud.is_thin, reading)
        self._covariance = followed(self._node_covariance, self.nodes.poses[self._near], moved, step_covariance)
        if hypot(moved[0], moved[1]) > self.params.keyframe_distance or abs(moved[2]) > self.params.keyframe_turn:
            self._keep(Node(reading, cloud, self._way, self._turn), moved, step_covariance)
        return self._place(found.share)

    def trajectory(self) -> Floats:
        """Poses map_from_base (readings, 3) [m, m, rad] of all readings, by the keyframes' poses as known now."""
        return np.array([compose(self.nodes.poses[p.node], p.node_from_base) for p in self._placed]).reshape(-1, 3)

    def session(self) -> MappingSession:
        """The whole mapping session, so that another instance can ``resume`` it."""
        rows = self.graph.edges.rows
        kinds = np.where(rows.robust, KINDS.index("loop"), KINDS.index("match")).astype(np.uint8)
        edges = Edges(rows.ends.copy(), rows.measured.copy(), rows.information.copy(), kinds, rows.enabled.copy())
        return MappingSession(tuple(self.keyframes()), edges, "graph", {})

    def resume(self, session: MappingSession, map_from_base: Pose2) -> None:
        """Continues a session before the first reading; the vehicle stands near map_from_base, wherever the session has ended."""
        way, turn = add_keyframes(session, self.nodes)
        for pose in self.nodes.poses:
            self.graph.add_pose(pose)
        add_edges(session.edges, self.graph)
        e = session.edges
        for (i, j), measured, information, kind in zip(e.ends.tolist(), e.measured, e.information, e.kinds.tolist(), strict=True):
            if kind == LOOP:
                self.ways.tie(i, j, information)
            else:
                self.ways.add(i, j, hypot(measured[0], measured[1]))
        self._way, self._turn, self._pose = way, turn, map_from_base
        self._near = self.nodes.nearest(map_from_base)
        self._node_covariance = self._covariance = self.graph.relative_covariance(0, self._near) if self._near else np.zeros((3, 3))
        self._look_around()

    def keyframes(self) -> Iterator[Keyframe]:
        """The keyframes with their poses as known now."""
        for pose, node in zip(self.nodes.poses, self.nodes.all, strict=True):
            yield Keyframe(pose, node.reading)

    def keyframe_count(self) -> int:
        """Number of keyframes."""
        return len(self.nodes)

    def finish(self) -> None:
        """Optimises the graph a last time."""
        if len(self.nodes) > 1:
            self.closing.settle()

    def _step(self, reading: Reading) -> Pose2 | None:
        """Of the odometry since the last reading that had one; None where it is no number or no vehicle's."""
        if not np.isfinite(reading.odom_from_base).all():
            return None
        last, self._last = self._last, reading
        step = step_between(last, reading) if last else IDENTITY
        if step is not None:
            self._count(step)
        return step

    def _count(self, step: Pose2) -> None:
        self._way += hypot(step[0], step[1])
        self._turn += abs(step[2])

    def _moved(self) -> Pose2:
        """Of the base since the keyframe that it has last been near."""
        return compose(inverse(self.nodes.poses[self._near]), self._pose)

    def _place(self, quality: float) -> SlamEstimate:
        self.quality = quality
        self._placed.append(_Placed(self._near, self._moved()))
        return SlamEstimate(self._pose, self._covariance, quality)

    def _keep(self, node: Node, moved: Pose2, covariance: Floats) -> None:
        before = self._near
        k = self._add_node(node)
        self.ways.add(before, k, node.travelled - self.nodes.all[k - 1].travelled)
        self.graph.add_edge(Edge(before, k, moved, np.asarray(np.linalg.inv(covariance), dtype=np.float64)))
        self._doubted = self._blind = False
        self._node_covariance = self._covariance
        if self.closing.look(k):
            self._pose = self.nodes.poses[k]
            self._node_covariance = self._covariance = self.graph.relative_covariance(0, k)
            self._look_around()

    def _add_node(self, node: Node) -> int:
        k = self._near = self.graph.add_pose(self._pose)
        self.nodes.add(node, self._pose)
        self._look_around()
        return k

    def _look_around(self) -> None:
        """The surfaces of the keyframes before the last one are what is matched to from now on."""
        end = self._near + 1
        self._local = LocalMap(self.nodes.surfaces(range(max(0, end - RECENT), end)))

    def _step_covariance(self, moved: Pose2, found: Match, is_thin: bool, reading: Reading) -> Floats:
        """(3, 3) of the motion since the last keyframe, along its axes: of the match and, where that is weak, of the odometry."""
        before = self.nodes.all[-1]
        way = Pose2(self._way - before.travelled, 0.0, self._turn - before.turned)
        turn = turned(self.nodes.poses[self._near].yaw)
        matched = turn.T @ found.information @ turn * (DOUBTED if self._doubted else 1.0)
        noise = self.tracker.trust.usual(self.tracker.noise) if is_thin else self.tracker.noise
        claimed = reading.claimed_since(before.reading) if is_thin else None
        told = UNKNOWN.information(way) if self._blind else noise.information(way, claimed)
        position, heading, per_turn = EDGE_FLOOR
        floor = np.diag((position, position, heading + per_turn * abs(moved[2]))) ** 2
        covariance: Floats = np.linalg.inv(matched + told) + floor
        return covariance


def _changed(before: Reading, now: Reading) -> bool:
    """Whether the lidar has moved between two sweeps, people aside."""
    if before.ranges.shape != now.ranges.shape:
        return False
    both = before.returned & now.returned
    others = np.abs(before.ranges[both] - now.ranges[both]) > CHANGED
    return bool(np.count_nonzero(others) > MOST_CHANGED * len(both))
