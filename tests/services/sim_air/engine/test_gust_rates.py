"""Air that turns acts on a JSBSim model as the model's own turning does, and does nothing to it when it does not turn."""

from contextlib import nullcontext

import numpy as np
import pytest

from services.sim_air.engine import airframe as module
from services.sim_air.engine.airframe import Airframe
from services.sim_air.engine.gust_rates import with_gust_rates
from services.sim_air.engine.states import Held, InitialState
from services.sim_air.engine.wiring import Controls
from services.sim_air.environment.wind import AirMotion
from uvf.maths.geodesy import LocalTangent
from uvf.models.jsbsim.model_file import read
from uvf.models.scenario import ROOT
from uvf.models.vehicle.file import load_vehicle

BODY = load_vehicle(ROOT / "vehicles", "milvus").air
FOLDER = ROOT / "vehicles" / "milvus"
TANGENT = LocalTangent.from_degrees(40.77, 14.79, 300.0)
RATE = 0.1  # rad/s


def accelerations(rates, gust):
    aircraft = Airframe(FOLDER, BODY, TANGENT)
    aircraft.set_wind(AirMotion(np.zeros(3), np.array(gust)))
    aircraft.hold_still(True)
    held = Held(np.array((25.0, 0.0, 1.0)), np.array(rates), np.array((0.0, 0.04, 0.0)), 400.0)
    return aircraft.accelerations_held(held, Controls(elevator=-0.1, throttle=0.7))


@pytest.mark.parametrize(("axis", "felt"), [(0, (3, 5)), (1, (4,)), (2, (3, 5))])
def test_air_that_turns_one_way_is_felt_as_turning_the_other_way(axis, felt):
    """p and r are felt in roll and yaw, q in pitch; what a turning body feels beside it (its inertia) is left out."""
    still = accelerations(np.zeros(3), np.zeros(3))
    turning, blown = np.zeros(3), np.zeros(3)
    turning[axis], blown[axis] = RATE, -RATE
    own, met = accelerations(turning, np.zeros(3)) - still, accelerations(np.zeros(3), blown) - still
    for i in felt:
        assert abs(own[i]) > 0.01
        assert met[i] == pytest.approx(own[i], rel=0.03)


def test_without_a_gust_the_flight_is_the_same_to_the_last_bit(monkeypatch):
    def flown():
        aircraft = Airframe(FOLDER, BODY, TANGENT)
        aircraft.start(InitialState(np.array((0.0, 0.0, 60.0)), 0.3, 25.0, np.array((2.0, 1.0, 0.0))))
        aircraft.command(Controls(aileron=0.05, elevator=-0.12, rudder=0.02, throttle=0.8))
        for _ in range(400):
            aircraft.step()
        return aircraft.motion()

    changed = flown()
    monkeypatch.setattr(module, "with_gust_rates", lambda path: nullcontext(path.parent.parent))
    plain = flown()
    assert (changed.position == plain.position).all()
    assert (changed.angular_velocity == plain.angular_velocity).all()


def test_only_the_aerodynamics_are_changed():
    path = FOLDER / BODY.model / f"{BODY.model}.xml"
    with with_gust_rates(path) as folder:
        changed = read(folder / BODY.model / path.name)
    before = read(path)
    assert [section.tag for section in changed] == [section.tag for section in before]
    for old, new in zip(before, changed, strict=True):
        same = [(t.tag, (t.text or "").strip(), t.attrib) for t in old.iter()] == [
            (t.tag, (t.text or "").strip(), t.attrib) for t in new.iter()
        ]
        assert same == (old.tag != "aerodynamics")
