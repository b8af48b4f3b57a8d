"""Energy is shared out as it should be: what throttle can reach bounds the path, airspeed comes first, nothing winds up."""

import numpy as np
import pytest

from tests.services.autopilot.air.point_mass import DT, PARAMS, Point, cruise, fly
from tests.services.autopilot.air.states import cruising
from uvf.control.commands import AltitudeAirspeedSetpoint
from uvf.control.cycle import Cycle
from uvf.control.flight_control import FlightControl
from uvf.control.servos import SERVOS
from uvf.control.total_energy import EnergyLoops

STEEP = 12.0  # m/s, more than the motor can do
KEEN = {name: getattr(PARAMS, name) for name in PARAMS.__struct_fields__} | {"climb_max": STEEP, "sink_max": STEEP}
EAGER = type(PARAMS)(**KEEN)


def airspeeds(seen):
    return np.array([now.airspeed for now, _, _ in seen])


def heights(seen):
    return np.array([now.height for now, _, _ in seen])


def throttles(seen):
    return np.array([throttle for _, _, throttle in seen])


def test_a_climb_steeper_than_the_motor_can_do_keeps_the_airspeed_and_climbs_as_it_can():
    seen = fly(Point(), cruise(height=600.0), 60.0, EAGER)
    late = airspeeds(seen)[1000:]
    assert throttles(seen)[1000:].min() > 0.98
    assert late.min() > 24.0 and late.max() < 26.0
    assert 3.0 < (heights(seen)[-1] - heights(seen)[1000]) / 40.0 < STEEP - 2.0


@pytest.mark.parametrize("airspeed_pitch_p", [0.1, 0.8])
def test_a_descent_steeper_than_a_glide_does_not_overspeed(airspeed_pitch_p):
    eager = type(PARAMS)(**{**KEEN, "airspeed_pitch_p": airspeed_pitch_p})
    seen = fly(Point(height=600.0), cruise(height=100.0), 40.0, eager)
    assert throttles(seen)[500:].max() < 0.5
    assert airspeeds(seen).max() < PARAMS.max_airspeed + 0.5


def test_with_a_dead_motor_it_glides_at_the_airspeed_asked_for():
    seen = fly(Point(height=500.0, engine=0.0), cruise(height=500.0), 60.0)
    assert airspeeds(seen).min() > PARAMS.min_airspeed + 1.5
    assert airspeeds(seen)[1500:].mean() == pytest.approx(25.0, abs=0.5)
    assert heights(seen)[-1] < 450.0


def test_without_an_engine_it_glides_at_the_airspeed_asked_for_and_leaves_the_throttle_alone():
    glider = type(PARAMS)(**{**KEEN, "throttle_climb": 0.0, "trim_throttle": 0.0, "throttle_speed": 0.0, "idle_sink": 1.5})
    seen = fly(Point(height=900.0, engine=0.0), cruise(height=900.0), 120.0, glider)
    assert throttles(seen).max() == 0.0
    assert airspeeds(seen)[2000:].mean() == pytest.approx(25.0, abs=0.5) and np.ptp(airspeeds(seen)[3000:]) < 0.5


def test_lifted_by_a_strong_updraught_it_still_lowers_its_nose_for_the_airspeed():
    """The path that it climbs along over the ground is none through the air: pitched up for it, a glider stalls."""
    gains = {"throttle_climb": 0.0, "trim_throttle": 0.0, "throttle_speed": 0.0, "idle_sink": 1.5}
    gains |= {"climb_p": 0.05, "climb_i": 0.75, "airspeed_pitch_p": 0.08}  # as those of a glider are designed
    glider, loops = type(PARAMS)(**{**KEEN, **gains}), EnergyLoops()
    lifted = Cycle(cruising(airspeed=20.0, climb=5.0, pitch=0.1), glider, DT)
    pitches = [loops.step(lifted, cruise(height=900.0)(0.0))[0] for _ in range(1500)]
    assert pitches[-1] < lifted.alpha


def test_when_the_motor_is_back_it_climbs_back_and_settles_without_overshoot_of_the_throttle_trim():
    point = Point(height=200.0, engine=0.0)
    fly(point, cruise(height=200.0), 30.0)
    point.engine = 1.0
    seen = fly(point, cruise(height=200.0), 80.0)
    assert heights(seen)[-1] == pytest.approx(200.0, abs=0.5)
    assert heights(seen).max() < 202.0
    assert airspeeds(seen)[-1] == pytest.approx(25.0, abs=0.2)


