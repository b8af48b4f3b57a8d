"""Signs, limits and integrators of the loops."""

import math

import msgspec
import pytest

from tests.services.autopilot.air.states import PARAMS, cruising
from uvf.control.attitude_loops import AttitudeLoops, PitchLoop
from uvf.control.commands import AltitudeAirspeedSetpoint, AttitudeSetpoint
from uvf.control.cycle import Cycle
from uvf.control.flight_control import FlightControl
from uvf.control.servos import SERVOS, ServoLimits, Servos

LEVEL = AltitudeAirspeedSetpoint(bank=0.0, height=60.0, climb=0.0, airspeed=25.0)


def once(now, wanted=LEVEL, control=None):
    return (control or FlightControl(SERVOS)).step(now, wanted, PARAMS, 0.02)


def test_a_bank_to_the_right_takes_positive_aileron():
    assert once(cruising(), AltitudeAirspeedSetpoint(0.5, 60.0, 0.0, 25.0)).aileron > 0.02


def test_rolling_too_fast_is_damped():
    assert once(cruising(p=0.5)).aileron < once(cruising()).aileron


def test_a_bank_beyond_the_limit_is_not_asked_for():
    at_limit = AltitudeAirspeedSetpoint(PARAMS.bank_limit, 60.0, 0.0, 25.0)
    assert once(cruising(), AltitudeAirspeedSetpoint(3.0, 60.0, 0.0, 25.0)) == once(cruising(), at_limit)


def test_too_low_takes_elevator_up_and_throttle():
    level, low = once(cruising()), once(cruising(height=50.0))
    assert low.elevator < level.elevator
    assert low.throttle > level.throttle


def test_a_climb_is_not_steeper_than_allowed():
    assert once(cruising(height=20.0)).throttle == pytest.approx(once(cruising(height=-500.0)).throttle)


def test_a_turn_takes_elevator_up_and_throttle_for_its_load():
    turn = AltitudeAirspeedSetpoint(0.8, 60.0, 0.0, 25.0)
    level, banked = once(cruising()), once(cruising(roll=0.8, pitch=0.07, q=0.28, r=0.27), turn)
    assert banked.elevator < level.elevator - 0.02
    assert banked.throttle > level.throttle


def test_the_lift_of_a_turn_comes_with_its_bank():
    """The path turns V / L_alpha after the nose: while the bank grows the elevator leads, and gives way while it is taken back."""
    into, held, out = (once(cruising(roll=0.6), AltitudeAirspeedSetpoint(bank, 60.0, 0.0, 25.0)).elevator for bank in (0.9, 0.6, 0.3))
    assert into < held - 0.02 and out > held + 0.02
    level, rolling = (once(cruising(), AltitudeAirspeedSetpoint(bank, 60.0, 0.0, 25.0)).elevator for bank in (0.0, 0.5))
    assert rolling == pytest.approx(level, abs=1e-3), "a small bank takes no lift"


def test_too_slow_takes_throttle_and_the_speed_asked_for_has_limits():
    assert once(cruising(airspeed=22.0)).throttle > once(cruising()).throttle
    slowest, below = AltitudeAirspeedSetpoint(0.0, 60.0, 0.0, PARAMS.min_airspeed), AltitudeAirspeedSetpoint(0.0, 60.0, 0.0, 3.0)
    assert once(cruising(), below).throttle == once(cruising(), slowest).throttle


def test_surfaces_move_less_the_faster_the_air():
    bank = AltitudeAirspeedSetpoint(0.2, 60.0, 0.0, 25.0)
    assert 0 < once(cruising(airspeed=32.0), bank).aileron < once(cruising(airspeed=20.0), bank).aileron


def test_yaw_is_damped_only_beyond_the_turn():
    turn = 9.80665 / 25 * math.sin(0.6) * math.cos(0.05)
    assert once(cruising(roll=0.6, r=turn)).rudder == pytest.approx(0.0, abs=1e-9)
    assert once(cruising(roll=0.6, r=turn + 0.2)).rudder > 0.01


def test_a_turn_is_held_by_the_ailerons_and_the_rudder_that_it_takes():
    params = msgspec.structs.replace(PARAMS, aileron_turn=-0.1, rudder_turn=-0.2, rudder_mix=-0.5, yaw_damping=0.0, roll_i=0.0)
    held, turn = AltitudeAirspeedSetpoint(0.6, 60.0, 0.0, 25.0), 9.80665 / 25 * math.sin(0.6)
    surfaces = FlightControl(SERVOS).step(cruising(roll=0.6), held, params, 0.02)
    assert surfaces.aileron == pytest.approx(-0.1 * turn, rel=0.01)
    assert surfaces.rudder == pytest.approx(-0.2 * turn, rel=0.01), "and what the ailerons hold is no roll, that the rudder goes with"


