"""The tree of frames against 4 by 4 matrices, and what it refuses with which words."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from schemas.messages import FrameTransform, FrameTransforms, Imu, Quaternion
from uvf.maths.rotations import from_euler
from uvf.maths.se3 import homogeneous
from uvf.runtime.messages.convert import quaternion, stamp, vector
from uvf.runtime.messages.frames import FrameBuffer, FrameError

checked = settings(max_examples=60, deadline=None, derandomize=True)
angles = st.floats(-3.1, 3.1)
metres = st.floats(-20, 20)
motions = st.tuples(angles, angles, angles, metres, metres, metres)
"""roll, pitch, yaw, x, y, z of a child in its parent."""


def edge(parent, child, motion, t=0.0):
    return FrameTransform(
        timestamp=stamp(t),
        parent_frame_id=parent,
        child_frame_id=child,
        translation=vector(np.array(motion[3:])),
        rotation=quaternion(from_euler(*motion[:3])),
    )


def moved(x, yaw=0.0):
    return (0.0, 0.0, yaw, x, 0.0, 0.0)


def matrix_of(motion):
    """The second way: scipy's rotation, put into a matrix by hand."""
    m = np.eye(4)
    m[:3, :3] = Rotation.from_euler("ZYX", motion[2::-1]).as_matrix()
    m[:3, 3] = motion[3:]
    return m


def buffer_of(*edges, static=()):
    frames = FrameBuffer()
    for message in static:
        frames.add(message, is_static=True)
    for message in edges:
        frames.add(message)
    return frames


@checked
@given(st.lists(st.tuples(st.integers(0, 100), motions, st.booleans()), min_size=1, max_size=9), st.data())
def test_any_two_frames_of_any_tree_are_as_the_product_of_matrices(drawn, data):
    frames, root_from = FrameBuffer(), [np.eye(4)]
    for i, (draw, motion, is_static) in enumerate(drawn, 1):
        parent = draw % i
        frames.add(edge(f"f{parent}", f"f{i}", motion, 1.0), is_static)
        root_from.append(root_from[parent] @ matrix_of(motion))
    target, source = (data.draw(st.integers(0, len(drawn))) for _ in range(2))
    expected = np.linalg.inv(root_from[target]) @ root_from[source]
    assert homogeneous(frames.lookup(f"f{target}", f"f{source}", 1.0)) == pytest.approx(expected, abs=1e-9)


@checked
@given(st.permutations(range(8)), st.floats(0.0, 0.7))
def test_the_order_of_arrival_does_not_matter(order, t):
    frames = buffer_of(*(edge("odom", "base", moved(i**2, 0.1 * i), i / 10) for i in order))
    i = min(int(t * 10), 6)
    fraction = t * 10 - i
    found = frames.lookup("odom", "base", t)
    assert found.translation[0] == pytest.approx((1 - fraction) * i**2 + fraction * (i + 1) ** 2, abs=1e-6)
    assert found.rotation == pytest.approx(from_euler(0, 0, t), abs=1e-6)


@pytest.mark.parametrize(
    "broken", [(0.0, 0.0, 0.0, np.nan, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0, np.inf, 0.0), (np.nan, 0.0, 0.0, 0.0, 0.0, 0.0)]
)
def test_a_transform_that_is_no_number_is_as_if_it_had_not_been_told(broken):
    frames = FrameBuffer()
    frames.add(edge("a", "c", broken))
    with pytest.raises(FrameError, match="no frame"):
        frames.lookup("a", "c")
    frames.add(edge("a", "b", moved(1.0), t=1.0))
    frames.add(edge("a", "b", broken, t=2.0))
    assert frames.lookup("a", "b").translation.tolist() == [1.0, 0.0, 0.0]


def test_static_edges_hold_at_all_times_whenever_they_were_said():
    frames = buffer_of(static=[edge("base", "lidar", moved(0.1), 5.0)])
    assert [frames.lookup("base", "lidar", t).translation[0] for t in (0.0, 5.0, 1e6)] == [0.1, 0.1, 0.1]
    assert frames.lookup("base", "lidar").translation[0] == 0.1


def test_a_static_edge_said_anew_holds_from_then_on():
    frames = buffer_of(static=[edge("base", "lidar", moved(0.1)), edge("base", "lidar", moved(0.2), 3.0)])
    assert frames.lookup("base", "lidar", 1.0).translation[0] == 0.2


def test_without_a_time_it_is_the_newest_that_the_whole_way_knows():
    fast = [edge("odom", "base", moved(t), t) for t in (1.0, 1.1, 1.2, 1.3)]
    slow = [edge("map", "odom", moved(10 * t), t) for t in (1.0, 1.1)]
    frames = buffer_of(*fast, *slow)
    assert frames.lookup("map", "base").translation[0] == pytest.approx(11.0 + 1.1)
    assert frames.lookup("odom", "base").translation[0] == pytest.approx(1.3)


def test_of_two_samples_with_one_stamp_the_first_holds():
    frames = buffer_of(edge("odom", "base", moved(1.0), 1.0), edge("odom", "base", moved(9.0), 1.0))
    assert frames.lookup("odom", "base").translation[0] == 1.0


