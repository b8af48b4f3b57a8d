"""Who follows whom: what a mission may ask for, and what it is refused with."""

import pytest
import yaml

from services.autopilot.air import build as air
from services.autopilot.air.service import AutopilotWingman
from uvf.models.mission.file import load_mission
from uvf.models.mission.formation import Follow, offset_of
from uvf.models.scenario import ROOT, load_scenario
from uvf.models.yaml_data import BadInput


def write(folder, follows, **vehicle):
    """Aircraft a, b, c, with these ``follow`` entries, and a rover."""
    vehicles = {}
    for i, name in enumerate("abc"):
        job = {"follow": follows[name]} if name in follows else {}
        vehicles[name] = {"model": "milvus", "system_id": i + 1, "start": {"x": -100.0 * i, "y": 0.0, "z": 60.0, "speed": 25.0}, "job": job}
    vehicles["rover"] = {"model": "burger", "system_id": 9, "start": {"x": 0.0, "y": 5.0}}
    vehicles["b"] |= vehicle
    path = folder / "mission.yaml"
    path.write_text(yaml.safe_dump({"about": "a formation", "world": "empty", "vehicles": vehicles}))
    return path


def test_a_formation_is_made_of_followers(tmp_path):
    follows = {"b": {"leader": "a", "behind": 40.0, "right": 15.0, "above": 5.0}, "c": {"leader": "b", "behind": 40.0}}
    site = load_scenario(write(tmp_path, follows), ROOT)
    kinds = {host.vehicle: host.service for host in air.hosts(site)}
    assert [name for name, kind in kinds.items() if kind is AutopilotWingman] == ["b", "c"]
    assert offset_of("c", {n: m.entry.job.follow for n, m in site.members.items() if m.entry.job.follow}) == (80.0, 15.0, 5.0)


@pytest.mark.parametrize(
    ("follows", "said"),
    [
        ({"b": {"leader": "aa", "behind": 40}}, "no vehicle 'aa'; did you mean 'a'?"),
        ({"b": {"leader": "b", "behind": 40}}, "b cannot follow itself"),
        ({"b": {"leader": "c", "behind": 40}, "c": {"leader": "b", "behind": 40}}, "b follows c follows b: a circle without a leader"),
        ({"b": {"leader": "a", "behnd": 40}}, "unknown key 'behnd'; did you mean 'behind'?"),
        ({"b": {"leader": "a", "behind": -40}}, "behind"),
    ],
)
def test_what_is_no_formation_is_refused(tmp_path, follows, said):
    with pytest.raises(BadInput) as refused:
        load_mission(write(tmp_path, follows))
    assert said in str(refused.value) and "mission.yaml:" in str(refused.value)


def test_a_follower_has_no_mission_of_its_own(tmp_path):
    job = {"follow": {"leader": "a", "behind": 40}, "mission": [{"x": 0, "y": 0, "z": 60}]}
    with pytest.raises(BadInput, match="mission of its own"):
        load_mission(write(tmp_path, {}, job=job))


@pytest.mark.parametrize(
    ("follows", "said"),
    [
        ({"b": {"leader": "rover", "behind": 40}}, "rover is no aircraft"),
        ({"b": {"leader": "a", "behind": 20}}, "20 m is too near behind a; give 25 m or more"),
        (
            {"b": {"leader": "a", "behind": 40}, "c": {"leader": "a", "behind": 45}},
            "5.0 m from c; stations of a formation are 10 m apart or more",
        ),
    ],
)
def test_a_station_that_cannot_be_kept_is_refused(tmp_path, follows, said):
    site = load_scenario(write(tmp_path, follows), ROOT)
    with pytest.raises(BadInput) as refused:
        air.hosts(site)
    assert said in str(refused.value)


def test_offsets_add_up_along_a_chain():
    follows = {"b": Follow("a", 40, 5, 1), "c": Follow("b", 30, -2, 2), "d": Follow("c", 30, 0, 0)}
    assert offset_of("d", follows) == (100, 3, 3)
    assert offset_of("a", follows) == (0, 0, 0)