def test_slip_to_the_right_is_steered_out_by_the_rudder():
    control = FlightControl(SERVOS)
    for _ in range(100):
        surfaces = once(cruising(side_force=-1.0), control=control)  # wind from the right pushes left
    assert surfaces.rudder < -0.01


def test_the_rudders_own_force_is_no_slip():
    """Of a slender aircraft the rudder pushes more than the slip that it makes, and the other way: what is felt would grow."""
    params, control, felt = msgspec.structs.replace(PARAMS, rudder_force=6.0, slip_i=0.05), FlightControl(SERVOS), 0.0
    slips = []
    for _ in range(3000):
        rudder = control.step(cruising(side_force=felt), LEVEL, params, 0.02).rudder
        slipping = -3.0 * rudder - 0.3  # by the rudder, and by a propeller
        felt = slipping + 6.0 * rudder
        slips.append(slipping)
    assert abs(slips[-1]) < 0.01 < abs(slips[0])


def test_an_elevator_with_little_way_down_has_it_all_up():
    servos = Servos(ServoLimits(0.35), ServoLimits(0.05, negative_limit=0.3), ServoLimits(0.35))
    up, down = (FlightControl(servos).hold(cruising(), AttitudeSetpoint(0.0, pitch, 0.5), PARAMS, 0.02) for pitch in (3.0, -3.0))
    assert up.elevator < -0.06 and down.elevator == 0.05


def test_surfaces_stay_within_their_stops():
    surfaces = once(cruising(airspeed=12.0, p=-3.0, q=-2.0, r=3.0), AltitudeAirspeedSetpoint(1.0, 500.0, 5.0, 30.0))
    assert max(abs(surfaces.aileron), abs(surfaces.elevator), abs(surfaces.rudder)) <= SERVOS.aileron.limit
    assert 0 <= surfaces.throttle <= 1


def test_without_a_height_the_climb_rate_is_held():
    climbing = AltitudeAirspeedSetpoint(0.0, None, 2.0, 25.0)
    assert once(cruising(height=10.0), climbing) == once(cruising(height=900.0), climbing)
    assert once(cruising(climb=3.0), climbing).elevator > once(cruising(climb=1.0), climbing).elevator


def test_an_attitude_is_held_with_the_throttle_that_is_given():
    surfaces = FlightControl(SERVOS).hold(cruising(), AttitudeSetpoint(0.3, 0.2, 0.4), PARAMS, 0.02)
    assert surfaces.throttle == 0.4
    assert surfaces.aileron > 0.02
    assert surfaces.elevator < FlightControl(SERVOS).hold(cruising(), AttitudeSetpoint(0.3, 0.0, 0.4), PARAMS, 0.02).elevator


GENTLE = msgspec.structs.replace(PARAMS, pitch_time=2.0, final_pitch_time=0.25, pitch_p=0.05, final_pitch_p=0.3)
GENTLE_FOR_LONG = msgspec.structs.replace(GENTLE, pitch_i=0.0)


def pulled(ask, error):
    """Elevator [rad] for so much of pitch [rad] more than there is."""
    level, raised = (ask(cruising().pitch + more) for more in (0.0, error))
    return level.elevator - raised.elevator


def test_an_attitude_is_held_firmly_however_gently_a_path_is():
    def hold(pitch):
        return FlightControl(SERVOS).hold(cruising(), AttitudeSetpoint(0.0, pitch, 0.5), GENTLE, 0.02)

    def gently(pitch):
        control = AttitudeLoops(SERVOS)
        return control.step(Cycle(cruising(), GENTLE, 0.02), AttitudeSetpoint(0.0, pitch, 0.5))

    assert pulled(hold, 0.05) > 5 * pulled(gently, 0.05) > 0


def test_at_its_limits_pitch_turns_back_firmly_however_gently_it_is_moved():
    def elevator(pitch, asked):
        return PitchLoop(SERVOS).step(Cycle(cruising(pitch=pitch), GENTLE, 0.02), asked, 0.0)

    beyond = -GENTLE.pitch_limit - 0.1
    back, gently = (elevator(pitch, asked) for pitch, asked in ((beyond, beyond), (0.05, 0.15)))
    assert back < elevator(0.05, 0.05) - 3 * abs(gently - elevator(0.05, 0.05)), "back to the limit, though it asks for more"


