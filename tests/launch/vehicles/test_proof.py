"""The flights that prove a tuning: what is measured of them, what is told, and one of them flown."""

import math
import shutil
from dataclasses import replace
from unittest import mock

import numpy as np
import pytest
import yaml
from typer.testing import CliRunner

from launch.commands.vehicle import vehicle_app
from launch.vehicles import proof, tuning
from launch.vehicles.proof import AIRS, BANK, CIRCLE, CLIMB, CORNER, GOALS, HEIGHTS, LEGS, PLACE, SINK, SURFACES, Proof, figures
from launch.vehicles.proof_flight import ProofCourse, ProofFlight, followed, proof_flight
from uvf.models.scenario import ROOT
from uvf.models.vehicle.file import load_vehicle
from uvf.models.yaml_data import BadInput

COURSE = ProofCourse(20.0, 60.0, 0.0, AIRS["calm"])
STEPS = COURSE.steps


def track(beside, sink):
    """(n, 3) along the legs, round the circle, down to its centre at 20 m/s; ``beside`` [m] right of the legs, outside the circle."""
    (east, north), (end, _), (x, y) = COURSE.corner, COURSE.end, COURSE.centre
    step = 20.0 * 0.02
    up = [(beside, s) for s in np.arange(0.0, north, step)]
    along = [(s, north - beside) for s in np.arange(east, end, step)]
    angles = np.arange(math.pi / 2, math.pi / 2 - 2 * math.tau, -step / COURSE.radius)
    around = [(x + (60.0 + beside) * math.cos(a), y + (60.0 + beside) * math.sin(a)) for a in angles]
    over = [(x, y - s) for s in np.arange(600.0, 0.0, -step)]
    heights = [COURSE.start] * (len(up) + len(along) + len(around)) + list(0.4 + sink * 0.02 * np.arange(len(over), 0, -1))
    return np.column_stack([np.array([*up, *along, *around, *over]), heights])


def flight(beside=0.0, sink=0.5, standing=100, **changes):
    """One that lands with this sink [m/s] at the end of its track."""
    flown = track(beside, sink)
    position = np.vstack([flown, np.repeat(flown[-1:], standing, axis=0)])
    t = 0.02 * np.arange(len(position))
    climb = np.where(t < t[len(flown) - 1], -sink, 0.0)
    climb[(t >= STEPS.climb) & (t < STEPS.hold)] = 1.0
    climb[(t >= STEPS.climb + 1.0) & (t < STEPS.climb + 1.5)] = 1.2
    bank = np.where((t >= STEPS.right) & (t < STEPS.left), 0.4, 0.0)
    bank[(t >= STEPS.right + 1.0) & (t < STEPS.right + 1.2)] = 0.44
    surfaces = np.column_stack([np.radians(1.0) * np.sin(math.tau * t), np.zeros(len(t)), np.zeros(len(t))])
    made = ProofFlight(COURSE, t, position, climb, bank, t, surfaces, t[::5], np.full(len(t[::5]), beside), "", True, ["that is it"])
    return replace(made, **changes)


def test_steps_legs_corner_circle_surfaces_and_touch_are_measured():
    found = figures(flight(beside=0.25, sink=0.6))
    assert found[BANK] == pytest.approx(10.0, abs=0.1)
    assert found[CLIMB] == pytest.approx(20.0, abs=0.1)
    assert found[LEGS] == pytest.approx(0.25, abs=1e-3)
    assert found[HEIGHTS] == pytest.approx(0.0, abs=1e-6)
    assert found[CORNER] == pytest.approx(0.25)
    assert found[CIRCLE] == pytest.approx(0.25, abs=0.01)
    assert found[SURFACES] == pytest.approx(4.0, rel=0.01)  # a sine of 1 deg once a second
    assert found[SINK] == pytest.approx(0.6, rel=0.05)
    assert found[PLACE] < 6.0


def test_a_touch_like_a_feather_counts_and_a_wreck_has_no_sink():
    assert figures(flight(sink=0.05))[SINK] < 0.15
    assert SINK not in figures(flight(crash="nose on the ground", complete=False))