def test_short_of_power_for_some_seconds_it_keeps_the_path_and_lends_it_airspeed():
    """As in a downdraught: 5 s with a third of the thrust."""
    point = Point()

    def climbing(t):
        point.engine = 0.33 if 10.0 < t < 15.0 else 1.0
        return AltitudeAirspeedSetpoint(0.0, 100.0 + 2.0 * t, 2.0, 25.0)

    seen = fly(point, climbing, 60.0)
    behind = 100.0 + 2.0 * DT * np.arange(len(seen)) - heights(seen)
    assert throttles(seen).max() == 1.0
    assert behind[500:].max() < 2.5
    assert 22.0 < airspeeds(seen).min() < 24.0
    assert airspeeds(seen)[-1] == pytest.approx(25.0, abs=0.3)


def test_a_weaker_motor_than_the_parameters_say_leaves_no_error_behind():
    seen = fly(Point(engine=0.9), cruise(), 60.0)
    assert heights(seen)[-1] == pytest.approx(100.0, abs=0.1)
    assert airspeeds(seen)[-1] == pytest.approx(25.0, abs=0.1)


def test_with_its_throttle_given_the_climb_keeps_it_from_flying_too_fast():
    """As on a take-off with plenty of power, from the first cycle after an attitude was held on."""
    loops, point = EnergyLoops(), Point(speed=PARAMS.max_airspeed + 1.0)
    climbing = AltitudeAirspeedSetpoint(0.0, None, 2.0, 25.0, throttle=1.0)
    loops.begin(Cycle(point.estimate(), PARAMS, DT), climbing, 0.2, 1.0)
    seen = fly(point, lambda t: climbing, 20.0, loops=loops)
    climbs, fast = np.array([now.climb for now, _, _ in seen]), airspeeds(seen) > PARAMS.max_airspeed
    assert climbs[fast][25:].min() > 2.1, "from half a second on"
    assert climbs[100:].min() > 1.98, "no more than is asked for, when it is slow enough"
    assert airspeeds(seen)[500:].max() < PARAMS.max_airspeed + 0.5


def test_a_higher_airspeed_is_reached_without_giving_up_height():
    seen = fly(Point(), cruise(airspeed=28.0), 40.0)
    assert airspeeds(seen)[-1] == pytest.approx(28.0, abs=0.2)
    assert np.abs(heights(seen) - 100.0).max() < 1.0


def test_height_and_airspeed_that_can_be_exchanged_leave_the_throttle_almost_alone():
    """Too high and too slow by the same energy: what a classic airspeed loop answers with full throttle."""
    loops = EnergyLoops()
    exchange = cruising(height=103.0, airspeed=24.0)
    _, throttle = loops.step(Cycle(exchange, PARAMS, DT), cruise()(0.0))
    _, low = EnergyLoops().step(Cycle(cruising(height=97.0, airspeed=24.0), PARAMS, DT), cruise()(0.0))
    assert throttle == pytest.approx(PARAMS.trim_throttle, abs=0.02)
    assert low > PARAMS.trim_throttle + 0.08


def test_too_slow_it_does_not_climb_and_the_throttle_is_full():
    slow = cruising(height=50.0, airspeed=0.9 * PARAMS.min_airspeed)
    pitch, throttle = EnergyLoops().step(Cycle(slow, PARAMS, DT), cruise()(0.0))
    level, _ = EnergyLoops().step(Cycle(cruising(height=100.0, airspeed=0.9 * PARAMS.min_airspeed), PARAMS, DT), cruise()(0.0))
    assert throttle == 1.0
    assert pitch <= level


def test_the_airspeed_asked_for_rises_with_the_load_of_a_turn():
    def asked(roll):
        return Cycle(cruising(roll=roll), PARAMS, DT).slowest

    assert asked(0.0) == PARAMS.min_airspeed
    assert asked(1.05) > 21.0


