"""The pose graphs of others: solved from their own bad starts."""

from dataclasses import replace

import numpy as np
import pytest

from launch.commands.testing import data_folder
from uvf.slam.pose_graph import g2o
from uvf.slam.pose_graph.descent import heading_first
from uvf.slam.pose_graph.linear import LinearSystem
from uvf.slam.pose_graph.pose_graph import PoseGraph

DATA = data_folder()


@pytest.mark.skipif(DATA is None, reason="no data folder: pose graphs of others left out (set UVF_DATA)")
def test_the_same_cost_is_reached_from_the_file_and_from_headings_first():
    for path in sorted((DATA / "slam" / "posegraphs").rglob("*.g2o")):
        poses, edges = g2o.read(path)
        graph = PoseGraph()
        for pose in poses:
            graph.add_pose(pose)
        for edge in edges:
            graph.add_edge(replace(edge, robust=False))
        rows, start = graph.edges.rows, np.array(poses)
        system = LinearSystem(len(start), rows, rows.enabled, 0)
        costs = [graph.cost]
        for begin in (start, heading_first(system, start, graph.weights)):
            graph.poses = begin
            assert graph.optimise(tolerance=1e-2).converged, path.name
            costs.append(graph.cost)
        assert costs[1] == pytest.approx(costs[2], rel=1e-4), path.name
        assert costs[1] < 1e-3 * costs[0], path.name
