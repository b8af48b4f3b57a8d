"""Milvus in JSBSim: it trims, stays trimmed, answers its surfaces with the right signs and derivatives."""

import shutil
from pathlib import Path

import msgspec
import numpy as np
import pytest

from services.sim_air.engine.airframe import Airframe
from services.sim_air.engine.states import InitialState
from services.sim_air.engine.trim import Trim
from services.sim_air.engine.wiring import Controls
from uvf.maths import atmosphere, rotations
from uvf.maths.geodesy import LocalTangent
from uvf.models.scenario import ROOT
from uvf.models.vehicle.file import load_vehicle
from uvf.models.yaml_data import BadInput

VEHICLES = Path(ROOT) / "vehicles"
BODY = load_vehicle(VEHICLES, "milvus").air
TANGENT = LocalTangent.from_degrees(40.77, 14.79, 300.0)
CALM = np.zeros(3)


def start(speed=25.0, yaw=0.3, wind=CALM, **kwargs):
    return InitialState(np.array((-200.0, -150.0, 60.0)), yaw, speed, wind, **kwargs)


def airborne(**kwargs):
    airframe = Airframe(VEHICLES / "milvus", BODY, TANGENT)
    return airframe, airframe.start(start(**kwargs))


def fly(airframe, seconds):
    for _ in range(round(seconds * BODY.physics_hz)):
        airframe.step()
    return airframe.motion()


def held(trim, **change):
    named = {"aileron": trim.aileron, "elevator": trim.elevator, "rudder": trim.rudder, "throttle": trim.throttle}
    return Controls(**{name: value + change.get(name, 0.0) for name, value in named.items()})


def euler(motion):
    return rotations.to_euler(motion.world_from_body)


@pytest.mark.parametrize("speed", [18.0, 25.0, 30.0])
def test_level_flight_trims(speed):
    _, trim = airborne(speed=speed)
    assert trim.converged
    assert abs(trim.elevator) < BODY.controls.elevator.limit


@pytest.mark.parametrize("speed", [8.0, 60.0])
def test_a_speed_that_it_cannot_fly_is_refused(speed):
    with pytest.raises(BadInput, match="no level flight"):
        airborne(speed=speed)


@pytest.mark.parametrize("climb", [-0.05, 0.06])
def test_a_climb_goes_up_as_steeply_as_it_is_told(climb):
    airframe, trim = airborne(climb=climb)
    motion = fly(airframe, 5.0)
    assert motion.position[2] - 60.0 == pytest.approx(25.0 * np.sin(climb) * 5.0, abs=0.3)
    assert motion.airspeed == pytest.approx(25.0, abs=0.02)
    assert (trim.throttle > airborne()[1].throttle) == (climb > 0)


@pytest.mark.parametrize("turn_rate", [0.2, -0.25])
def test_a_turn_goes_round_level_at_its_rate_banked_without_side_slip(turn_rate):
    airframe, trim = airborne(turn_rate=turn_rate)
    begin = airframe.motion().position
    motion = fly(airframe, np.pi / abs(turn_rate))  # half a turn
    radius = 25.0 / turn_rate
    left = np.array((-np.sin(0.3), np.cos(0.3), 0.0))
    assert motion.position == pytest.approx(begin + 2 * radius * left, abs=2.0)
    assert motion.airspeed == pytest.approx(25.0, abs=0.05)
    assert np.tan(trim.roll) == pytest.approx(-25.0 * turn_rate / 9.8, rel=0.03)
    assert abs(motion.specific_force[1]) < 0.3


def test_more_than_it_can_climb_is_refused():
    with pytest.raises(BadInput, match=r"no climb or turn like this at 25\.0 m/s"):
        airborne(climb=0.9)


def test_it_begins_in_wind_as_it_does_in_calm_air():
    calm, windy = airborne(turn_rate=0.2)[0], airborne(turn_rate=0.2, wind=np.array((5.0, 2.0, 0.0)))[0]
    before, after = fly(calm, 3.0), fly(windy, 3.0)
    assert after.position - before.position == pytest.approx((15.0, 6.0, 0.0), abs=0.3)
    assert after.airspeed == pytest.approx(before.airspeed, abs=0.05)


def test_trimmed_flight_stays_level_straight_and_as_fast():
    airframe, _ = airborne()
    motion = fly(airframe, 10.0)
    ahead = np.array((np.cos(0.3), np.sin(0.3))) * 250.0
    assert motion.position == pytest.approx((-200 + ahead[0], -150 + ahead[1], 60.0), abs=0.3)
    assert motion.airspeed == pytest.approx(25.0, abs=0.01)