def test_with_its_throttle_given_it_sinks_as_it_is_asked_to_while_it_is_not_too_fast():
    loops = EnergyLoops()
    sinking = AltitudeAirspeedSetpoint(0.0, None, -1.5, 21.0, throttle=0.6)
    loops.step(Cycle(cruising(airspeed=20.0, climb=0.0), PARAMS, DT), sinking)
    assert loops.lacking == pytest.approx(-1.5)


def test_at_full_throttle_pitch_answers_an_airspeed_that_is_low_by_a_gain_of_its_own():
    """With that of the throttle an aircraft that cruises near full throttle would pitch with every gust."""

    def change(**gains):
        params, lacking = type(PARAMS)(**{**KEEN, **gains}), []
        for airspeed in (23.0, 22.0):
            loops = EnergyLoops()
            loops.step(Cycle(cruising(airspeed=airspeed, climb=0.0), params, DT), AltitudeAirspeedSetpoint(0.0, 200.0, 0.0, 25.0))
            lacking.append(loops.lacking)
        return lacking[0] - lacking[1]

    assert change(airspeed_pitch_p=0.3) > change(airspeed_pitch_p=0.1) + 0.3
    assert change(airspeed_p=2.0) == change(airspeed_p=0.5)


def test_levelling_out_of_a_steep_climbing_turn_leaves_no_more_climb_to_win_back():
    """With wings level more airspeed could be lent to the climb: were the bank to give way for that, it would swing to and fro."""
    heavy = type(PARAMS)(**{**KEEN, "alpha_max": 0.08, "min_airspeed": 22.8, "airspeed_p": 0.9, "throttle_load": 0.08})
    turn = AltitudeAirspeedSetpoint(1.0, 140.0, 3.0, 25.0)

    def lacking(airspeed, roll):
        loops = EnergyLoops()
        loops.step(Cycle(cruising(airspeed=airspeed, climb=0.0, roll=roll), heavy, DT), turn)
        return loops.lacking

    assert [lacking(24.5, roll) for roll in (0.0, 0.2, 0.4)] == pytest.approx([lacking(24.5, 0.5)] * 3, abs=0.01)
    assert [lacking(25.5, roll) for roll in (0.0, 0.3, 0.6)] == pytest.approx([lacking(25.5, 0.65)] * 3, abs=0.01)


def test_in_gusts_height_and_airspeed_are_held_and_the_throttle_does_not_chase_them():
    random, ahead, below = np.random.default_rng(1), [0.0], [0.0]
    for _ in range(6000):
        ahead.append(ahead[-1] * (1 - 0.1 * DT) + 1.06 * np.sqrt(0.2 * DT) * random.normal())
        below.append(below[-1] * (1 - 0.4 * DT) + 0.9 * np.sqrt(0.8 * DT) * random.normal())
    seen = fly(Point(), cruise(bank=0.6), 120.0, gust_at=lambda k: (ahead[k], below[k]))
    assert np.sqrt(np.mean((heights(seen)[1000:] - 100.0) ** 2)) < 0.6
    assert airspeeds(seen)[1000:].std() < 0.55 * np.std(ahead)
    assert np.abs(np.diff(throttles(seen))).sum() < 0.08 * np.abs(np.diff(airspeeds(seen))).sum()


def test_a_downdraught_is_no_stall():
    seen = fly(Point(), cruise(), 40.0, gust_at=lambda k: (0.0, -2.5 if k > 500 else 0.0))
    assert heights(seen)[-1] == pytest.approx(100.0, abs=0.5)
    assert heights(seen).min() > 97.0


def test_the_law_may_change_in_flight_without_a_bump():
    control, thesis = FlightControl(SERVOS), type(PARAMS)(**{**KEEN, "law": "thesis"})
    now = cruising(pitch=0.0537, lift=9.81)
    for _ in range(100):
        before = control.step(now, AltitudeAirspeedSetpoint(0.0, 60.0, 0.0, 25.0), PARAMS, DT)
    after = control.step(now, AltitudeAirspeedSetpoint(0.0, 60.0, 0.0, 25.0), thesis, DT)
    assert after.throttle == pytest.approx(before.throttle, abs=0.02)


def test_after_the_throttle_was_shut_the_airspeed_does_not_sag():
    point = Point(height=100.0, speed=31.0)
    seen = fly(point, cruise(), 40.0)
    assert throttles(seen).min() < 0.6
    assert airspeeds(seen).min() > 23.5
