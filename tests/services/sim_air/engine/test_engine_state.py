"""A second engine brought into the state of a first one goes on nearly as that does, and always alike."""

from dataclasses import replace

import numpy as np
import pytest

from services.sim_air.engine.airframe import Airframe
from services.sim_air.engine.states import InitialState
from services.sim_air.engine.wiring import Controls
from uvf.maths.geodesy import LocalTangent
from uvf.models.scenario import ROOT
from uvf.models.vehicle.file import load_vehicle

TANGENT = LocalTangent.from_degrees(40.77, 14.79, 300.0)
UP = np.array((0.0, 0.0, 150.0))


def manoeuvring(name):
    """Rolling, its propeller slowing down since a tenth of a second, at the commands that hold."""
    body = load_vehicle(ROOT / "vehicles", name).air
    airframe = Airframe(ROOT / "vehicles" / name, body, TANGENT)
    trim = airframe.start(InitialState(UP, 0.3, body.trim_speed, np.zeros(3))).controls
    for aileron, throttle, seconds in ((0.03, 0.1, 2.0), (-0.02, -0.2, 0.1)):
        fly(airframe, replace(trim, aileron=trim.aileron + aileron, throttle=trim.throttle + throttle), round(seconds * body.physics_hz))
    return airframe, round(5 * body.physics_hz)


def fly(airframe, controls, steps):
    if controls is not None:
        airframe.command(controls)
    for _ in range(steps):
        airframe.step()


@pytest.mark.parametrize(("name", "bound"), [("milvus", 1e-3), ("stick25", 1e-3), ("nas10", 1e-4)])
def test_it_goes_on_as_the_first_one_does(name, bound):
    """Bound: m after 5 s."""
    first, steps = manoeuvring(name)
    second = first.restored(first.save())
    assert second.joints()[-1].speed == pytest.approx(first.joints()[-1].speed, rel=1e-4)
    for airframe in (first, second):
        fly(airframe, None, steps)
    assert np.linalg.norm(first.motion().position - second.motion().position) < bound
    assert np.linalg.norm(first.motion().velocity - second.motion().velocity) < bound
    assert np.linalg.norm(first.motion().position - UP) > 5.0


def test_two_of_one_state_go_on_to_the_last_bit_alike():
    first, steps = manoeuvring("milvus")
    state = first.save()
    motions = []
    for _ in range(2):
        second = first.restored(state)
        fly(second, None, steps)
        motions.append(second.motion())
    assert motions[0].position.tobytes() == motions[1].position.tobytes()
    assert motions[0].world_from_body.tobytes() == motions[1].world_from_body.tobytes()


def test_what_stands_stands_where_it_stood():
    body = load_vehicle(ROOT / "vehicles", "milvus").air
    first = Airframe(ROOT / "vehicles" / "milvus", body, TANGENT)
    first.stand(InitialState(np.zeros(3), 0.5, 0.0, np.zeros(3)))
    first.command(Controls(brake=1.0))
    place = first.motion().position
    second = first.restored(first.save())
    fly(second, None, round(3 * body.physics_hz))
    assert np.linalg.norm(second.motion().position - place) < 2e-3
    assert [touch.name for touch in second.touches()] == [touch.name for touch in first.touches()]