def test_it_starts_where_and_as_it_is_told():
    airframe, trim = airborne(yaw=2.0)
    motion = fly(airframe, 1 / BODY.physics_hz)
    roll, pitch, yaw = euler(motion)
    assert motion.position == pytest.approx((-200.0, -150.0, 60.0), abs=0.15)
    assert yaw == pytest.approx(2.0, abs=1e-4)
    assert (roll, pitch) == pytest.approx((trim.roll, -trim.alpha), abs=1e-4)


def test_wind_is_added_to_the_flight_through_the_air():
    airframe, _ = airborne(yaw=0.0, wind=np.array((4.0, -3.0, 0.0)))
    motion = fly(airframe, 5.0)
    assert motion.velocity == pytest.approx((29.0, -3.0, 0.0), abs=0.02)
    assert motion.airspeed == pytest.approx(25.0, abs=0.01)


def test_in_level_flight_the_accelerometers_feel_gravity_only():
    airframe, trim = airborne()
    force = fly(airframe, 1.0).specific_force
    assert np.linalg.norm(force) == pytest.approx(9.80, abs=0.02)
    assert force[0] == pytest.approx(9.80 * np.sin(trim.alpha), abs=0.01)


def test_pressures_are_those_of_height_and_airspeed():
    airframe, _ = airborne()
    fly(airframe, 0.1)
    air = airframe.air()
    assert air.static_pressure == pytest.approx(atmosphere.pressure(360.0), rel=1e-4)
    rho = atmosphere.density(air.static_pressure, air.temperature)
    assert atmosphere.airspeed(air.differential_pressure, rho) == pytest.approx(25.0, abs=0.02)


def test_accelerometers_are_at_the_centre_of_gravity_wherever_the_model_has_its_pilots_eye(tmp_path):
    shutil.copytree(VEHICLES / "milvus", tmp_path / "milvus")
    model = tmp_path / "milvus" / "milvus" / "milvus.xml"
    eye = '<location name="EYEPOINT" unit="M"><x>'
    model.write_text(model.read_text().replace(eye + "0", eye + "-3"))
    forces = []
    for folder in (VEHICLES, tmp_path):
        airframe = Airframe(folder / "milvus", BODY, TANGENT)
        airframe.command(held(airframe.start(start()), elevator=-0.1))
        forces.append(fly(airframe, 0.2).specific_force)
    assert forces[0] == pytest.approx(forces[1], abs=1e-9)
    assert abs(forces[0][2] - 9.8) > 2.0, "it pulls up"


def test_turning_faster_is_the_slope_of_the_turning():
    airframe, trim = airborne()
    airframe.command(held(trim, elevator=-0.05, aileron=0.05))
    before = fly(airframe, 0.1)
    after = fly(airframe, 1 / BODY.physics_hz)
    slope = (after.angular_velocity - before.angular_velocity) * BODY.physics_hz
    assert slope == pytest.approx(before.angular_acceleration, rel=0.2, abs=0.05)


def test_wind_from_the_side_or_from_behind_is_no_airspeed():
    airframe = Airframe(VEHICLES / "milvus", BODY, TANGENT)
    pressures = {}
    for name, wind in (("ahead", (-10.0, 0.0)), ("side", (0.0, 10.0)), ("behind", (10.0, 0.0))):
        airframe.stand(InitialState(np.zeros(3), 0.0, 25.0, np.array((*wind, 0.0))))
        airframe.step()
        pressures[name] = airframe.air().differential_pressure
    assert pressures["ahead"] == pytest.approx(0.5 * 1.19 * 100.0, rel=0.02)
    assert pressures["side"] == pytest.approx(0.0, abs=0.01)
    assert pressures["behind"] == 0.0


def test_a_positive_aileron_rolls_right():
    airframe, trim = airborne()
    airframe.command(held(trim, aileron=0.05))
    assert euler(fly(airframe, 0.5))[0] > 0.05


def test_a_positive_elevator_pitches_down():
    airframe, trim = airborne()
    before = euler(airframe.motion())[1]
    airframe.command(held(trim, elevator=0.05))
    assert euler(fly(airframe, 0.3))[1] > before + 0.02  # FLU: nose down is positive


