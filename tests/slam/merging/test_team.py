"""Sessions of robots that know nothing of each other become one map where they have been at the same places, and only there."""

from dataclasses import replace

import numpy as np
import pytest

from tests.slam.merging.offices import BERT, anne, bert, first, mapped, off_by
from uvf.maths.se2 import IDENTITY, Pose2
from uvf.maths.se2_arrays import composed
from uvf.models.yaml_data import BadInput
from uvf.slam.maps.session import NO_EDGES, MappingSession
from uvf.slam.merging.part import VehicleMap
from uvf.slam.merging.team import Team
from uvf.slam.method import Keyframe
from uvf.slam.reading import Beams, Reading


def team_of(**sessions):
    team = Team()
    for name, session in sessions.items():
        team.follow(name, session)
    team.finish()
    return team


@pytest.fixture(scope="module")
def joined():
    return team_of(anne=anne().session, bert=bert().session)


def test_two_robots_that_have_driven_along_the_same_corridors_are_joined(joined):
    assert [group.names for group in joined.groups] == [("anne", "bert")]
    assert joined.team_from_map("anne") == pytest.approx((0.0, 0.0, 0.0), abs=0.02)
    metres, radians = off_by(joined.team_from_map("bert"), anne().map_from(bert()))
    assert metres < 0.1 and radians < 0.01
    assert joined.groups[0].quality > 0.8


def test_the_merged_session_holds_every_keyframe_where_it_was_taken(joined, tmp_path):
    joined.session_of(joined.groups[0]).save(tmp_path / "team.npz")
    merged, parts = MappingSession.load(tmp_path / "team.npz"), (anne().session, bert().session)
    assert len(merged.keyframes) == sum(len(part.keyframes) for part in parts)
    assert len(merged.edges.kinds) == sum(len(part.edges.kinds) for part in parts) + len(joined.groups[0].joint.crossings)
    own = np.array([k.map_from_base for k in parts[1].keyframes])
    found = np.array([k.map_from_base for k in merged.keyframes])[-len(own) :]
    away = found - composed(np.array(anne().map_from(bert())), own)
    assert np.hypot(away[:, 0], away[:, 1]).max() < 0.15


def test_a_building_of_the_same_corridors_with_other_doors_is_another_building():
    for other in (2, 3):
        apart = team_of(anne=anne().session, bert=bert(other).session)
        assert [group.names for group in apart.groups] == [("anne",), ("bert",)]
        assert apart.team_from_map("bert") == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)


def test_who_fits_nowhere_stays_alone_beside_those_who_fit():
    team = team_of(stranger=bert(2).session, anne=anne().session, bert=bert().session)
    assert sorted(group.names for group in team.groups) == [("anne", "bert"), ("stranger",)]


def test_sessions_that_grow_are_joined_once_they_have_met_and_grow_on_together():
    team, counts = Team(), []
    for n in range(30, 200, 24):
        team.follow("anne", first(anne().session, min(n, len(anne().session.keyframes))))
        team.follow("bert", first(bert().session, min(n, len(bert().session.keyframes))))
        for _ in range(3):
            team.work(6)
        counts.append(len(team.groups))
    assert counts[0] == 2 and counts[-1] == 1
    assert all(len(team.groups[0].joint.poses[name]) == len(part) for name, part in team.parts.items())
    metres, radians = off_by(team.team_from_map("bert"), anne().map_from(bert()))
    assert metres < 0.15 and radians < 0.015


def test_nothing_new_is_no_work(joined):
    joined.follow("anne", anne().session)
    assert not joined.work(6)


def test_a_session_begun_anew_leaves_the_group():
    team = team_of(anne=anne().session, bert=bert().session)
    team.follow("anne", first(bert(2).session, 20))
    team.work(0)
    assert sorted(group.names for group in team.groups) == [("anne",), ("bert",)]
    assert len(team.parts["anne"]) == 20


def test_those_who_are_left_by_the_first_are_in_the_frame_of_the_next():
    team = team_of(anne=anne().session, bert=bert().session, carl=mapped(BERT, 1, 5).session)
    before = team.groups[0].quality
    team.follow("anne", first(bert(2).session, 20))
    (left,) = (group for group in team.groups if group.names == ("bert", "carl"))
    assert team.team_from_map("bert") == pytest.approx((0.0, 0.0, 0.0), abs=0.02)
    metres, radians = off_by(team.team_from_map("carl"), IDENTITY)
    assert metres < 0.1 and radians < 0.01
    assert {c.a for c in left.joint.crossings} | {c.b for c in left.joint.crossings} == {"bert", "carl"}
    assert 0.7 < left.quality < 1.0 and left.quality != before


def test_sessions_with_hardly_anything_in_them_are_no_trouble():
    team = team_of(anne=anne().session, empty=first(bert().session, 0), one=first(bert().session, 1))
    assert sorted(group.names for group in team.groups) == [("anne",), ("empty",), ("one",)]


def test_edges_that_make_no_graph_are_refused_in_one_line():
    session = first(anne().session, 5)
    wrong = session.edges.information.copy()
    wrong[2] = -np.eye(3)
    with pytest.raises(BadInput, match="session anne: edge 2 -> 3: information is no inverse covariance"):
        Team().follow("anne", replace(session, edges=replace(session.edges, information=wrong)))


def test_a_session_in_pieces_is_refused_for_nothing_tells_how_they_lie_to_each_other():
    session = anne().session
    cut = replace(session.edges, enabled=session.edges.ends.max(axis=1) != 50)
    with pytest.raises(BadInput, match=r"session anne: edges leave it in [23] pieces"):
        Team().follow("anne", replace(session, edges=cut))


def test_a_session_too_large_to_be_searched_in_is_refused_in_one_line():
    session = anne().session
    wide = tuple(replace(k, map_from_base=Pose2(1e4 * k.map_from_base.x, 1e4 * k.map_from_base.y, 0.0)) for k in session.keyframes)
    with pytest.raises(BadInput, match=r"session anne: of .* m, too large to be merged"):
        Team().follow("anne", replace(session, keyframes=wide))


def test_keyframes_beside_the_field_make_no_floor_far_from_them():
    """One wall, seen from so far away that the vehicle is not near any of it."""
    lidar = Beams((0.0, 0.0), np.radians(np.linspace(-10.0, 10.0, 41)), 0.1, 30.0)
    reading = Reading(0.0, 20.0 / np.cos(lidar.bearings), lidar, IDENTITY)
    part = VehicleMap("anne")
    part.follow(MappingSession((Keyframe(IDENTITY, reading),), NO_EDGES, "graph", {}))
    assert not part.near.any()


def test_the_frame_of_a_session_does_not_matter():
    team = team_of(anne=anne().session, bert=bert().session.moved(Pose2(100.0, -40.0, 2.0)))
    team_from_first = Pose2(*team.groups[0].joint.poses["bert"][0].tolist())
    metres, radians = off_by(team_from_first, anne().map_from(bert()))
    assert metres < 0.1 and radians < 0.01
