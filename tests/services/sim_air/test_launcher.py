"""What throws an aircraft: it waits, it pushes along a line, and lets go at the speed it is told."""

import numpy as np
import pytest

from schemas import topics
from schemas.messages import NavState, SurfaceCommand
from services.sim_air.build import build
from services.sim_air.engine.states import Air
from services.sim_air.launcher import AircraftLauncher
from uvf.maths.geodesy import GRAVITY
from uvf.models.mission.launch import Launch
from uvf.models.scenario import ROOT, load_scenario
from uvf.models.yaml_data import BadInput
from uvf.runtime.messages.convert import array, stamp
from uvf.runtime.time.lockstep import Lockstep

DT = 0.002
CALM = np.zeros(3)
GROUND_AIR = Air(101_325.0, 0.0, 288.15)
HAND, BUNGEE = Launch(speed=9.0, delay=1.0), Launch(speed=12.0, length=20.0, weakens=True, elevation=0.3, height=0.1, delay=0.0)
MISSION = """
about: One that is thrown.
world: empty
vehicles:
  bird:
    model: stick25
    system_id: 1
    start: {x: 0.0, y: 0.0, yaw: 1.0, launch: {speed: 12.0, delay: 0.5, scatter: 0.0}}
"""


def held(launch, seed=1):
    return AircraftLauncher(launch, np.array((1.0, 2.0, launch.height)), 0.5, GROUND_AIR, np.random.default_rng(seed))


def pushed(launch, ready=True, longest=20.0):
    """(seconds until it is let go, how, its motions on the way)."""
    launcher, motions = held(launch), []
    for i in range(round(longest / DT)):
        released = launcher.step(ready, DT)
        if released is not None:
            return i * DT, released, motions
        motions.append(launcher.motion(CALM))
    return longest, None, motions


def test_it_waits_until_the_aircraft_is_ready_and_the_delay_is_over():
    assert pushed(HAND, ready=False)[1] is None
    lasts, released, motions = pushed(HAND)
    assert released is not None
    assert lasts == pytest.approx(HAND.delay + 2 * HAND.length / HAND.speed, abs=2 * DT)
    still = [m for m in motions if np.linalg.norm(m.velocity) == 0.0]
    assert len(still) * DT == pytest.approx(HAND.delay, abs=2 * DT)
    assert all(m.specific_force @ m.specific_force == pytest.approx(GRAVITY**2) for m in still)


@pytest.mark.parametrize("launch", [HAND, BUNGEE], ids=["hand", "bungee"])
def test_it_lets_go_at_its_speed_where_the_push_ends(launch):
    _, released, motions = pushed(launch)
    assert np.linalg.norm(motions[-1].velocity) == pytest.approx(launch.speed, rel=0.01)
    assert np.linalg.norm(motions[-1].position - motions[0].position) == pytest.approx(launch.length, rel=0.02)
    np.testing.assert_allclose(released.start.velocity, motions[-1].velocity, atol=0.1)
    assert released.start.velocity[2] == pytest.approx(launch.speed * np.sin(launch.elevation), rel=1e-6)


def test_a_hand_pushes_evenly_and_a_bungee_ever_weaker():
    even, weakening = ([m.specific_force[0] for m in pushed(launch)[2] if np.linalg.norm(m.velocity) > 0.1] for launch in (HAND, BUNGEE))
    assert max(even) - min(even) < 1e-6
    assert weakening[0] > 5 * (weakening[-1] - GRAVITY * np.sin(BUNGEE.elevation)) + GRAVITY * np.sin(BUNGEE.elevation)


def test_once_it_pushes_it_does_not_stop():
    launcher = held(HAND)
    for i in range(2000):
        if launcher.step(i * DT < HAND.delay + 0.1, DT) is not None:
            return
    pytest.fail("it was never let go")


def test_throws_differ_by_the_seed_and_by_nothing_else():
    def attitude(seed):
        launcher = held(HAND, seed)
        while (released := launcher.step(True, DT)) is None:
            pass
        return released.lies

    assert attitude(3) == attitude(3) != attitude(4)


def test_the_pitot_feels_the_push_and_the_wind():
    launcher = held(HAND)
    assert launcher.air(CALM).differential_pressure == 0.0
    ahead = np.array((-np.cos(0.5), -np.sin(0.5), 0.0)) * 5.0
    assert launcher.air(ahead).differential_pressure == pytest.approx(1.225 / 2 * 25.0, rel=0.01)


@pytest.fixture
def bird(tmp_path):
    path = tmp_path / "thrown.yaml"
    path.write_text(MISSION)
    return Lockstep(build(load_scenario(path, ROOT)))


def states(lockstep, seconds, brake):
    seen, bus = [], lockstep.bus
    bus.subscribe(topics.TRUTH.at("bird"), topics.TRUTH.qos, lambda s: seen.append(NavState.FromString(s.payload)))

    surfaces = bus.publisher(topics.SURFACE_COMMAND.at("bird"), SurfaceCommand.DESCRIPTOR.full_name, topics.SURFACE_COMMAND.qos)

    def held_still(t):
        surfaces.put(SurfaceCommand(timestamp=stamp(t), brake=brake).SerializeToString(), round(t * 1e9))
        return True

    lockstep.run(seconds, held_still)
    return seen


def test_in_the_simulator_it_is_held_until_its_brakes_are_let_go_of_and_then_flies(bird):
    braked = states(bird, 2.0, 1.0)
    assert np.ptp([s.position.z for s in braked]) == 0.0
    assert braked[-1].position.z == pytest.approx(1.8)
    flying = states(bird, 3.2, 0.0)  # until then in all
    speeds = [float(np.linalg.norm(array(s.velocity))) for s in flying]
    assert max(speeds) == pytest.approx(12.0, rel=0.05)
    assert flying[-1].position.z > 1.8


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ("{length: 2.0}", "speed"),
        ("{speed: -1.0}", "speed"),
        ("{speed: 9.0, elevation: 2.0}", "elevation"),
        ("{sped: 9.0}", "did you mean 'speed'"),
    ],
)
def test_a_launch_that_is_none_is_told(tmp_path, given, told):
    path = tmp_path / "bad.yaml"
    path.write_text(MISSION.replace("{speed: 12.0, delay: 0.5, scatter: 0.0}", given))
    with pytest.raises(BadInput, match=told):
        load_scenario(path, ROOT)
