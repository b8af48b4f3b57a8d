"""Other aircraft fly by their files alone: a 2 kg trainer, an airship, one of JSBSim's own."""

import math
import shutil
from pathlib import Path

import jsbsim
import numpy as np
import pytest

from schemas import topics
from schemas.messages import Event, NavState, SurfaceCommand
from services.sim_air.build import build
from services.sim_air.engine.airframe import Airframe
from services.sim_air.engine.states import InitialState
from uvf.maths import rotations
from uvf.maths.geodesy import LocalTangent
from uvf.models.scenario import ROOT, load_scenario
from uvf.models.vehicle.file import load_vehicle
from uvf.runtime.messages.convert import array, wxyz
from uvf.runtime.time.lockstep import Lockstep

MISSION = "about: One.\nworld: empty\nvehicles:\n  bird: {{model: {model}, system_id: 1, start: {{x: 0.0, y: 0.0, z: 80.0}}}}\n"
SKYHAWK = """
kind: fixed_wing
about: JSBSim's own Cessna 172
air:
  model: c172p
  physics_hz: 120.0
  trim_speed: 50.0
  controls:
    aileron: {limit: 0.35}
    elevator: {limit: 0.45}
    rudder: {limit: 0.28}
    throttle: {lag: 0.3}
  settings: {fcs/mixture-cmd-norm: 0.9}
  servo_rate: 1.0
  servo_lag: 0.1
sensors: {}
"""


class Flight:
    """One aircraft in lockstep; ``pilot`` makes a SurfaceCommand of the truth, ten times a second, or nothing does."""

    def __init__(self, root, model, pilot=None):
        (root / "one.yaml").write_text(MISSION.format(model=model))
        self.truth, self.events, self.pilot = [], [], pilot
        self.lockstep = Lockstep(build(load_scenario(root / "one.yaml", root)))
        bus, said = self.lockstep.bus, topics.EVENTS.by("sim_air")
        bus.subscribe(topics.TRUTH.at("bird"), topics.TRUTH.qos, lambda s: self.truth.append(NavState.FromString(s.payload)))
        bus.subscribe(said.at("bird"), said.qos, lambda s: self.events.append(Event.FromString(s.payload)))
        key = topics.SURFACE_COMMAND
        self.surfaces = bus.publisher(key.at("bird"), SurfaceCommand.DESCRIPTOR.full_name, key.qos)

    def run(self, until):
        for k in range(round(until * 10)):
            if self.pilot and self.truth:
                self.surfaces.put(self.pilot(self.truth[-1]).SerializeToString(), k * 100_000_000)
            self.lockstep.run((k + 1) / 10)
        self.lockstep.close()
        assert self.events == []
        return self

    @property
    def heights(self):
        return np.array([t.position.z for t in self.truth])

    @property
    def headings(self):
        return np.unwrap([rotations.to_euler(wxyz(t.orientation))[2] for t in self.truth])


@pytest.mark.parametrize(("model", "speed", "bound"), [("stick25", 17.0, 1.0), ("nas10", 7.0, 1.0)])
def test_it_flies_a_minute_with_its_surfaces_held_at_the_trim(tmp_path, model, speed, bound):
    flight = Flight(_rooted(tmp_path, model), model).run(60.0)
    assert np.abs(flight.heights - 80.0).max() < bound
    assert np.linalg.norm(array(flight.truth[-1].velocity)) == pytest.approx(speed, rel=0.02)
    assert math.hypot(*array(flight.truth[-1].position)[:2]) > 0.5 * 60 * speed


def test_a_light_aircraft_stands_still_in_a_wind(tmp_path):
    file = load_vehicle(ROOT / "vehicles", "stick25")
    airframe = Airframe(ROOT / "vehicles" / "stick25", file.air, LocalTangent.from_degrees(40.77, 14.79, 300.0))
    airframe.stand(InitialState(np.zeros(3), 0.0, 0.0, np.array((-5.0, 2.0, 0.0))))
    before = airframe.motion()
    for _ in range(800):
        airframe.step()
    after = airframe.motion()
    assert np.linalg.norm(after.position - before.position) < 0.02
    assert rotations.to_euler(after.world_from_body) == pytest.approx(rotations.to_euler(before.world_from_body), abs=0.02)


def trainer(state):
    """Banks 0.4 rad to the left and holds 80 m."""
    roll, pitch, _ = rotations.to_euler(wxyz(state.orientation))
    wanted = np.clip(0.03 * (80.0 - state.position.z) - 0.02 * state.velocity.z, -0.2, 0.2) + 0.07
    return SurfaceCommand(
        aileron=0.3 * (-0.4 - roll) - 0.05 * state.angular_velocity.x, elevator=-0.09 - 0.6 * (wanted + pitch), throttle=0.68
    )


def airship(state):
    """Rudder to the left and the height held by the elevator."""
    _, pitch, _ = rotations.to_euler(wxyz(state.orientation))
    wanted = np.clip(0.05 * (80.0 - state.position.z) - 0.05 * state.velocity.z, -0.2, 0.2)
    return SurfaceCommand(elevator=0.04 - 1.0 * (wanted + pitch), rudder=0.15, throttle=0.73)


@pytest.mark.parametrize(("model", "pilot", "bound"), [("stick25", trainer, 3.0), ("nas10", airship, 3.0)])
def test_a_scripted_pilot_turns_it_round_at_its_height(tmp_path, model, pilot, bound):
    flight = Flight(_rooted(tmp_path, model), model, pilot).run(60.0)
    assert flight.headings[-1] - flight.headings[0] > 2 * math.pi
    assert np.abs(flight.heights - 80.0).max() < bound


def _rooted(tmp_path, model):
    shutil.copytree(ROOT / "worlds" / "empty", tmp_path / "worlds" / "empty")
    shutil.copytree(ROOT / "vehicles" / model, tmp_path / "vehicles" / model)
    return tmp_path


def test_an_aircraft_of_jsbsim_becomes_a_vehicle_by_a_folder(tmp_path):
    shutil.copytree(ROOT / "worlds" / "empty", tmp_path / "worlds" / "empty")
    own, folder = Path(jsbsim.get_default_root_dir()), tmp_path / "vehicles" / "skyhawk"
    shutil.copytree(own / "aircraft" / "c172p", folder / "c172p")
    shutil.copytree(own / "engine", folder / "engine")
    shutil.copytree(own / "systems", folder / "systems")
    (folder / "vehicle.yaml").write_text(SKYHAWK)
    flight = Flight(tmp_path, "skyhawk").run(20.0)
    assert np.abs(flight.heights - 80.0).max() < 10.0
