"""What is left of an aircraft falls to the ground and lies there."""

import copy

import numpy as np
import pytest

from schemas import topics
from schemas.messages import Event, NavState
from services.sim_air.build import build
from services.sim_air.contact.crash import FALLING, Resting, Wreck
from services.sim_air.engine.states import Air, AircraftMotion
from services.sim_air.environment.ground import LEVEL, GroundSurface
from uvf.maths.bvh import build as tree_over
from uvf.maths.geodesy import GRAVITY
from uvf.maths.rotations import from_euler
from uvf.maths.solids import box
from uvf.models.scenario import load_scenario
from uvf.models.shapes.scene import scene
from uvf.models.shapes.solid import Solid
from uvf.runtime.messages.convert import array
from uvf.runtime.time.lockstep import Lockstep

HULL = tree_over(box((1.6, 2.9, 0.4), np.zeros(3)))
DT = 1 / 240


def wreck(height, velocity=(0.0, 0.0, 0.0), ground=LEVEL, turning=(0.0, 0.0, 0.0)):
    motion = AircraftMotion(
        np.array((0.0, 0.0, height)), np.array(velocity), from_euler(0.0, 0.0, 0.0), np.array(turning), np.zeros(3), 25.0
    )
    return Wreck(motion, Air(100_000.0, 400.0, 288.0), [], Resting(ground, HULL))


def fallen(one, seconds):
    for _ in range(round(seconds / DT)):
        one.fall(DT)
    return one


def test_a_short_fall_is_free():
    one = fallen(wreck(100.0), 0.5)
    assert one.motion.position[2] == pytest.approx(100.0 - GRAVITY * 0.5**2 / 2, abs=0.03)
    assert np.linalg.norm(one.motion.specific_force) < 0.5


def test_a_long_fall_comes_to_its_greatest_speed_and_the_air_gets_denser():
    one = fallen(wreck(1000.0), 20.0)
    assert one.motion.velocity[2] == pytest.approx(-FALLING, rel=1e-3)
    assert np.linalg.norm(one.motion.specific_force) == pytest.approx(GRAVITY, rel=1e-2)
    assert one.air.static_pressure - 100_000.0 == pytest.approx(1.2 * GRAVITY * (1000.0 - one.motion.position[2]))


def test_drag_takes_its_way_forward():
    """Terminal in the end: of a body with quadratic drag the forward speed dies out."""
    one = fallen(wreck(1000.0, (25.0, 0.0, 0.0)), 15.0)
    assert abs(one.motion.velocity[0]) < 0.5
    assert 60.0 < one.motion.position[0] < 90.0  # of 375 m without drag; the drag works over FALLING^2 / g = 64 m


def test_it_lies_on_the_lowest_corner_of_what_it_was_whatever_lies_below():
    roof = GroundSurface(scene([Solid("roof", "box", (20.0, 20.0, 3.0), np.array((0.0, 0.0, 1.5)))]))
    for ground, height in ((LEVEL, 0.0), (roof, 3.0)):
        one = fallen(wreck(30.0, ground=ground, turning=(0.3, 0.5, 0.1)), 10.0)
        assert Resting(ground, HULL).above(one.motion.position, one.motion.world_from_body) == pytest.approx(0.0, abs=1e-9)
        assert height < one.motion.position[2] < height + 1.7
        assert one.motion.velocity.tolist() == one.motion.angular_velocity.tolist() == [0.0, 0.0, 0.0]
        before = copy.deepcopy(one).motion.position
        assert fallen(one, 1.0).motion.position.tolist() == before.tolist()


def test_two_aircraft_that_meet_in_the_air_fall_to_the_ground(tmp_path):
    path = tmp_path / "meet.yaml"
    path.write_text(
        "about: Head on.\nworld: empty\nwind: {steady: [0.0, 0.0, 0.0]}\nvehicles:\n"
        "  one: {model: milvus, system_id: 1, start: {x: -60.0, y: 0.0, z: 60.0, speed: 25.0}}\n"
        "  two: {model: milvus, system_id: 2, start: {x: 60.0, y: 0.3, z: 60.0, yaw: 3.14159, speed: 25.0}}\n"
    )
    lockstep, events, truth = Lockstep(build(load_scenario(path))), [], {}
    for name in ("one", "two"):
        said = topics.EVENTS.by("sim_air")
        lockstep.bus.subscribe(said.at(name), said.qos, lambda s: events.append(Event.FromString(s.payload)))
        lockstep.bus.subscribe(
            topics.TRUTH.at(name), topics.TRUTH.qos, lambda s, name=name: truth.setdefault(name, []).append(NavState.FromString(s.payload))
        )
    lockstep.run(12.0)
    lockstep.close()
    assert len(events) == 1
    for told in truth.values():
        heights = np.array([t.position.z for t in told])
        assert heights[:100].min() > 55.0
        assert np.diff(heights[150:]).max() < 0.02
        assert 0.0 < heights[-1] < 1.6
        assert array(told[-1].velocity).tolist() == [0.0, 0.0, 0.0]
