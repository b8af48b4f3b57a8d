"""A fence in a mission file: read, refused with the reason, and the same again as a message."""

import math

import numpy as np
import pytest
import yaml

from schemas.messages import Fence, FenceRequest, FenceZone, Vector3
from uvf.models.mission.fence import MOST_VERTICES, MOST_ZONES, OPEN, FenceFile
from uvf.models.mission.file import load_mission
from uvf.models.scenario import ROOT
from uvf.models.yaml_data import BadInput
from uvf.runtime.messages.plans.fences import fence_fault, fence_message, fencing
from uvf.runtime.messages.validation import error_in

FENCE = {
    "zones": [{"polygon": [[-500, -500], [500, -500], [500, 500], [-500, 500]]}, {"circle": [100, 0, 50], "exclude": True}],
    "floor": 20,
    "ceiling": 120,
    "action": "hold",
}


def mission(tmp_path, fence):
    data = yaml.safe_load((ROOT / "missions" / "demo.yaml").read_text())
    data["vehicles"]["milvus"]["fence"] = fence
    path = tmp_path / "m.yaml"
    path.write_text(yaml.safe_dump(data))
    return load_mission(path)


def test_a_fence_of_a_file_is_the_region_that_was_meant(tmp_path):
    made = fencing(fence_message(mission(tmp_path, FENCE).vehicles["milvus"].fence, "here"))
    assert [made.region.at(p) for p in ((0.0, 0.0), (100.0, 0.0), (0.0, 490.0))] == pytest.approx([50.0, -50.0, 10.0])
    assert (made.floor, made.ceiling, made.action) == (20.0, 120.0, Fence.HOLD)


def test_without_one_everything_is_open(tmp_path):
    assert fencing(fence_message(FenceFile(), "here")).is_open and OPEN.is_open
    assert not fencing(Fence(ceiling=100.0)).is_open


def test_a_limit_of_zero_is_a_limit():
    made = fencing(Fence(floor=0.0))
    assert (made.floor, made.ceiling) == (0.0, math.inf)


@pytest.mark.parametrize(
    ("change", "why"),
    [
        ({"ceilling": 5}, "did you mean 'ceiling'"),
        ({"floor": 200}, "not below the ceiling"),
        ({"zones": [{"polygon": [[0, 0], [1, 1]]}]}, "polygon of 2 corners"),
        ({"zones": [{"polygon": [[0, 0], [9, 9], [9, 0], [0, 9]]}]}, "cross each other"),
        ({"zones": [{"polygon": [[0, 0], [9, 9], [9, 0]], "circle": [0, 0, 1]}]}, "one of the two"),
        ({"zones": [{}]}, "one of the two"),
        ({"zones": [{"circle": [0, 0, -1]}]}, "circle"),
        ({"action": "explode"}, "no 'explode' here"),
    ],
)
def test_what_cannot_be_meant_is_refused(tmp_path, change, why):
    with pytest.raises(BadInput, match=why):
        mission(tmp_path, {**FENCE, **change})


def test_messages_from_elsewhere_are_looked_at_too():
    assert "circle of no size" in fence_fault(Fence(zones=[FenceZone()]))
    assert "32 are possible" in fence_fault(Fence(zones=[FenceZone(radius=1.0)] * 33))
    assert "no action 9" in fence_fault(Fence(action=9))
    assert fence_fault(Fence(zones=[FenceZone(vertices=[Vector3(), Vector3(x=1.0), Vector3(y=1.0)])])) == ""


def test_zones_of_one_group_count_together_and_those_of_a_file_each_alone(tmp_path):
    left, right = FenceZone(radius=10.0), FenceZone(centre=Vector3(x=15.0), radius=10.0)
    together = fencing(Fence(zones=[left, right])).region
    assert together.at((7.5, 0.0)) > 0 > together.at((-5.0, 0.0))
    other = FenceZone(centre=Vector3(x=-5.0), radius=3.0, group=1)
    assert fencing(Fence(zones=[left, right, other])).region.at((-5.0, 0.0)) == pytest.approx(3.0)
    zones = [{"circle": [0, 0, 10]}, {"circle": [15, 0, 10]}]
    alone = fencing(fence_message(mission(tmp_path, {"zones": zones}).vehicles["milvus"].fence, "here")).region
    assert alone.at((-5.0, 0.0)) > 0 and alone.at((20.0, 0.0)) > 0


def test_a_fence_that_is_disabled_is_kept_and_keeps_nothing_out():
    fence = Fence(zones=[FenceZone(radius=10.0)], disabled=True)
    assert fence_fault(fence) == "" and fencing(fence).is_open


def test_what_no_autopilot_could_have_is_no_message_either():
    """Who draws or follows a fence need not look how large it is."""
    polygon = FenceZone(vertices=[Vector3(x=math.cos(a), y=math.sin(a)) for a in np.linspace(0.0, 6.0, MOST_VERTICES)])
    largest = Fence(zones=[polygon] * MOST_ZONES)
    assert fence_fault(largest) == error_in(largest) == ""
    assert "zones: 33 entries" in error_in(Fence(zones=[FenceZone(radius=1.0)] * 33))
    assert "vertices: 129 entries" in error_in(FenceRequest(fence=Fence(zones=[FenceZone(vertices=[Vector3()] * 129)])))
