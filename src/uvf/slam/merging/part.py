"""A session made ready to be merged: what was seen from where, and how surely places of it are known from each other."""

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components

from uvf.maths.se2 import Pose2, transform
from uvf.maths.se2_arrays import wrapped
from uvf.models.yaml_data import BadInput
from uvf.slam.graph.nodes import KeyframeNodes
from uvf.slam.graph.restored import add_edges, add_keyframes
from uvf.slam.maps.session import NO_EDGES, Edges, MappingSession
from uvf.slam.matching.likelihood import LikelihoodField, likelihood_field
from uvf.slam.merging.headings import facing
from uvf.slam.pose_graph.pose_graph import PoseGraph

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]

RESOLUTION, SIGMA, DEPTH = 0.1, 0.12, 3
"""Of the field in which places of other sessions are searched: m, m, levels of bounds."""
GRAIN = 0.05  # m between the points it is drawn from
MOST_CELLS = 100_000_000
"""Of a field: a square kilometre."""
VIEW = 2.0  # m around keyframes in which a vehicle of another session is looked for
APART, APART_TURN = 2.0, 0.8
"""m, rad between places that are searched for: nearer ones tell nothing new."""
QUERY_GRID, QUERY_RANGE, QUERY_POINTS = 0.1, 15.0, 120
"""m between points, m of range and number of what is searched for."""
LEG = np.diag((0.03, 0.03, 0.01)) ** 2
"""Covariance that no way within a session is better known than: maps are bent a little where no measurement tells [m^2, rad^2]."""


class VehicleMap:
    """A session made ready to be merged; all in its map frame. name: for messages.

    places: keyframes from which all that was seen was seen, no two of them near each other.
    """

    def __init__(self, name: str) -> None:
        self.name = name
        self.nodes, self.graph = KeyframeNodes(), PoseGraph()
        self.session = MappingSession((), NO_EDGES, "", {})
        self.places: list[int] = []
        self._field: LikelihoodField | None = None
        self._near: Mask | None = None
        self._facing: Floats | None = None
        self._covariances: dict[int, Floats] = {}

    def __len__(self) -> int:
        return len(self.nodes)

    def follow(self, session: MappingSession) -> bool:
        """Takes in what the session is now; False, and nothing done, where that does not go on from what it was before.

        Raises BadInput for edges that make no graph or leave keyframes untied, and where it is too large to be searched in.
        """
        before = [node.reading.t for node in self.nodes.all]
        if before != [keyframe.reading.t for keyframe in session.keyframes[: len(before)]]:
            return False
        self._check(session)
        graph = PoseGraph()
        for keyframe in session.keyframes:
            graph.add_pose(keyframe.map_from_base)
        try:
            add_edges(session.edges, graph)
        except ValueError as error:
            raise BadInput(f"session {self.name}: {error}") from error
        add_keyframes(session, self.nodes)
        self.session, self.graph = session, graph
        self._field = self._near = self._facing = None
        self._covariances.clear()
        self._choose(len(before))
        return True

    def _check(self, session: MappingSession) -> None:
        if len(session.keyframes) < 2:
            return
        across, along = np.ptp([keyframe.map_from_base[:2] for keyframe in session.keyframes], axis=0).tolist()
        if across / RESOLUTION * (along / RESOLUTION) > MOST_CELLS:
            raise BadInput(f"session {self.name}: of {across:.4g} x {along:.4g} m, too large to be merged; look for a jump in the odometry")
        pieces = _pieces(session.edges, len(session.keyframes))
        if pieces > 1:
            raise BadInput(f"session {self.name}: edges leave it in {pieces} pieces whose places to each other nothing tells")

    @property
    def poses(self) -> Floats:
        """Poses map_from_base (n, 3) [m, m, rad] of the keyframes."""
        return np.array(self.nodes.poses).reshape(-1, 3)

    @property
    def field(self) -> LikelihoodField:
        """Likelihood field of all surfaces. Raises ValueError where there are none."""
        if self._field is None:
            points = np.concatenate([transform(pose, self.nodes.still(i).points) for i, pose in enumerate(self.nodes.poses)])
            _, first = np.unique(np.floor(points / GRAIN).astype(np.int64), axis=0, return_index=True)
            self._field = likelihood_field(points[first], RESOLUTION, SIGMA, DEPTH)
        return self._field

    @property
    def near(self) -> Mask:
        """Mask (columns, rows) of the field's cells that are near a keyframe."""
        if self._near is None:
            self._near = np.zeros(self.field.levels.shape[1:], dtype=np.bool_)
            reach = round(VIEW / RESOLUTION)
            cells = np.floor((self.poses[:, :2] - np.array(self.field.corner)) / RESOLUTION).astype(np.int64)
            for column, row in np.unique(cells, axis=0).tolist():
                self._near[max(0, column - reach) : max(0, column + reach), max(0, row - reach) : max(0, row + reach)] = True
        return self._near

    @property
    def facing(self) -> Floats:
        """Histogram (FACES,) of the directions in which all surfaces face."""
        if self._facing is None:
            self._facing = np.sum(
                [facing(self.nodes.all[i].cloud.normals, pose.yaw) for i, pose in enumerate(self.nodes.poses)], axis=0, initial=0.0
            )
        return self._facing

    def query(self, i: int) -> Floats:
        """Points (n, 2) [m, base frame of keyframe i] that were seen around it, thinned."""
        points = self.nodes.submap(i).surfaces.points
        points = points[np.hypot(*points.T) < QUERY_RANGE]
        _, first = np.unique(np.floor(points / QUERY_GRID).astype(np.int64), axis=0, return_index=True)
        thinned: Floats = points[np.sort(first)]
        return thinned[:: max(1, -(-len(thinned) // QUERY_POINTS))]

    def leg(self, i: int, j: int) -> Floats:
        """Covariance (3, 3) of (x, y, yaw) of i_from_j [m, rad], by the session's own measurements."""
        if i not in self._covariances:
            self._covariances[i] = self.graph.covariances_from(i)
        known: Floats = self._covariances[i][j] + LEG
        return known

    def _choose(self, first: int) -> None:
        """Which of the keyframes from the first on are places."""
        for i in range(first, len(self)):
            if len(self.nodes.all[i].cloud.points) and not self._has_place(self.nodes.poses[i]):
                self.places.append(i)

    def _has_place(self, pose: Pose2) -> bool:
        others = np.array([self.nodes.poses[i] for i in self.places]).reshape(-1, 3)
        near = np.hypot(*(others[:, :2] - pose[:2]).T) < APART
        return bool((near & (np.abs(wrapped(others[:, 2] - pose.yaw)) < APART_TURN)).any())


def _pieces(edges: Edges, keyframes: int) -> int:
    """How many sets of keyframes there are that no edge ties to each other."""
    i, j = edges.ends[edges.enabled].T
    return int(connected_components(csr_matrix((np.ones(len(i)), (i, j)), (keyframes, keyframes)), directed=False, return_labels=False))
