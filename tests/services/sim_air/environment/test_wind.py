"""The air about one aircraft: mean wind, gusts and turbulence put together."""

import msgspec
import numpy as np
import pytest

from schemas import topics
from schemas.messages import NavState
from services.sim_air.build import build
from services.sim_air.environment.wind import AirMass, AirRelativeState
from uvf.maths.dryden import strength
from uvf.models.scenario import load_scenario
from uvf.models.world.wind import Gust, Shear, TurbulenceFile, Wind, WindBegin, WindChange
from uvf.runtime.time.lockstep import Lockstep

DT = 0.01


def mass(wind, seed=1):
    return AirMass(wind, 2.9, np.random.default_rng(seed))


def flight(x=0.0, height=60.0, yaw=0.0, airspeed=25.0):
    return AirRelativeState(np.array((x, 0.0, height)), height, yaw, airspeed)


def test_air_that_an_aircraft_stands_still_in_does_not_turn_it():
    mass = AirMass(Wind((8.0, 0.0, 0.0), turbulence=TurbulenceFile(w20=8.0)), 2.9, np.random.default_rng(2))
    standing = AirRelativeState(np.zeros(3), 0.4, 0.0, 0.0)
    assert not mass.step(0.0, 0.005, standing).rates.any()
    assert mass.step(0.005, 0.005, standing._replace(airspeed=8.0)).rates.any()


def test_steady_wind_is_the_same_everywhere_and_turns_nothing():
    air = mass(Wind((3.0, -2.0, 0.5)))
    assert air.is_steady
    for height in (0.0, 60.0, 900.0):
        motion = air.step(1.0, DT, flight(height=height))
        assert motion.velocity.tolist() == [3.0, -2.0, 0.5]
        assert not motion.rates.any()


def test_sheared_wind_keeps_its_direction_and_is_the_steady_one_at_its_height():
    air = mass(Wind((4.0, 3.0, 0.0), Shear("power", exponent=0.2, height=10.0)))
    assert air.mean(10.0) == pytest.approx((4.0, 3.0, 0.0))
    assert air.mean(320.0) == pytest.approx(air.mean(304.8))
    assert air.mean(100.0) == pytest.approx(np.array((4.0, 3.0, 0.0)) * 10**0.2)


def test_wind_that_changes_does_so_in_a_straight_line_and_stays():
    changes = [WindChange(at=10.0, steady=(-10.0, 4.0, 0.0), over=20.0), WindChange(at=40.0, steady=(0.0, 0.0, 0.0))]
    air = mass(Wind((0.0, 4.0, 0.0), changes=changes))
    assert not air.is_steady and air.mean(50.0).tolist() == [0.0, 4.0, 0.0]
    found = [air.step(t, DT, flight()).velocity[0] for t in (9.0, 15.0, 30.0, 39.0, 40.0, 90.0)]
    assert found == pytest.approx([0.0, -2.5, -10.0, -10.0, 0.0, 0.0])


def test_wind_may_begin_at_a_time_and_above_a_height_gusts_and_turbulence_too():
    blowing = Wind((8.0, 0.0, 0.0), gusts=[Gust((0.0, 5.0, 0.0), 100.0, place=(0.0, 0.0))], turbulence=TurbulenceFile("moderate"))
    air = mass(msgspec.structs.replace(blowing, begins=WindBegin(time=20.0, over=10.0, height=30.0, layer=20.0)))
    assert not air.is_steady
    for t, height in ((19.0, 100.0), (60.0, 29.0)):
        still = air.step(t, DT, flight(height=height))
        assert not still.velocity.any() and not still.rates.any()
    assert air.mean(100.0)[0] == pytest.approx(8.0)
    air.step(25.0, DT, flight(height=40.0))
    assert air.mean(40.0)[0] == pytest.approx(8.0 / 4)
    alike, whole = mass(msgspec.structs.replace(blowing, begins=WindBegin())), mass(blowing)
    for k in range(600, 650):
        now, usual = (one.step(k * DT, DT, flight()) for one in (alike, whole))
    np.testing.assert_array_equal(now.velocity, usual.velocity)


def test_wind_that_an_operator_lets_blow_stays_whatever_was_to_come():
    air = mass(Wind(changes=[WindChange(at=10.0, steady=(-10.0, 0.0, 0.0))], begins=WindBegin(time=1e3)))
    air.blow(np.array((1.0, 0.0, 0.0)))
    assert air.step(20.0, DT, flight()).velocity.tolist() == [1.0, 0.0, 0.0]