def test_climb_that_is_wanting_is_learnt_until_the_nose_is_at_its_limit():
    """Not until the pitch asked for is: a gentle loop asks for more than it will have."""

    def learnt(pitch, lift):
        control, low = FlightControl(SERVOS), cruising(pitch=pitch, lift=lift, height=40.0, climb=-2.0)
        for _ in range(50):
            control.step(low, LEVEL, GENTLE, 0.02)
        return control._outer["energy"]._trim.value

    assert learnt(0.05, 9.8) > 0.01
    assert learnt(0.05, 40.0) == 0.0, "the wing carries no more"
    assert learnt(GENTLE.pitch_limit + 0.01, 9.8) == 0.0


def test_a_rudder_that_is_given_takes_the_place_of_the_slip_loop_beside_the_damper():
    still, given = (
        FlightControl(SERVOS).hold(cruising(r=0.2, side_force=-2.0), AttitudeSetpoint(0.0, 0.05, 0.4, rudder), PARAMS, 0.02)
        for rudder in (0.0, 0.1)
    )
    assert given.rudder == pytest.approx(still.rudder + 0.1)


def test_from_an_attitude_to_a_height_pitch_and_throttle_go_on_from_where_they_were():
    control, now = FlightControl(SERVOS), cruising(pitch=0.09, height=59.0)
    held = control.hold(now, AttitudeSetpoint(0.0, 0.09, 0.71), PARAMS, 0.02)
    taken = control.step(now, LEVEL, PARAMS, 0.02)
    assert taken.throttle == pytest.approx(held.throttle, abs=0.002)
    assert taken.elevator == pytest.approx(held.elevator, abs=0.002)


def rolls(now, servos=SERVOS):
    """Aileron [rad] of an aircraft that is banked already and asked for a steep turn."""
    return FlightControl(servos).step(now, AltitudeAirspeedSetpoint(1.05, 60.0, 0.0, 25.0), PARAMS, 0.02).aileron


def test_far_too_low_and_sinking_the_lift_is_for_the_climb_before_the_turn():
    level = rolls(cruising(roll=0.9, lift=15.0))
    assert rolls(cruising(roll=0.9, lift=15.0, height=40.0, climb=-8.0)) < 0 < level
    assert rolls(cruising(roll=0.9, lift=15.0, height=80.0, climb=8.0)) == level


def test_a_turn_that_the_elevator_cannot_carry_is_not_asked_for():
    weak = Servos(ServoLimits(0.35), ServoLimits(0.15), ServoLimits(0.35))
    assert rolls(cruising(roll=0.9, lift=15.0), weak) < 0


def test_while_the_elevator_is_at_its_stop_the_bank_gives_way_and_comes_back_later():
    loop, level = PitchLoop(SERVOS), Cycle(cruising(), PARAMS, 0.02)
    first = loop.bank_limit(level)
    for _ in range(150):
        stopped = loop.step(Cycle(cruising(pitch=-0.4, q=-0.5), PARAMS, 0.02), 0.4, 0.0)
    assert stopped == -SERVOS.elevator.limit
    given = loop.bank_limit(level)
    assert given < first - 0.1
    for _ in range(500):
        loop.step(level, cruising().pitch, 0.0)
    assert loop.bank_limit(level) > given + 0.05


def test_how_much_elevator_a_turn_takes_is_learnt_from_what_it_takes():
    """As of an aircraft whose nose is heavier, or lighter, than its parameters say; its integrator may be as slow as it likes."""

    def limit(less):
        """Bank [rad] after ten seconds of level flight at a pitch that is held with so much less elevator."""
        loop = PitchLoop(SERVOS)
        for _ in range(500):
            elevator = loop.step(level, asked + less, 0.0)
        assert elevator == pytest.approx(trimmed - pulls * less, abs=0.01)
        return loop.bank_limit(level)

    level, asked = Cycle(cruising(lift=9.80665), GENTLE_FOR_LONG, 0.02), cruising().pitch
    trimmed = PitchLoop(SERVOS).step(level, asked, 0.0)
    pulls = (trimmed - PitchLoop(SERVOS).step(level, asked + 0.01, 0.0)) / 0.01
    assert limit(-0.1) > limit(0.0) + 0.01 > limit(0.1) + 0.02


def test_a_nose_is_raised_as_quickly_in_a_turn_as_with_level_wings():
    """Of the rate about the pitch axis only the cosine of the bank raises the nose."""
    pulls = []
    for roll in (0.0, 0.8):
        turning = 9.80665 / 25.0 * math.sin(roll) * math.tan(roll)
        now = cruising(roll=roll, q=turning)
        held = [FlightControl(SERVOS).hold(now, AttitudeSetpoint(roll, pitch, 0.5), PARAMS, 0.02).elevator for pitch in (0.0, 0.05)]
        pulls.append(held[0] - held[1])
    assert pulls[1] == pytest.approx(pulls[0] / math.cos(0.8), rel=0.05)
