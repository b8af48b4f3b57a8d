"""Drives and springs of joints in the physics: speeds, efforts, what stays where it is, and a saved state."""

import numpy as np
import pytest

from services.sim_ground.loading import BodyPlacement
from services.sim_ground.world import BulletWorld
from tests.services.mast import LIFT, MAST, PAN, arm_urdf, mast_folder, mast_urdf
from uvf.models.urdf.model import engine_urdf
from uvf.models.vehicle.file import load_vehicle

ARM = [f"joint_{n}" for n in range(1, 5)]


@pytest.fixture
def made(tmp_path):
    """Makes a world with one vehicle; all of them are closed at the end."""
    worlds = []

    def make(urdf="", **ground):
        folder = mast_folder(tmp_path, urdf, ground={**MAST["ground"], **ground}, sensors={})
        body = load_vehicle(folder.parent, "mast").ground
        worlds.append(BulletWorld([], {"mast": BodyPlacement(body, engine_urdf(folder / body.urdf), (0.0, 0.0, 0.0))}))
        return worlds[-1]

    yield make
    for world in worlds:
        world.close()


def at(world, names):
    return dict(zip(names, (position for position, _ in world.state("mast").joints), strict=False))


@pytest.mark.parametrize(("effort", "rises"), [(3.0, False), (6.0, True)])
def test_what_is_too_heavy_for_its_effort_is_not_lifted(made, effort, rises):
    """It carries 0.4 kg, which is 3.9 N."""
    world = made(mast_urdf(lift=f'<limit lower="0" upper="0.3" velocity="0.1" effort="{effort}"/>'))
    world.advance({}, 4.0, joints={"mast": {LIFT: 0.2}})
    assert at(world, [LIFT])[LIFT] == pytest.approx(0.2 if rises else 0.0, abs=5e-3)


def test_nothing_goes_beyond_its_range_nor_faster_than_it_can(made):
    world = made()
    world.advance({}, 1.0, joints={"mast": {LIFT: 9.0, PAN: 3.0}})
    there = at(world, [LIFT, PAN])
    assert there[LIFT] == pytest.approx(0.1, abs=0.01) and there[PAN] == pytest.approx(1.0, abs=0.06)
    world.advance({}, 5.0, joints={"mast": {LIFT: 9.0}})
    assert at(world, [LIFT])[LIFT] == pytest.approx(0.3, abs=2e-3)


def test_without_a_word_everything_stays(made):
    world = made()
    world.advance({}, 1.5, joints={"mast": {LIFT: 0.2, PAN: 3.0}})
    before = world.state("mast").joints
    world.advance({}, 3.0)
    assert [p for p, _ in world.state("mast").joints][:2] == pytest.approx([p for p, _ in before][:2], abs=0.06)
    assert [v for _, v in world.state("mast").joints] == pytest.approx([0.0] * 3, abs=1e-3)


def test_joints_named_nowhere_are_held_at_zero_under_any_load(made):
    world = made(mast_urdf(tray_mass=5.0), springs={}, joints=[])
    world.advance({}, 3.0)
    engine, index = world.engine, world._vehicles["mast"].index
    (tray,) = engine.joint_motions(index, [engine.joints(index)["tray_joint"]])
    assert tray.angle == pytest.approx(0.0, abs=1e-3)


def test_a_spring_swings_at_its_own_frequency(made):
    """0.2 kg on 20 N/m: 10 rad/s."""
    world, seen = made(springs={"tray_joint": {"stiffness": 20.0, "damping": 0.05, "rest": 0.09}}), []
    for _ in range(400):
        world.advance({}, 0.01)
        seen.append(world.state("mast").joints[-1][0])
    mean = np.mean(seen[100:])
    crossings = np.flatnonzero(np.diff(np.sign(np.array(seen) - mean)))
    assert np.pi / (np.mean(np.diff(crossings)) * 0.01) == pytest.approx(10.0, rel=0.05)


def test_it_stands_where_it_is_while_it_holds_an_arm_out(made):
    world = made(arm_urdf(), joints=ARM, springs={})
    held = {"mast": dict(zip(ARM, (1.8, 0.3, -0.9, 0.5), strict=True))}
    world.advance({}, 3.0, joints=held)
    before = world.state("mast")
    world.advance({}, 10.0, joints=held)
    after = world.state("mast")
    assert np.linalg.norm(after.position - before.position) < 1e-3
    assert np.abs(after.world_from_body - before.world_from_body).max() < 1e-3


def test_a_restored_state_goes_on_with_the_joints_where_they_were(made):
    world = made()

    def onward():
        for _ in range(20):
            world.advance({}, 0.05, joints={"mast": {LIFT: 0.3, PAN: -1.0}})
        return world.state("mast")

    world.advance({}, 0.7, joints={"mast": {LIFT: 0.2, PAN: 1.0}})
    saved = world.save()
    first = onward()
    world.restore(saved)
    again = onward()
    assert first.joints == again.joints and np.array_equal(first.position, again.position)
