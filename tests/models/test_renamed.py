"""Who writes a name of before is told the name of now."""

import pytest

from schemas import topics
from services.planner.planner_service import PlannerParams
from uvf.models.renamed import RENAMED
from uvf.models.yaml_data import BadInput, convert, nearest

OF_THE_PLANNER = {old: new for old, new in RENAMED.items() if new in PlannerParams.__struct_fields__}


@pytest.mark.parametrize("old", OF_THE_PLANNER)
def test_an_old_parameter_in_a_file_is_answered_by_the_new_one(old):
    with pytest.raises(BadInput, match=f"unknown key '{old}'; it is called '{OF_THE_PLANNER[old]}' now"):
        convert({old: 0.5}, PlannerParams, "vehicle.yaml", ("params", "planner"))


def test_no_name_is_both_old_and_new():
    assert not set(RENAMED) & set(RENAMED.values())


@pytest.mark.parametrize(("old", "new"), [("burger/nav/fix", "burger/nav/map_pose"), ("<owner>/srv/order", "<owner>/srv/vehicle_command")])
def test_an_old_topic_is_answered_by_the_new_one(old, new):
    assert nearest(old, [new, "burger/nav/pose"]) == f"it is called '{new}' now"


def test_a_key_that_has_moved_into_a_section_is_told_with_it():
    assert nearest("left_joint", ("urdf", "drive", "radius")) == "it is called 'drive: left' now"
    assert nearest("track", ("urdf", "radius")) != "it is called 'drive: track' now"


def test_the_new_names_of_topics_are_in_the_table():
    known = {t.key for t in (*topics.TOPICS.values(), *topics.REQUESTS.values())}
    assert {f"<owner>/{new}" for old, new in RENAMED.items() if "/" in old} <= known
