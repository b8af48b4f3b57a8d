"""Linear models of the running aircraft against the book's formulas with its coefficients."""

import gc
from pathlib import Path

import numpy as np
import pytest

from services.sim_air.analysis.linear import linearize, state_of
from services.sim_air.engine.airframe import Airframe
from services.sim_air.engine.states import InitialState
from tests import aerosonde
from uvf.control.design.design_models import design_models
from uvf.maths import atmosphere
from uvf.maths.eigenmodes import lateral_modes, longitudinal_modes
from uvf.maths.geodesy import LocalTangent
from uvf.models.scenario import ROOT
from uvf.models.vehicle.file import load_vehicle
from uvf.models.yaml_data import BadInput

FOLDER = Path(ROOT) / "vehicles" / "milvus"
G = 9.8023  # m/s^2 at 40.77 deg and 100 m
CASES = [(20.0, 100.0), (25.0, 100.0), (28.0, 1500.0)]


def aircraft():
    return Airframe(FOLDER, load_vehicle(FOLDER.parent, "milvus").air, LocalTangent.from_degrees(40.77, 14.79, 0.0))


@pytest.fixture(scope="module", params=CASES, ids=str)
def both(request):
    """The running model's and the paper's, and the paper's names by sides."""
    speed, altitude = request.param
    models = linearize(aircraft(), speed, altitude, FOLDER)
    rho = atmosphere.density(atmosphere.pressure(altitude), atmosphere.T0 - atmosphere.LAPSE * altitude)
    paper = aerosonde.trimmed(speed, rho, G)
    return models, paper, aerosonde.longitudinal(paper, rho, G), aerosonde.lateral(paper, rho, G)


def test_trim_is_that_of_the_coefficients(both):
    models, paper, *_ = both
    assert models.residual < 1e-6
    assert (models.trim.alpha, models.trim.elevator) == pytest.approx((paper.alpha, paper.elevator), rel=5e-3)
    assert models.trim.throttle == pytest.approx(paper.throttle, rel=0.02)


def test_every_slope_is_that_of_the_book(both):
    """Within 1 % of each row's largest in kind, those of the propeller within 4 %: it stands in a table and feels u instead of V."""
    models, _, longitudinal, lateral = both
    assert models.lateral.a == pytest.approx(lateral.a, rel=0.01, abs=0.01)
    assert models.lateral.b == pytest.approx(lateral.b, rel=0.01, abs=0.01)
    assert models.longitudinal.a[1:] == pytest.approx(longitudinal.a[1:], rel=0.01, abs=0.01)
    assert models.longitudinal.a[0] == pytest.approx(longitudinal.a[0], rel=0.04, abs=0.005)
    assert models.longitudinal.b[:, 0] == pytest.approx(longitudinal.b[:, 0], rel=0.01, abs=0.002)
    assert models.longitudinal.b[:, 1] == pytest.approx(longitudinal.b[:, 1], rel=0.04, abs=0.001)


def test_eigenvalues_are_those_of_the_book(both):
    models, _, longitudinal, lateral = both
    for mode, paper in zip(models.modes, [*longitudinal_modes(longitudinal.a), *lateral_modes(lateral.a)], strict=True):
        assert mode.name == paper.name
        assert mode.eigenvalue == pytest.approx(paper.eigenvalue, rel=0.03, abs=0.002), mode.name


def test_transfer_functions_are_those_of_the_book(both):
    models, paper, longitudinal, lateral = both
    expected = vars(design_models(longitudinal, lateral, models.trim.airspeed, paper.alpha))
    assert vars(models.design) == {name: pytest.approx(value, rel=0.03) for name, value in expected.items()}


def test_the_sides_taken_apart_have_the_modes_of_the_whole(both):
    """The propeller's angular momentum and torque couple them a little."""
    models, *_ = both
    whole = np.linalg.eigvals(models.whole.a)
    for mode in models.modes:
        nearest = whole[np.argmin(np.abs(whole - mode.eigenvalue))]
        assert mode.eigenvalue == pytest.approx(nearest, rel=0.02, abs=0.005), mode.name


def test_linearizing_leaves_the_aircraft_able_to_fly():
    airframe = aircraft()
    linearize(airframe, 25.0, 100.0, FOLDER)
    airframe.start(InitialState(np.array((0.0, 0.0, 100.0)), np.pi / 2, 25.0, np.zeros(3)))
    before = state_of(airframe.motion(), 0.0)
    for _ in range(200):
        airframe.step()
    after = state_of(airframe.motion(), 0.0)
    assert after == pytest.approx(before, abs=0.01)
    assert airframe.motion().position[1] > 24.0


def test_the_state_is_told_with_the_books_axes():
    airframe = aircraft()
    trim = airframe.start(InitialState(np.array((0.0, 0.0, 100.0)), np.pi / 2 - 0.4, 25.0, np.zeros(3)))
    u, v, w, p, q, r, phi, theta, psi, h = state_of(airframe.motion(), 50.0)
    assert (u, w) == pytest.approx((25 * np.cos(trim.alpha), 25 * np.sin(trim.alpha)), abs=1e-3)
    assert (phi, theta, psi, h) == pytest.approx((trim.roll, trim.alpha, 0.4, 150.0), abs=1e-3)
    assert np.abs((v, p, q, r)).max() < 0.05


def test_a_speed_that_it_cannot_fly_is_refused():
    with pytest.raises(BadInput, match=r"no level flight at 60 m/s and 100 m"):
        linearize(aircraft(), 60.0, 100.0, FOLDER)
    gc.collect()  # the engine of a refused one can be taken down


@pytest.mark.parametrize("name", ["stick25", "nas10"])
def test_other_aircraft_have_models_too(name):
    """A trainer, and an airship without ailerons whose level flight needs side slip."""
    folder = FOLDER.parent / name
    body = load_vehicle(FOLDER.parent, name).air
    models = linearize(Airframe(folder, body, LocalTangent.from_degrees(45.0, 0.0, -100.0)), body.trim_speed, 100.0, folder)
    assert models.residual < 1e-3
    assert all(mode.eigenvalue.real < 0.2 for mode in models.modes)
    assert models.design.a_phi1 > 0
