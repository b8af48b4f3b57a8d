"""The service around the aircraft: what it sends, how often, and what it does without commands."""

import math
from collections import Counter
from pathlib import Path

import msgspec
import numpy as np
import pytest

from schemas import topics
from schemas.messages import NavState, SurfaceCommand
from services.sim_air.actuators import Actuators
from services.sim_air.aircraft import Aircraft
from services.sim_air.build import build
from services.sim_air.contact.surroundings import Around
from services.sim_air.engine.states import Air, AircraftMotion
from services.sim_air.engine.wiring import Controls, JointAngle
from services.sim_air.environment.ground import LEVEL
from services.sim_air.environment.windsocks import Windsocks
from services.sim_air.sensors import Imu
from services.sim_air.service import SimAir
from services.sim_air.stage import AirStage
from tests.runtime.stepping import stepped
from tests.services.sim_air.shapes import MILVUS_TREE
from uvf.maths import rotations
from uvf.maths.rotations import IDENTITY
from uvf.models.scenario import ROOT, load_scenario
from uvf.models.vehicle.file import load_vehicle
from uvf.models.world.wind import Wind
from uvf.runtime.bus.interface import LocalBus
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.messages.convert import wxyz
from uvf.runtime.time.lockstep import Lockstep

MILVUS = load_vehicle(Path(ROOT) / "vehicles", "milvus")
MISSION = """
about: Two aircraft.
world: house
seed: 3
vehicles:
  first: {model: milvus, system_id: 1, start: {x: 0.0, y: 0.0, z: 60.0, speed: 25.0}}
  second: {model: milvus, system_id: 2, start: {x: 0.0, y: 90.0, z: 80.0, yaw: 1.0, speed: 22.0}}
"""


class Glider:
    """A body that goes straight and remembers its commands."""

    def __init__(self):
        self.commands = []
        self.steps = 0

    def command(self, controls):
        self.commands.append(controls)

    def step(self):
        self.steps += 1

    def motion(self):
        return AircraftMotion(np.zeros(3), np.zeros(3), IDENTITY, np.zeros(3), np.array((0.0, 0.0, 9.8)), 25.0)

    def air(self):
        return Air(97_000.0, 370.0, 285.0)

    def joints(self):
        return [JointAngle("elevator", -0.14), JointAngle("propeller", speed=500.0)]

    def touches(self):
        return []

    motor_power = 350.0


EMPTY = Around([], LEVEL, {"g": MILVUS_TREE}, {}.__getitem__)


NO_SOCKS = Windsocks((), Wind(), lambda name: None, lambda x, y: 0.0)
NOTHING_ASKED = {name: [] for name in SimAir.requests}


def glider():
    body = Glider()
    level = Controls(elevator=-0.14, throttle=0.7)
    craft = Aircraft("g", MILVUS, body, Actuators(level, MILVUS.air), level)
    return body, simulator(craft)


def simulator(craft):
    return SimAir(AirStage({"g": craft}, Around([], LEVEL, {"g": MILVUS_TREE}, {}.__getitem__), (), None, NO_SOCKS))


def run_two(tmp_path, until=3.0):
    path = tmp_path / "two.yaml"
    path.write_text(MISSION)
    seen = []
    bus = LocalBus()
    bus.subscribe("uvf/*/*/*", topics.IMU.qos, lambda s: seen.append((s.stamp_ns, s.key, s.payload)))
    bus.subscribe("uvf/*/*/*/*", topics.IMU.qos, lambda s: seen.append((s.stamp_ns, s.key, s.payload)))
    lockstep = Lockstep(build(load_scenario(path)), bus)
    lockstep.run(until)
    lockstep.close()
    return [s for s in seen if "/sys/" not in s[1]]


def test_physics_keeps_up_with_the_clock():
    body, service = glider()
    for k in range(1, 101):
        stepped(service, k / 100, surfaces={}, truth={}, objects=None, **NOTHING_ASKED)
    assert body.steps == MILVUS.air.physics_hz


TRIMMED = Controls(aileron=0.01, elevator=-0.14, rudder=-0.002, throttle=0.7)


def after_one_command(command, until):
    """What the body is commanded at each physics step when ``command`` comes once, at the start, and then nothing."""
    body = Glider()
    service = simulator(Aircraft("g", MILVUS, body, Actuators(TRIMMED, MILVUS.air), TRIMMED))
    lockstep = Lockstep([ServiceInstance(SimAir, lambda: service)])
    commands = lockstep.bus.publisher(topics.SURFACE_COMMAND.at("g"), SurfaceCommand.DESCRIPTOR.full_name, topics.SURFACE_COMMAND.qos)
    commands.put(command.SerializeToString(), 0)
    lockstep.run(until)
    return body.commands


def test_surfaces_hold_half_a_second_without_commands_then_go_to_trim_at_the_servos_rate():
    turning = SurfaceCommand(aileron=0.3, elevator=-0.3, rudder=0.1, throttle=0.9)
    commands = after_one_command(turning, 1.5)
    held, last = commands[round(0.5 * MILVUS.air.physics_hz) - 1], commands[-1]
    assert (held.aileron, held.elevator, held.rudder, held.throttle) == pytest.approx((0.3, -0.3, 0.1, 0.9), abs=1e-3)
    assert (last.aileron, last.elevator, last.rudder, last.throttle) == pytest.approx((0.01, -0.14, -0.002, 0.7), abs=1e-6)
    moves = np.abs(np.diff([(c.aileron, c.elevator, c.rudder) for c in commands], axis=0))
    assert moves.max() <= MILVUS.air.servo_rate / MILVUS.air.physics_hz + 1e-12


def test_a_motor_that_was_off_does_not_start_when_commands_end():
    assert after_one_command(SurfaceCommand(aileron=0.3, throttle=0.0), 1.5)[-1].throttle == 0.0