def test_a_positive_rudder_yaws_left():
    airframe, trim = airborne()
    airframe.command(held(trim, rudder=0.1))
    assert fly(airframe, 0.3).angular_velocity[2] > 0.02


def test_more_throttle_flies_faster_or_higher():
    airframe, trim = airborne()
    airframe.command(held(trim, throttle=0.15))
    motion = fly(airframe, 5.0)
    energy = 9.8 * (motion.position[2] - 60.0) + 0.5 * (motion.airspeed**2 - 25.0**2)
    assert energy > 50.0
    assert airframe.shaft_power > 400.0


def test_a_gust_from_the_right_turns_the_nose_into_it():
    airframe, _ = airborne(yaw=0.0)
    airframe.blow(np.array((0.0, 3.0, 0.0)))
    assert fly(airframe, 0.3).angular_velocity[2] < -0.02


def slope(airframe, trim, name, h=1e-4):
    """(6,) change of the body accelerations per unit of one unknown of the trim."""
    up, down = _moved(trim, name, h), _moved(trim, name, -h)
    return (airframe.accelerations(start(), up) - airframe.accelerations(start(), down)) / (2 * h)


def _moved(trim, name, by):
    values = {field: getattr(trim, field) for field in ("alpha", "roll", "aileron", "elevator", "rudder", "throttle")}
    return Trim(**{**values, name: values[name] + by})


def dynamic_pressure_times_area():
    rho = atmosphere.density(atmosphere.pressure(360.0), 288.15 - 0.0065 * 360.0)
    return 0.5 * rho * 25.0**2 * 0.55


def frozen():
    """The airframe with its motion held still, as while it is trimmed."""
    airframe = Airframe(VEHICLES / "milvus", BODY, TANGENT)
    trim = airframe.start(start())
    airframe.hold_still(True)
    return airframe, trim


def test_surface_and_stability_derivatives_are_the_published_ones():
    """Moments from the angular accelerations and the published inertia."""
    airframe, trim = frozen()
    q_s = dynamic_pressure_times_area()
    inertia = np.array(((0.8244, 0.0, -0.1204), (0.0, 1.135, 0.0), (-0.1204, 0.0, 1.759)))
    arms = np.array((2.8956, 0.18994, 2.8956))
    published = {"aileron": (0.17, 0.0, -0.011), "elevator": (0.0, -0.99, 0.0), "rudder": (0.0024, 0.0, -0.069), "alpha": (0.0, -2.74, 0.0)}
    for name, coefficients in published.items():
        moments = inertia @ slope(airframe, trim, name)[3:] / (q_s * arms)
        assert moments == pytest.approx(coefficients, abs=2e-3), name


def test_lift_and_side_force_slopes_are_the_published_ones():
    airframe, trim = frozen()
    per_force = 11.0 / dynamic_pressure_times_area()
    assert slope(airframe, trim, "elevator")[2] * per_force == pytest.approx(-0.13, abs=0.01)
    assert slope(airframe, trim, "aileron")[1] * per_force == pytest.approx(0.075, abs=0.002)
    assert slope(airframe, trim, "rudder")[1] * per_force == pytest.approx(0.19, abs=0.002)
    with_gravity = slope(airframe, trim, "alpha")[2] + 9.8 * np.sin(trim.alpha)
    assert with_gravity * per_force == pytest.approx(-(5.61 + 0.05), abs=0.12)  # lift, and drag along body z


def test_a_model_that_is_not_there_is_named():
    with pytest.raises(BadInput, match=r"there is no condor/condor\.xml"):
        Airframe(VEHICLES / "milvus", msgspec.structs.replace(BODY, model="condor"), TANGENT)


def test_a_broken_model_is_named(tmp_path):
    (tmp_path / "milvus").mkdir()
    (tmp_path / "milvus" / "milvus.xml").write_text("<fdm_config name='milvus'><metrics>")
    with pytest.raises(BadInput, match=r"milvus\.xml"):
        Airframe(tmp_path, BODY, TANGENT)


def test_full_command_is_the_deflection_that_the_vehicle_file_says():
    airframe, _ = airborne()
    airframe.command(Controls(BODY.controls.aileron.limit, -BODY.controls.elevator.limit, BODY.controls.rudder.limit, 1.0))
    airframe.step()
    positions = [airframe._fdm[f"fcs/{name}-pos-rad"] for name in ("left-aileron", "elevator", "rudder")]
    assert positions == pytest.approx((BODY.controls.aileron.limit, -BODY.controls.elevator.limit, BODY.controls.rudder.limit))
