"""The mission of a formation flown for a minute on noisy sensors, in wind and light turbulence: stations are kept, nobody comes near."""

import pytest

from launch.scoring.scores import Scorer
from schemas import topics
from schemas.messages import Mode, VehicleStatus
from services.autopilot.air import build as autopilot
from services.sim_air import build as sim_air
from uvf.models.scenario import ROOT, load_scenario
from uvf.runtime.time.lockstep import Lockstep

pytestmark = pytest.mark.timeout(300)
SECONDS = 60.0
FOLLOWERS = ("milvus2", "milvus3")


@pytest.fixture(scope="module")
def flown():
    site = load_scenario(ROOT / "missions" / "formation.yaml")
    lockstep, scorer, modes = Lockstep([*sim_air.build(site), *autopilot.hosts(site)]), Scorer(site), {}
    scorer.follow(lockstep.bus)

    def heard(sample):
        modes.setdefault(sample.key.split("/")[1], set()).add(VehicleStatus.FromString(sample.payload).mode)

    lockstep.bus.subscribe(topics.STATUS.at("*"), topics.STATUS.qos, heard)
    lockstep.run(SECONDS)
    lockstep.close()
    return scorer, modes


def value(flown, vehicle, measure):
    return flown[0].measure(vehicle, measure).value


def test_the_followers_follow_all_the_time(flown):
    assert flown[1] == {"milvus1": {Mode.MODE_MISSION}} | {name: {Mode.MODE_FOLLOW} for name in FOLLOWERS}


@pytest.mark.parametrize("follower", FOLLOWERS)
def test_a_station_is_kept(flown, follower):
    assert value(flown, follower, "spacing_error") < 2.0
    assert value(flown, follower, "station_error") < 4.0


@pytest.mark.parametrize("name", ["milvus1", *FOLLOWERS])
def test_nobody_comes_near(flown, name):
    assert value(flown, name, "separation") > 15.0
