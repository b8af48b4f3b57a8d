"""Which instances the mission gets, and what is refused before anything runs."""

from dataclasses import replace

import msgspec
import pytest

from schemas.messages import Mode
from services.autopilot.ground.build import hosts
from services.autopilot.ground.service import GroundAutopilot
from services.planner.build import build as build_planner
from services.slam import build as slam_build
from services.slam.build import build as build_slam
from tests.runtime.stepping import stepped
from tests.stops import NOBODY
from uvf.models.mission.file import JobFile, Waypoint
from uvf.models.scenario import ROOT, load_scenario
from uvf.models.yaml_data import BadInput

BUILDS = (build_slam, build_planner, hosts)


@pytest.fixture
def site():
    return load_scenario(ROOT / "missions" / "demo.yaml")


def with_burger(site, **changes):
    return replace(site, members={**site.members, "burger": replace(site.members["burger"], **changes)})


def with_job(site, **job):
    return with_burger(site, entry=msgspec.structs.replace(site.members["burger"].entry, job=JobFile(**job)))


def test_only_ground_vehicles_get_them(site):
    found = [(host.vehicle, host.service.name) for build in BUILDS for host in build(site)]
    names = ("odometry", "mapping", "map_server", "planner", "tracker", "autopilot_ground")
    assert found == [("burger", name) for name in names]


def test_each_is_made_afresh(site):
    for host in [h for build in BUILDS for h in build(site)]:
        assert host.make() is not host.make()


def test_kernels_are_compiled_once_for_all_vehicles_of_a_method(site, monkeypatch):
    warmed = []
    monkeypatch.setattr(slam_build, "warm_up", warmed.append)
    build_slam(replace(site, members={**site.members, "second": replace(site.members["burger"], name="second")}))
    assert len(warmed) == 1


def test_a_method_is_made_for_the_warm_up_and_for_each_instance_and_no_more(site, monkeypatch):
    made, make = [], slam_build.make_method
    monkeypatch.setattr(slam_build, "make_method", lambda *of: made.append(of) or make(*of))
    hosts = build_slam(replace(site, members={**site.members, "second": replace(site.members["burger"], name="second")}))
    assert len(made) == 1
    for host in hosts:
        host.make()
    assert len(made) == 3


def test_a_mission_without_ground_vehicles_gets_none(site):
    air = replace(site, members={n: m for n, m in site.members.items() if m.file.kind != "ground"})
    assert [host for build in BUILDS for host in build(air)] == []


@pytest.mark.parametrize("build", [build_slam, build_planner])
def test_a_vehicle_without_lidar_is_refused(site, build):
    file = site.members["burger"].file
    blind = msgspec.structs.replace(file, sensors=msgspec.structs.replace(file.sensors, lidar=None))
    with pytest.raises(BadInput, match="lidar"):
        build(with_burger(site, file=blind))


def test_an_unknown_parameter_is_named_with_the_nearest_one(site):
    file = msgspec.structs.replace(site.members["burger"].file, params={"tracker": {"sped": 0.3}})
    with pytest.raises(BadInput, match="did you mean 'speed'"):
        build_planner(with_burger(site, file=file))


def test_a_flying_mission_is_refused_for_a_ground_vehicle(site):
    with pytest.raises(BadInput, match="item 0: ORBIT is not for a ground vehicle"):
        hosts(with_job(site, mission=[Waypoint(kind="orbit", radius=50.0)]))


def test_a_vehicle_with_a_job_begins_armed_and_one_without_does_not(site):
    nothing = dict.fromkeys(
        ("teleop", "mavlink", "gcs", "client", "executive", "offboard", "planner", "pose", "link", "ticks", "scan", "correction", "battery")
    )
    asked = {"imu": [], "stop": NOBODY, **{request: [] for request in GroundAutopilot.requests}}
    for job, armed, mode in (({"explore": True}, True, Mode.MODE_MISSION), ({}, False, Mode.MODE_HOLD)):
        status = stepped(hosts(with_job(site, **job))[0].make(), 0.02, **nothing, **asked)["status"]
        assert (status.armed, status.mode) == (armed, mode)