def test_a_gust_at_a_time_is_flown_through_in_its_length_over_the_airspeed():
    air = mass(Wind(gusts=[Gust((0.0, 0.0, 4.0), length=50.0, time=1.0)]))
    up = np.array([air.step(k * DT, DT, flight()).velocity[2] for k in range(1, 501)])
    blown = np.flatnonzero(up > 1e-9) + 1
    assert blown[0] * DT == pytest.approx(1.0, abs=DT)
    assert blown[-1] * DT == pytest.approx(3.0, abs=5 * DT)
    assert up.max() == pytest.approx(4.0, abs=0.01)
    assert np.argmax(up) * DT == pytest.approx(2.0, abs=5 * DT)


def test_a_gust_at_a_place_blows_there_and_only_there():
    air = mass(Wind(gusts=[Gust((5.0, 0.0, 0.0), length=80.0, place=(300.0, 0.0))]))
    assert [air.step(0.0, DT, flight(x=x)).velocity[0] for x in (200.0, 260.0, 280.0, 300.0, 320.0, 345.0)] == pytest.approx(
        [0.0, 0.0, 2.5, 5.0, 2.5, 0.0]
    )


def test_turbulence_has_the_intensities_of_the_standard_along_across_and_up():
    data = TurbulenceFile("moderate", w20=10.0)
    air, yaw = mass(Wind(turbulence=data)), 0.7
    blown = np.array([air.step(k * 0.1, 0.1, flight(yaw=yaw, height=20.0)).velocity for k in range(100_000)])
    stated = strength(20.0, 10.0, "moderate")
    along = blown @ np.array((np.cos(yaw), np.sin(yaw), 0.0))
    assert along.std() == pytest.approx(stated.sigma_u, rel=0.05)
    assert blown[:, 2].std() == pytest.approx(stated.sigma_w, rel=0.05)


def test_two_aircraft_meet_gusts_of_their_own_and_each_the_same_again():
    wind = Wind(turbulence=TurbulenceFile("light"))
    one, again, other = (mass(wind, seed) for seed in (1, 1, 2))
    steps = [(air.step(0.1, DT, flight()), air.step(0.2, DT, flight())) for air in (one, again, other)]
    assert all((a.velocity == b.velocity).all() and (a.rates == b.rates).all() for a, b in zip(steps[0], steps[1], strict=True))
    assert (steps[0][1].velocity != steps[2][1].velocity).any()


MISSION = """
about: Two in turbulence.
world: house
seed: {seed}
wind: {{steady: [3.0, 0.0, 0.0], turbulence: {{severity: moderate}}}}
vehicles:
  first: {{model: milvus, system_id: 1, start: {{x: 0.0, y: 0.0, z: 60.0, speed: 25.0}}}}
  second: {{model: milvus, system_id: 2, start: {{x: 0.0, y: 200.0, z: 60.0, speed: 25.0}}}}
"""


def flown(tmp_path, seed):
    path = tmp_path / f"{seed}.yaml"
    path.write_text(MISSION.format(seed=seed))
    lockstep, truth = Lockstep(build(load_scenario(path))), {"first": [], "second": []}
    for name, heard in truth.items():
        lockstep.bus.subscribe(topics.TRUTH.at(name), topics.TRUTH.qos, lambda s, heard=heard: heard.append(NavState.FromString(s.payload)))
    lockstep.run(3.0)
    lockstep.close()
    return truth


def test_the_missions_seed_decides_the_turbulence_of_each_aircraft(tmp_path):
    one, again, other = flown(tmp_path, 1), flown(tmp_path, 1), flown(tmp_path, 2)
    assert one == again
    assert one["first"][-1] != other["first"][-1]
    assert one["first"][-1].wind != one["second"][-1].wind


def test_turbulence_shakes_the_aircraft_and_truth_tells_the_air_it_meets(tmp_path):
    truth = flown(tmp_path, 1)["first"]
    rates = np.array([state.angular_velocity.x for state in truth])
    winds = np.array([(state.wind.x, state.wind.y, state.wind.z) for state in truth])
    assert rates.std() > 0.02
    assert winds[:, 2].std() > 0.3
    assert abs(winds[:, 0].mean() - 3.0) < 8.0
