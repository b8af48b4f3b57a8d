"""A home that moves to another height leaves plans where they are, and what is read back says where that is."""

import pytest

from schemas.messages import Vector3
from tests.services.autopilot.mavlink.missions.test_missions import LAT, LON, NAN, PLAN, content, download, item, upload
from tests.services.autopilot.mavlink.rig import Rig
from tests.services.autopilot.mavlink.test_fence_and_rally import item as plan_item
from uvf.mavlink import dialect as mav

ABOVE_HOME, AMSL = 3, 0
RETURN_POINT, RALLY_POINT = 5000, 5100


def moved(rig, z):
    rig.plane.status.home.CopyFrom(Vector3(z=z))
    rig.run()


def of_kind(kind):
    if kind == mav.MAV_MISSION_TYPE_MISSION:
        return item(0, frame=ABOVE_HOME, place=(LAT, LON, 80.0))
    command = RETURN_POINT if kind == mav.MAV_MISSION_TYPE_FENCE else RALLY_POINT
    return plan_item(0, command=command, frame=ABOVE_HOME, place=(LAT, LON, 80.0), kind=kind)


@pytest.mark.parametrize("kind", range(3))
def test_a_height_above_home_is_read_back_above_the_home_of_now(kind):
    rig = Rig()
    rig.run()
    assert upload(rig, [of_kind(kind)], kind=kind)[0].type == mav.MAV_MISSION_ACCEPTED
    moved(rig, 60.0)  # it was at 20 m
    (told,) = download(rig, kind=kind)
    assert told.z == pytest.approx(40.0) and (told.frame, told.x, told.y) == (ABOVE_HOME, LAT, LON)
    moved(rig, 20.0)
    (told,) = download(rig, kind=kind)
    assert content(told) == content(of_kind(kind))


def test_all_else_of_such_an_item_comes_back_as_it_was():
    rig = Rig()
    rig.run()
    plan = [item(0), item(1, command=19, p=(30.0, 1.0, -90.0, 1.0)), item(2, frame=AMSL, place=(LAT, LON, 412.3)), *PLAN[3:]]
    plan = [item(n, m.command, m.frame, (m.param1, m.param2, m.param3, m.param4), (m.x, m.y, m.z)) for n, m in enumerate(plan)]
    upload(rig, plan)
    moved(rig, 50.0)
    for was, told in zip(plan, download(rig), strict=True):
        was.z -= 30.0 if was.frame in (3, 6) else 0.0
        assert (told.command, told.frame, told.param1, told.param2, told.param3) == (
            was.command,
            was.frame,
            was.param1,
            was.param2,
            was.param3,
        )
        assert told.z == pytest.approx(was.z, abs=1e-4)


def test_a_home_that_becomes_known_later_changes_nothing_that_was_uploaded_above_sea_level():
    rig = Rig()
    rig.run()
    upload(rig, [item(0, frame=AMSL, p=(0.0, 0.0, 0.0, NAN), place=(LAT, LON, 412.3))])
    moved(rig, 99.0)
    (told,) = download(rig)
    assert told.frame == AMSL and told.z == pytest.approx(412.3)
