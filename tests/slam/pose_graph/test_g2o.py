"""g2o files: read, written, refused."""

import numpy as np
import pytest

from tests.slam.graph.rings import driven, truth
from uvf.maths.se2 import Pose2
from uvf.models.yaml_data import BadInput
from uvf.slam.pose_graph import g2o
from uvf.slam.pose_graph.pose_graph import PoseGraph

INFORMATION = "1 0 0 1 0 1"


def built(poses, edges):
    graph = PoseGraph()
    for pose in poses:
        graph.add_pose(pose)
    for edge in edges:
        graph.add_edge(edge)
    return graph


def test_what_is_written_is_read_again(tmp_path):
    graph = driven(truth(30), [(0, 20), (3, 25)], np.random.default_rng(1))
    graph.optimise()
    g2o.write(tmp_path / "a.g2o", graph)
    poses, edges = g2o.read(tmp_path / "a.g2o")
    again = built(poses, edges)
    assert (again.poses == graph.poses).all()
    np.testing.assert_allclose(again.edges.rows.information, graph.edges.rows.information, rtol=1e-12, atol=1e-9)
    assert (again.edges.rows.robust == graph.edges.rows.robust).all()
    assert again.cost == pytest.approx(graph.cost)


def test_an_edge_that_is_switched_off_is_not_written(tmp_path):
    graph = driven(truth(30), [(0, 20)], np.random.default_rng(1))
    graph.enable(29, False)
    g2o.write(tmp_path / "a.g2o", graph)
    assert len(g2o.read(tmp_path / "a.g2o")[1]) == 29


def test_the_error_counts_along_the_axes_of_the_measured_pose(tmp_path):
    """Pose 1 looks along y; it lies 0.1 m too far along its own x, where the information is 400."""
    lines = ["VERTEX_SE2 0 0 0 0", f"VERTEX_SE2 1 0 1.1 {np.pi / 2}", f"EDGE_SE2 0 1 0 1 {np.pi / 2} 400 0 0 1 0 1"]
    (tmp_path / "a.g2o").write_text("\n".join(lines))
    assert built(*g2o.read(tmp_path / "a.g2o")).chi2[0] == pytest.approx(4.0)


def test_poses_that_are_not_in_the_file_follow_from_its_edges(tmp_path):
    step = f"1 0 {np.pi / 2} {INFORMATION}"
    (tmp_path / "a.g2o").write_text(f"EDGE_SE2 0 1 {step}\nEDGE_SE2 0 3 9 9 9 {INFORMATION}\nEDGE_SE2 1 2 {step}\nEDGE_SE2 2 3 {step}\n")
    poses, edges = g2o.read(tmp_path / "a.g2o")
    np.testing.assert_allclose(np.array(poses)[:, :2], [(0, 0), (1, 0), (1, 1), (0, 1)], atol=1e-12)
    assert [edge.robust for edge in edges] == [False, True, False, False]


TWO = "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\n"


@pytest.mark.parametrize(
    ("text", "line"),
    [
        (TWO + "EDGE_SE3 0 1 1 0 0", "a.g2o:3: 'EDGE_SE3' is not known; did you mean 'EDGE_SE2'"),
        (TWO + "EDGE_SE2 0 1 1 0 0 1 0 0 1", "a.g2o:3: EDGE_SE2 with 9 fields; it has 11: complete the line or remove it"),
        (TWO + "# fine\n\nVERTEX_SE2 2 0 zero 0", "a.g2o:5: could not convert string to float: 'zero'; write ids"),
        (TWO + f"EDGE_SE2 0 1.5 1 0 0 {INFORMATION}", "a.g2o:3: invalid literal for int() with base 10: '1.5'; write ids"),
        (TWO + "VERTEX_SE2 3 2 0 0", "a.g2o:3: vertex 3 where 2 should be; number them"),
        (TWO + "VERTEX_SE2 1 2 0 0", "a.g2o:3: vertex 1 is there twice, first in "),
        (TWO + f"EDGE_SE2 0 2 1 0 0 {INFORMATION}", "a.g2o:3: edge 0 -> 2: no pose 2; there are 2; correct the line or remove it"),
        (TWO + "EDGE_SE2 0 1 1 0 0 1 0 0 -1 0 1", "a.g2o:3: edge 0 -> 1: information is no inverse covariance"),
        (TWO + f"EDGE_SE2 0 1 nan 0 0 {INFORMATION}", "a.g2o:3: a number that is not finite; remove the line"),
        (f"EDGE_SE2 0 1 1 0 0 {INFORMATION}\nEDGE_SE2 3 4 1 0 0 {INFORMATION}", "a.g2o: no edges lead from pose 0 to pose 2; add"),
        ("# nothing\n", "a.g2o: no vertex and no edge; give"),
    ],
)
def test_a_broken_file_is_refused_in_one_line_that_says_where(tmp_path, text, line):
    (tmp_path / "a.g2o").write_text(text)
    with pytest.raises(BadInput) as refused:
        g2o.read(tmp_path / "a.g2o")
    assert line in str(refused.value)
    assert "\n" not in str(refused.value)


def test_a_file_that_is_not_there_or_no_text_is_refused(tmp_path):
    (tmp_path / "b.g2o").write_bytes(b"\xff\xfe\x00")
    for name in ("a.g2o", "b.g2o"):
        with pytest.raises(BadInput, match="cannot be read"):
            g2o.read(tmp_path / name)


def test_a_pose_is_read_as_it_stands(tmp_path):
    (tmp_path / "a.g2o").write_text(TWO)
    assert g2o.read(tmp_path / "a.g2o") == ([Pose2(0.0, 0.0, 0.0), Pose2(1.0, 0.0, 0.0)], [])