def test_what_was_not_flown_is_not_met():
    short = flight(crash="wing on the ground", complete=False)
    first = short.t < 60.0
    short = replace(short, t=short.t[first], position=short.position[first], climb=short.climb[first], bank=short.bank[first])
    whole = [replace(flight(), course=replace(COURSE, air=air)) for air in AIRS.values()]
    told = list(_proof([short, *whole[1:]]).lines())
    assert told[0] == "proof flight, calm: crashed, wing on the ground"
    assert told[-1].startswith("proof flight: not met: beside the legs, RMS;")
    late = replace(whole[1], complete=False)
    assert "light turbulence: not at its end after" in next(_proof([whole[0], late, whole[2]]).lines())


def _proof(flights):
    return Proof(flights, [figures(one) for one in flights])


def test_lengths_that_are_wanted_grow_with_the_airspeed_and_a_glider_holds_no_height():
    goal = {one.name: one for one in GOALS}
    assert goal[LEGS].at(40.0) == pytest.approx([0.6, 1.2, 2.0])
    assert goal[LEGS].at(12.0) == [0.3, 0.6, 1.0]
    assert goal[SURFACES].at(40.0) == [0.8, 4.5, 9.0]
    glider = [replace(flight(), course=replace(COURSE, glide=0.05, air=air)) for air in AIRS.values()]
    assert _proof(glider).met(goal[HEIGHTS]) and _proof(glider).met(goal[CLIMB])


def test_servos_follow_with_their_lag():
    body = load_vehicle(ROOT / "vehicles", "milvus").air
    t = np.arange(0.0, 1.0, 0.01)
    asked = np.column_stack([np.where(t > 0.5, 0.1, 0.0)] * 3)
    found = followed(asked, t, body)
    at = np.searchsorted(t, 0.505 + body.servo_lag)
    assert found[at, 0] == pytest.approx(0.1 * (1 - math.exp(-1)), rel=0.15)
    assert found[-1, 2] == pytest.approx(0.1, rel=1e-3)


def test_written_figures_are_proved_and_what_is_not_met_is_told():
    class Tuned:
        folder, unmet = ROOT / "vehicles" / "stick25", ()

    whole = [replace(flight(beside=0.4), course=replace(COURSE, air=air)) for air in AIRS.values()]
    with (
        mock.patch.object(tuning, "tune", return_value=Tuned()),
        mock.patch.object(tuning, "write", return_value=Tuned.folder / "vehicle.yaml"),
        mock.patch.object(tuning, "tables", return_value=()),
        mock.patch.object(proof, "prove", return_value=_proof(whole)),
    ):
        done = CliRunner().invoke(vehicle_app, ["tune", "stick25", "--write"])
    assert done.exit_code == 0, done.output
    assert "vehicle.yaml has them now" in done.output
    assert "0.40 of 0.3" in done.output
    assert "not met: beside the legs, RMS" in done.output


@pytest.mark.timeout(300)
def test_stick25_proves_its_figures_in_still_air():
    flown = proof_flight(ROOT / "vehicles" / "stick25", AIRS["calm"])
    assert flown.complete and not flown.crash
    found = figures(flown)
    for goal in GOALS:
        if goal.name != SURFACES:  # its own gyroscopes shake them more than those that the goal is for
            assert found[goal.name] <= goal.most[0], goal.name
    assert found[SURFACES] < 1.2


def test_what_has_no_gyroscopes_is_not_flown(tmp_path):
    folder = shutil.copytree(ROOT / "vehicles" / "stick25", tmp_path / "stick25")
    file = folder / "vehicle.yaml"
    data = yaml.safe_load(file.read_text())
    del data["sensors"]["imu"]
    file.write_text(yaml.safe_dump(data))
    with pytest.raises(BadInput, match=r"stick25/vehicle.yaml: sensors: no imu, without which"):
        proof_flight(folder, AIRS["calm"])