def test_an_aircraft_whose_autopilot_dies_while_it_rolls_stops_rolling_and_flies_on(tmp_path):
    path = tmp_path / "two.yaml"
    path.write_text(MISSION)
    lockstep, truth = Lockstep(build(load_scenario(path))), []
    lockstep.bus.subscribe(topics.TRUTH.at("first"), topics.TRUTH.qos, lambda s: truth.append(NavState.FromString(s.payload)))
    commands = lockstep.bus.publisher(topics.SURFACE_COMMAND.at("first"), SurfaceCommand.DESCRIPTOR.full_name, topics.SURFACE_COMMAND.qos)
    commands.put(SurfaceCommand(aileron=0.1, elevator=-0.14, throttle=0.78).SerializeToString(), 0)
    lockstep.run(6.5)
    lockstep.close()
    banks = np.array([rotations.to_euler(wxyz(state.orientation))[0] for state in truth])
    assert np.radians(10.0) < banks.max() < np.radians(40.0)
    assert np.abs(np.diff(banks[-150:]) * topics.TRUTH.hz).max() < np.radians(5.0)
    assert truth[-1].position.z > 45.0


@pytest.mark.parametrize("name", ["aileron", "elevator", "rudder", "throttle"])
@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_a_command_that_is_not_finite_is_no_command(name, value):
    body, service = glider()
    stepped(
        service, 0.01, surfaces={"g": SurfaceCommand(aileron=0.1, elevator=-0.2, throttle=0.9)}, truth={}, objects=None, **NOTHING_ASKED
    )
    for k in range(2, 101):
        bad = SurfaceCommand(aileron=-0.3, elevator=0.3, throttle=0.1)
        setattr(bad, name, value)
        stepped(service, k / 100, surfaces={"g": bad}, truth={}, objects=None, **NOTHING_ASKED)
    assert body.commands[-1].aileron == pytest.approx(0.1, abs=1e-6)
    assert body.commands[-1].elevator == pytest.approx(-0.2, abs=1e-6)
    assert body.commands[-1].throttle == pytest.approx(0.9)


def test_before_the_first_command_the_surfaces_stay_trimmed():
    body, service = glider()
    stepped(service, 0.01, surfaces={}, truth={}, objects=None, **NOTHING_ASKED)
    assert body.commands[-1].elevator == pytest.approx(-0.14)


def test_joints_show_where_the_body_has_its_surfaces():
    _, service = glider()
    for k in range(1, 6):
        out = stepped(service, k / 100, surfaces={}, truth={}, objects=None, **NOTHING_ASKED)
    named = {j.name: j for j in out["joints"]["g"].joints}
    assert named["elevator"].position == pytest.approx(-0.14)
    assert named["propeller"].velocity == 500.0


def test_a_sensor_that_is_not_fitted_sends_nothing():
    _, service = glider()
    out = stepped(service, 0.01, surfaces={}, truth={}, objects=None, **NOTHING_ASKED)
    assert "imu" not in out
    assert "gnss" not in out


def house_readings(tmp_path, topic):
    seen = run_two(tmp_path, until=0.05)
    return [topic.message.FromString(payload) for _, key, payload in seen if key == topic.at("first")]


def test_the_magnetic_field_is_that_of_the_world(tmp_path):
    field = load_scenario(ROOT / "missions" / "demo.yaml").world.magnetic_field
    read = house_readings(tmp_path, topics.IMU)[0].magnetic_field
    assert math.hypot(read.x, read.y, read.z) == pytest.approx(np.linalg.norm(field), rel=0.05)
    assert read.x == pytest.approx(field[0], abs=6e-6)  # it flies east, a little nose up
    assert read.y == pytest.approx(field[1], abs=3e-6)


def test_a_cameras_optical_frame_is_told_too(tmp_path):
    (frames,) = house_readings(tmp_path, topics.TF_STATIC)
    assert {f.child_frame_id: f.parent_frame_id for f in frames.transforms} == {
        "first/imu": "first/base_link",
        "first/altimeter": "first/base_link",
        "first/camera": "first/base_link",
        "first/camera_optical": "first/camera",
    }


def test_the_imus_frame_is_that_of_the_vehicle_file():
    _, service = glider()
    (craft,) = service._stage.aircraft.values()
    craft.imu = Imu(msgspec.structs.replace(MILVUS.sensors.imu, frame="nose_imu"), np.zeros(3), np.random.default_rng(1))
    assert stepped(service, 0.01, surfaces={}, truth={}, objects=None, **NOTHING_ASKED)["imu"]["g"].frame_id == "g/nose_imu"


def test_each_sensor_sends_at_its_own_rate_for_every_aircraft(tmp_path):
    seen = Counter(key for _, key, _ in run_two(tmp_path, until=3.0))
    for vehicle in ("first", "second"):
        assert seen[topics.IMU.at(vehicle)] == 300
        assert seen[topics.AIR_DATA.at(vehicle)] == 150
        assert seen[topics.GNSS.at(vehicle)] == pytest.approx(14, abs=1)
        assert seen[topics.TRUTH.at(vehicle)] == 150
        assert seen[topics.BATTERY.at(vehicle)] == 3
        assert seen[topics.TF_STATIC.at(vehicle)] == 1


def test_the_same_seed_gives_the_same_bytes(tmp_path):
    assert run_two(tmp_path) == run_two(tmp_path)


def test_two_aircraft_have_errors_of_their_own(tmp_path):
    seen = run_two(tmp_path, until=0.05)
    first, second = ([topics.IMU.message.FromString(p) for _, key, p in seen if key == topics.IMU.at(v)] for v in ("first", "second"))
    assert first[0].angular_velocity.x != second[0].angular_velocity.x