def test_a_frame_in_itself_is_where_it_is():
    frames = buffer_of(edge("odom", "base", moved(1.0), 1.0))
    assert homogeneous(frames.lookup("base", "base", 77.0)) == pytest.approx(np.eye(4))


def team():
    frames = FrameBuffer()
    for name, x in (("one", 1.0), ("two", 5.0)):
        frames.add(edge("world", f"{name}/map", moved(x)), is_static=True)
        frames.add(FrameTransforms(transforms=[edge(f"{name}/base", f"{name}/lidar", moved(0.5))]), is_static=True)
        frames.add(edge(f"{name}/map", f"{name}/base", moved(0.1, np.pi / 2), 2.0))
    return frames


def test_vehicles_of_a_team_see_each_other_through_the_world():
    found = team().lookup("one/lidar", "two/base", 2.0)
    assert found.translation == pytest.approx((-0.5, -4.0, 0.0), abs=1e-9)
    assert found.rotation == pytest.approx(from_euler(0, 0, 0), abs=1e-9)


def test_what_one_vehicle_says_does_not_touch_the_others():
    frames = team()
    frames.add(edge("one/map", "one/base", moved(7.0), 2.5))
    assert frames.lookup("two/map", "two/base").translation[0] == 0.1


def refusal(frames, *asked):
    with pytest.raises(FrameError) as caught:
        frames.lookup(*asked)
    assert "\n" not in str(caught.value)
    return str(caught.value)


def test_too_late_names_the_edge_and_by_how_much():
    frames = buffer_of(edge("map", "odom", moved(1), 1.0), edge("odom", "base", moved(1), 1.0), edge("odom", "base", moved(1), 1.3))
    assert refusal(frames, "map", "base", 1.25) == "'odom' in 'map' is not known at 1.250 s: that is 0.250 s after the newest (1.000 s)"


def test_too_early_names_the_edge_and_by_how_much():
    frames = buffer_of(*(edge("odom", "base", moved(1), t) for t in (1.0, 1.3)))
    assert refusal(frames, "odom", "base", 0.9) == "'base' in 'odom' is not known at 0.900 s: that is 0.100 s before the oldest (1.000 s)"


def test_what_is_older_than_the_history_is_forgotten():
    frames = FrameBuffer(history=2.0)
    for i in range(51):
        frames.add(edge("odom", "base", moved(i), i / 10))
    assert frames.lookup("odom", "base", 3.0).translation[0] == 30
    assert "before the oldest (3.000 s)" in refusal(frames, "odom", "base", 2.9)
    frames.add(edge("odom", "base", moved(0), 1.0))
    assert "before the oldest (3.000 s)" in refusal(frames, "odom", "base", 2.0)


def test_newest_common_time_that_is_nowhere_common_is_refused():
    frames = buffer_of(edge("map", "odom", moved(1), 1.0), edge("odom", "base", moved(1), 2.0))
    assert "'base' in 'odom' is not known at 1.000 s" in refusal(frames, "map", "base")


def test_an_unknown_frame_is_answered_with_the_nearest_name():
    assert refusal(team(), "world", "two/lidr", 2.0) == "no frame 'two/lidr'; did you mean 'two/lidar'?"
    assert refusal(FrameBuffer(), "a", "b") == "no frame 'a'; there are: none"


def test_two_trees_are_named_by_their_roots():
    frames = buffer_of(edge("one/odom", "one/base", moved(1)), edge("two/odom", "two/base", moved(1)))
    assert refusal(frames, "one/base", "two/base") == (
        "'one/base' and 'two/base' are not in one tree: one hangs on 'one/odom', the other on 'two/odom'"
    )


def test_a_loop_is_refused_and_not_walked_for_ever():
    frames = buffer_of(edge("a", "b", moved(1)), edge("b", "c", moved(1)), edge("c", "a", moved(1)), edge("c", "tail", moved(1)))
    assert refusal(frames, "a", "tail") == "the frames 'a' and 'b' and 'c' hang on each other in a loop"
    assert refusal(buffer_of(edge("a", "a", moved(1))), "a", "a") == "the frames 'a' hang on each other in a loop"


def test_a_frame_that_gets_another_parent_has_moved_there():
    frames = buffer_of(edge("world", "base", moved(1), 1.0), edge("ship", "base", moved(2), 2.0))
    assert frames.lookup("ship", "base").translation[0] == 2
    assert "not in one tree" in refusal(frames, "world", "base")


def test_only_transforms_are_taken():
    with pytest.raises(TypeError, match="Imu is no transform"):
        FrameBuffer().add(Imu())


def test_a_quaternion_that_is_not_of_length_one_still_only_turns():
    frames = buffer_of(FrameTransform(parent_frame_id="a", child_frame_id="b", rotation=Quaternion(w=2.0, z=2.0)))
    assert frames.lookup("a", "b").rotation == pytest.approx(from_euler(0, 0, np.pi / 2))
