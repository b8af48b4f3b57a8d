"""Gains designed for an aircraft of which only linear models are known: margins everywhere, and less error for less motion."""

from dataclasses import replace

import msgspec
import numpy as np
import pytest

from uvf.control.design.aircraft_loops import AircraftLoops
from uvf.control.design.flight_condition import ActuatorDelays, FlightCondition
from uvf.control.design.gain_search import GAIN, PEAK, PHASE, designed
from uvf.control.design.gain_start import begun
from uvf.maths.state_space import StateSpace
from uvf.models.vehicle.flight_params import AirParams

pytestmark = pytest.mark.timeout(300)
SPEED = 20.0  # m/s
LONGITUDINAL = StateSpace(
    np.array(
        [
            [-0.10, 0.45, -1.2, -9.76, 0.0],
            [-0.55, -4.5, 19.6, -0.6, 0.0],
            [0.20, -3.2, -6.0, 0.0, 0.0],
            [0.0, 0.0, 1.0, 0.0, 0.0],
            [0.06, -1.0, 0.0, 20.0, 0.0],
        ]
    ),
    np.array([[0.1, 6.0], [-3.0, 0.0], [-40.0, 0.0], [0.0, 0.0], [0.0, 0.0]]),
    ("u", "w", "q", "theta", "h"),
    ("delta_e", "delta_t"),
)
LATERAL = StateSpace(
    np.array(
        [
            [-0.8, 1.2, -19.9, 9.8, 0.0],
            [-2.0, -10.0, 4.0, 0.0, 0.0],
            [1.0, -0.2, -1.5, 0.0, 0.0],
            [0.0, 1.0, 0.06, 0.0, 0.0],
            [0.0, 0.0, 1.0, 0.0, 0.0],
        ]
    ),
    np.array([[0.0, 3.0], [60.0, 0.0], [-4.0, -15.0], [0.0, 0.0], [0.0, 0.0]]),
    ("v", "p", "r", "phi", "psi"),
    ("delta_a", "delta_r"),
)
WEAK = np.array(
    [
        [-0.40, 3.55, -72.9, 9.8, 0.0],
        [-0.114, -2.95, -0.02, 0.0, 0.0],
        [0.0092, -0.27, -0.256, 0.0, 0.0],
        [0.0, 1.0, 0.05, 0.0, 0.0],
        [0.0, 0.0, 1.0, 0.0, 0.0],
    ]
)
PARAMS = AirParams(
    trim_airspeed=SPEED,
    alpha_per_load=4.0,
    elev_per_alpha=-1.5,
    roll_ff=10 / 60,
    pitch_ff=6 / 40,
    throttle_climb=0.08,
    throttle_speed=0.03,
    rudder_mix=-0.27,
)


def aircraft(lag):
    flight = FlightCondition(SPEED, SPEED, 0.06, LONGITUDINAL, LATERAL, SPEED, 2.0)
    return AircraftLoops((flight,), ActuatorDelays(*[(lag, 0.0)] * 3, (0.0, 0.2)))


@pytest.fixture(scope="module", params=[0.05, 0.15])
def design(request):
    craft = aircraft(request.param)
    first = begun(craft, PARAMS)
    return craft, first, designed(craft, first)


def test_every_loop_has_its_margins(design):
    craft, _, params = design
    for loop in craft.loops(params):
        assert loop.stable
        assert not abs(loop.margins.gain_db) < GAIN if loop.margins.gain == loop.margins.gain else True, loop.name
        assert not np.degrees(abs(loop.margins.phase)) < PHASE, loop.name
        assert loop.margins.peak <= PEAK, loop.name


def test_it_stays_stable_when_the_aircraft_is_another(design):
    craft, _, params = design
    assert all(loop.stable for loop in craft.worst(params, seed=7))


def test_what_it_begins_with_is_stable(design):
    craft, first, _ = design
    assert all(loop.stable for loop in craft.loops(first))


def test_on_a_path_pitch_is_left_to_the_gusts_and_by_stick_it_is_held(design):
    _, first, params = design
    assert params.pitch_time > 2 * params.final_pitch_time
    assert params.final_pitch_p > 0.3 * first.pitch_ff * 0.99 and params.final_pitch_i > 0.99 * first.pitch_ff


def test_slow_servos_make_slow_loops():
    quick, slow = (designed(aircraft(lag), begun(aircraft(lag), PARAMS)) for lag in (0.05, 0.15))
    assert slow.roll_time > quick.roll_time
    assert slow.course_p < quick.course_p


IN_GLIDE = {"path", "roll", "yaw", "airspeed", "pitch", "final path", "final roll"}


def test_a_glider_holds_its_airspeed_with_all_margins():
    glider = msgspec.structs.replace(PARAMS, throttle_climb=0.0, throttle_speed=0.0, trim_throttle=0.0)
    craft = replace(aircraft(0.05), powered=False)
    params = designed(craft, begun(craft, glider))
    found = craft.loops(params)
    assert {loop.name for loop in found} == {*IN_GLIDE, "attitude roll", "attitude pitch"}
    assert all(loop.stable and loop.margins.peak <= PEAK for loop in found)
    assert all(loop.stable for loop in craft.worst(params, seed=7))


def test_an_aircraft_of_which_the_full_mix_of_the_rudder_is_too_much_is_designed_too():
    """As the T-6A of JSBSim: its ailerons yaw it strongly with the roll, and it hardly turns into the wind by itself."""
    side = replace(LATERAL, a=WEAK, b=np.array([[0.0, 0.0], [24.6, 0.55], [2.25, -2.14], [0.0, 0.0], [0.0, 0.0]]))
    flight = FlightCondition(73.0, 73.0, 0.05, LONGITUDINAL, side, 73.0, 10.0)
    craft = AircraftLoops((flight,), ActuatorDelays(*[(0.05, 0.0)] * 3, (0.0, 0.2)))
    params = msgspec.structs.replace(PARAMS, trim_airspeed=73.0, roll_ff=0.12, rudder_mix=1.0)
    lateral = [loop for loop in craft.loops(designed(craft, begun(craft, params))) if loop.name in ("path", "roll", "yaw")]
    assert all(loop.stable and loop.margins.peak <= PEAK for loop in lateral)


def test_a_flying_wing_is_designed_without_a_rudder():
    side = replace(LATERAL, b=LATERAL.b * (1.0, 0.0))
    craft = AircraftLoops(
        (FlightCondition(SPEED, SPEED, 0.06, LONGITUDINAL, side, SPEED, 2.0),), ActuatorDelays(*[(0.05, 0.0)] * 3, (0.0, 0.2))
    )
    begins = begun(craft, PARAMS)
    params = designed(craft, begins)
    found = craft.loops(params)
    assert "yaw" not in {loop.name for loop in found}
    assert all(loop.stable and loop.margins.peak <= PEAK for loop in found)
    assert all(loop.stable for loop in craft.worst(params))
    assert (params.yaw_damping, params.slip_i) == (begins.yaw_damping, begins.slip_i), "what does nothing is not searched for"


def test_gains_for_quick_servos_are_found_out_with_slow_ones():
    params = designed(aircraft(0.02), begun(aircraft(0.02), PARAMS))
    late = replace(aircraft(0.4), delays=ActuatorDelays(*[(0.4, 0.0)] * 3, (0.0, 0.2)))
    assert not all(loop.stable for loop in late.loops(params))
