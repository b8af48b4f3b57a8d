"""What the library and the messages both hold, since neither may know the other, is the same on both sides."""

from schemas import limits
from schemas.messages import Fence
from schemas.topics import SYSTEM
from uvf.models import names
from uvf.models.mission.fence import MOST_VERTICES, MOST_ZONES, FenceAction
from uvf.planning.global_planner import MOST_POINTS


def test_names_are_held_to_the_same_patterns():
    assert (names.VEHICLE, names.FOLDER, names.SYSTEM) == (limits.VEHICLE, limits.FOLDER, SYSTEM)


def test_a_fence_fits_into_its_message():
    assert limits.LENGTHS["uvf.v1.Fence.zones"] == MOST_ZONES
    assert limits.LENGTHS["uvf.v1.FenceZone.vertices"] == MOST_VERTICES
    assert {action.name: action.value for action in FenceAction} == dict(Fence.Action.items())


def test_a_path_fits_into_its_message():
    assert limits.LENGTHS["foxglove.PosesInFrame.poses"] == MOST_POINTS
