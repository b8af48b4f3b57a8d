"""Maps that nobody draws, or nobody can use, are told when the mission is loaded."""

import pytest

from uvf.models.mission.task_needs import check_shares
from uvf.models.mission.tasks import ShareMapTask, Task
from uvf.models.yaml_data import BadInput, FileLocation

KINDS = {"eye": "fixed_wing", "anne": "ground", "bert": "ground"}
AREA = (0.0, 0.0, 1.0, 1.0)


def checked(**share):
    check_shares([Task(sequence=[Task(share_map=ShareMapTask(**share))])], {"team": ["anne", "bert"]}, KINDS, FileLocation("m.yaml"))


def test_heights_from_the_air_and_grids_of_rovers_are_handed_to_rovers():
    checked(vehicle="eye", to="team", area=AREA)
    checked(vehicle="anne", to="bert", layer="grid")


@pytest.mark.parametrize(
    ("share", "why"),
    [
        ({"vehicle": "anne", "to": "bert"}, r"layer: anne has no heights; a ground vehicle has its grid"),
        ({"vehicle": "eye", "to": "bert", "layer": "grid"}, r"layer: eye has no grid; a fixed_wing vehicle has its heights"),
        ({"vehicle": "eye", "to": ["team", "eye"]}, r"to: eye does not drive"),
        ({"vehicle": "anne", "to": "bert", "layer": "grid", "area": AREA}, r"area: a grid is handed over as a whole"),
    ],
)
def test_what_cannot_be_is_one_line(share, why):
    with pytest.raises(BadInput, match=why):
        checked(**share)
