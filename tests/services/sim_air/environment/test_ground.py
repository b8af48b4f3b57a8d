"""Aircraft stand on and fly over what stands in the world: terrain, platforms, roofs; all instruments agree about it."""

import numpy as np
import pytest

from benchmarks.sim.air.milvus.coefficients import BODY, FOLDER
from schemas import topics
from schemas.messages import Event, NavState
from services.sim_air.build import build
from services.sim_air.engine.airframe import Airframe
from services.sim_air.engine.states import InitialState
from services.sim_air.engine.wiring import Controls
from services.sim_air.environment.ground import LEVEL, GroundSurface
from uvf.maths.geodesy import LocalTangent
from uvf.models.scenario import ROOT, load_scenario
from uvf.models.shapes.scene import scene
from uvf.models.shapes.solid import Solid
from uvf.models.world.file import load_world
from uvf.models.world.geometry import solids
from uvf.models.world.terrain import relief_of
from uvf.runtime.time.lockstep import Lockstep

TANGENT = LocalTangent.from_degrees(47.0, 8.0, 450.0)
HILLS = load_world(ROOT / "worlds", "hills")
LAND = GroundSurface(scene(solids(HILLS)))
PLATFORM = Solid("platform", "box", (8.0, 8.0, 2.0), np.array((20.0, 0.0, 1.0)))
ROOF = Solid("roof", "box", (10.0, 10.0, 0.2), np.array((-20.0, 0.0, 4.1)))
MAST = Solid("mast", "cylinder", (0.2, 9.0), np.array((0.0, 30.0, 4.5)))
YARD = GroundSurface(scene([PLATFORM, ROOF, MAST]))
MISSION = """
about: One.
world: hills
wind: {steady: [0.0, 0.0, 0.0]}
vehicles:
  bird: {model: milvus, system_id: 1, start: START}
"""


def standing(ground, x, y):
    """An airframe on its wheels there."""
    airframe = Airframe(FOLDER, BODY, TANGENT)
    airframe.over(ground)
    airframe.stand(InitialState(np.array((x, y, ground.top(x, y))), 0.0, 0.0, np.zeros(3)))
    return airframe


def flown(tmp_path, start, seconds):
    path = tmp_path / "hills.yaml"
    path.write_text(MISSION.replace("START", start))
    lockstep, events, truth = Lockstep(build(load_scenario(path))), [], []
    bus, said = lockstep.bus, topics.EVENTS.by("sim_air")
    bus.subscribe(said.at("bird"), said.qos, lambda s: events.append(Event.FromString(s.payload)))
    bus.subscribe(topics.TRUTH.at("bird"), topics.TRUTH.qos, lambda s: truth.append(NavState.FromString(s.payload)))
    lockstep.run(seconds)
    lockstep.close()
    return truth, events


def test_the_terrain_has_the_height_that_its_picture_says():
    x, y = np.random.default_rng(1).uniform((-235.0, -195.0), (235.0, 195.0), (200, 2)).T
    beside_the_strip = np.abs(y) > 6.1
    height, _ = relief_of(HILLS.terrain).at(x, y)
    seen = np.array([LAND.under(np.array((a, b, 60.0))) for a, b in zip(x, y, strict=True)])
    assert seen[beside_the_strip] == pytest.approx(height[beside_the_strip], abs=2e-3)


def test_the_ground_is_what_lies_below_the_aircraft_not_what_hangs_above():
    assert YARD.under(np.array((20.0, 0.0, 2.4))) == pytest.approx(2.0)
    assert YARD.under(np.array((-20.0, 0.0, 1.0))) == 0.0
    assert YARD.under(np.array((-20.0, 0.0, 4.6))) == pytest.approx(4.2)
    assert YARD.under(np.array((500.0, 0.0, 1.0))) == 0.0


def test_an_aircraft_begins_on_platforms_and_roofs_but_on_no_mast():
    assert (YARD.top(20.0, 0.0), YARD.top(-20.0, 0.0), YARD.top(0.0, 30.0)) == pytest.approx((2.0, 4.2, 0.0))


@pytest.mark.parametrize(("ground", "place"), [(LAND, (0.0, 0.0)), (LAND, (20.0, 30.0)), (YARD, (20.0, 0.0)), (LEVEL, (3000.0, 0.0))])
def test_wheels_stand_on_the_ground_wherever_it_lies(ground, place):
    """By the height of the centre of gravity above it, which is that over level ground at the origin."""
    level = standing(LEVEL, 0.0, 0.0)
    airframe = standing(ground, *place)
    for _ in range(240):
        level.step()
        airframe.step()
    x, y, z = airframe.motion().position
    assert (x, y) == pytest.approx(place, abs=1e-3)
    assert z - ground.top(x, y) == pytest.approx(level.motion().position[2], abs=1e-4)
    assert [t.name for t in airframe.touches()] == ["nose_wheel", "left_wheel", "right_wheel"]


def test_a_wheel_that_rolls_off_a_platform_falls_to_the_ground():
    airframe = standing(YARD, 20.0, 0.0)
    for _ in range(round(6.0 * BODY.physics_hz)):
        airframe.command(Controls(throttle=0.35))
        airframe.step()
        if airframe.motion().position[0] > 26.0:
            break
    assert airframe.motion().position[2] < 1.0


def test_height_above_ground_begins_at_the_ground(tmp_path):
    truth, events = flown(tmp_path, "{x: -60.0, y: 0.0, z: 30.0, speed: 25.0}", 1.0)
    assert truth[0].position.z == pytest.approx(40.0, abs=0.1)
    assert events == []


def test_milvus_stands_on_the_strip_of_the_hills(tmp_path):
    truth, events = flown(tmp_path, "{x: -100.0, y: 0.0}", 3.0)
    assert events == []
    assert truth[-1].position.z == pytest.approx(10.007 + 0.388, abs=0.01)
    assert abs(truth[-1].position.x + 100.0) < 0.01


def test_a_flight_into_a_hillside_ends_there(tmp_path):
    """The hill in the north-west rises to 42 m; level flight at 25 m meets it."""
    truth, events = flown(tmp_path, "{x: -235.0, y: 110.0, z: 25.0, speed: 25.0}", 5.0)
    end = truth[-1].position
    assert len(events) == 1
    assert "m/s" in events[0].cause
    assert -195.0 < end.x < -150.0
    assert end.z == pytest.approx(LAND.top(end.x, end.y), abs=1.5)
