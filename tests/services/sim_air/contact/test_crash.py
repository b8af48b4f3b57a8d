"""What is a crash and what is a landing, and that the world goes on after one."""

import math
from pathlib import Path

import numpy as np
import pytest

from schemas import topics
from schemas.messages import Event, NavState, SurfaceCommand
from services.sim_air.actuators import Actuators
from services.sim_air.aircraft import Aircraft
from services.sim_air.build import build
from services.sim_air.contact.crash import Wreck, crash_of
from services.sim_air.engine.airframe import Airframe
from services.sim_air.engine.contacts import GroundTouch
from services.sim_air.engine.states import Air, AircraftMotion, InitialState, Runaway
from services.sim_air.engine.wiring import Controls, JointAngle
from uvf.maths import rotations
from uvf.maths.geodesy import LocalTangent
from uvf.models.scenario import ROOT, load_scenario
from uvf.models.vehicle.file import load_vehicle
from uvf.runtime.messages.convert import array
from uvf.runtime.time.lockstep import Lockstep

MILVUS = load_vehicle(Path(ROOT) / "vehicles", "milvus")
TANGENT = LocalTangent.from_degrees(40.77, 14.79, 300.0)
AIR = Air(97_000.0, 370.0, 285.0)


def moving(speed, roll=0.0, pitch=0.0):
    attitude = rotations.from_euler(roll, pitch, 0.0)
    return AircraftMotion(np.zeros(3), np.array((speed, 0.0, 0.0)), attitude, np.full(3, 0.1), np.array((0.0, 0.0, 9.8)), speed)


WHEELS = [GroundTouch("left", True, 1.0), GroundTouch("right", True, 2.9)]


def test_wheels_that_sink_slowly_make_a_landing():
    assert crash_of(WHEELS, moving(20.0), 3.05) == ""


def test_wheels_that_sink_faster_than_the_gear_bears_break():
    assert crash_of(WHEELS, moving(20.0), 2.5) == "right hit the ground sinking at 2.9 m/s; it bears 2.5 m/s"


def test_structure_on_the_moving_ground_is_a_crash_and_is_named_with_the_speed():
    assert crash_of([*WHEELS, GroundTouch("left_tip", False, 0.1)], moving(14.0), 3.05) == "left_tip touched the ground at 14.0 m/s"


def test_structure_may_rest_on_the_ground():
    assert crash_of([GroundTouch("tail", False, 0.0)], moving(0.2), 3.05) == ""


def test_nobody_lands_on_the_back():
    assert "banked 170" in crash_of(WHEELS, moving(20.0, roll=math.radians(170)), 3.05)
    assert "pitched 60" in crash_of(WHEELS, moving(20.0, pitch=-math.radians(60)), 3.05)


def test_a_wreck_stays_where_it_lies_and_feels_its_weight():
    wreck = Wreck(moving(20.0, roll=math.pi / 2), AIR, [JointAngle("elevator", 0.1), JointAngle("propeller", speed=500.0)])
    assert wreck.motion.velocity.tolist() == wreck.motion.angular_velocity.tolist() == [0.0, 0.0, 0.0]
    assert wreck.motion.specific_force == pytest.approx((0.0, 9.80665, 0.0), abs=1e-9)
    assert wreck.joints == [JointAngle("elevator", 0.1), JointAngle("propeller")]
    assert wreck.air.differential_pressure == 0.0


class Bursting:
    """A body whose numbers run away at its tenth step."""

    motor_power = 100.0
    steps = 0

    def step(self):
        self.steps += 1
        if self.steps == 10:
            raise Runaway("velocities/p-rad_sec is nan")

    def command(self, controls):
        pass

    def motion(self):
        return moving(float(self.steps))

    def air(self):
        return AIR

    def joints(self):
        return []

    def touches(self):
        return []


def test_numbers_that_run_away_end_one_flight_and_nothing_else():
    craft = Aircraft("b", MILVUS, Bursting(), Actuators(Controls(), MILVUS.air), Controls())
    craft.fly_to(0.02)
    assert not craft.ended
    craft.fly_to(1.0)
    assert "its motion ran away (velocities/p-rad_sec is nan); a higher physics_hz" in craft.ended
    assert craft.body.steps == 10
    assert np.isfinite(craft.motion.position).all()


def flown(tmp_path, start, command, until, model="milvus"):
    """(truth, events) of one aircraft with one command held."""
    path = tmp_path / "one.yaml"
    path.write_text(f"about: One.\nworld: empty\nvehicles:\n  bird: {{model: {model}, system_id: 1, start: {start}}}\n")
    lockstep, truth, events = Lockstep(build(load_scenario(path))), [], []
    lockstep.bus.subscribe(topics.TRUTH.at("bird"), topics.TRUTH.qos, lambda s: truth.append(NavState.FromString(s.payload)))
    said = topics.EVENTS.by("sim_air")
    lockstep.bus.subscribe(said.at("bird"), said.qos, lambda s: events.append(Event.FromString(s.payload)))
    if command is not None:
        key = topics.SURFACE_COMMAND
        surfaces = lockstep.bus.publisher(key.at("bird"), SurfaceCommand.DESCRIPTOR.full_name, key.qos)
        for k in range(round(until / 0.1)):
            surfaces.put(command.SerializeToString(), k * 100_000_000)
            lockstep.run((k + 1) * 0.1)
    lockstep.run(until)
    lockstep.close()
    return truth, events


def test_a_dive_into_the_ground_is_told_once_and_the_aircraft_stays_there(tmp_path):
    truth, events = flown(tmp_path, "{x: 0.0, y: 0.0, z: 40.0}", SurfaceCommand(elevator=0.3, throttle=0.5), 8.0)
    assert [e.severity for e in events] == [Event.CRITICAL]
    assert "m/s" in events[0].cause
    assert len(truth) == 400
    last, before = truth[-1], truth[-100]
    assert array(last.velocity).tolist() == [0.0, 0.0, 0.0]
    assert array(last.position).tolist() == array(before.position).tolist()
    assert -0.6 < last.position.z < 1.5


def test_an_aircraft_begins_at_rest_on_its_wheels_and_stays_there(tmp_path):
    truth, events = flown(tmp_path, "{x: 5.0, y: 3.0, yaw: 0.7}", None, 10.0)
    first, last = truth[0], truth[-1]
    assert events == []
    assert (first.position.x, first.position.y) == pytest.approx((5.0, 3.0), abs=0.01)
    assert 0.1 < first.position.z < 1.0
    assert array(last.position) == pytest.approx(array(first.position), abs=0.01)
    assert max(np.linalg.norm(array(t.velocity)) for t in truth) < 0.05


@pytest.mark.parametrize(("height", "breaks"), [(0.2, False), (1.5, True)])
def test_a_fall_onto_the_wheels_breaks_them_when_it_is_deep(height, breaks):
    airframe = Airframe(ROOT / "vehicles" / "milvus", MILVUS.air, TANGENT)
    airframe.drop(InitialState(np.zeros(3), 0.0, 0.0, np.zeros(3)), height)
    craft = Aircraft("f", MILVUS, airframe, Actuators(Controls(brake=1.0), MILVUS.air), Controls())
    craft.fly_to(2.0)
    assert ("wheel hit the ground sinking at" in craft.ended) == breaks
