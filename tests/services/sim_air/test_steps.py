"""Small steps of the controls: the aircraft flies as its linear models say."""

import numpy as np
import pytest

from benchmarks.sim.air.flight_dynamics import MANOEUVRES, fly
from launch.vehicles.linearize import linear_models
from uvf.models.scenario import ROOT

WITHIN = {  # %
    "roll to aileron": 1.0,
    "pitch to elevator": 1.0,
    "pitch to elevator, phugoid": 1.0,
    "airspeed to throttle": 8.0,  # the propeller's torque rolls it, and the ailerons that hold it are drag
    "Dutch roll to rudder doublet": 5.0,
}


@pytest.fixture(scope="module")
def models():
    return linear_models(ROOT / "vehicles" / "milvus", 25.0, 100.0)


@pytest.mark.parametrize("name", MANOEUVRES)
def test_the_flight_is_that_of_the_linear_model(models, name):
    response = fly("milvus", models, MANOEUVRES[name])
    assert response.share(response.linear) < WITHIN[name]


def test_the_books_roll_is_right_as_long_as_side_slip_is_small(models):
    response = fly("milvus", models, MANOEUVRES["roll to aileron"])
    early = response.t < 1.0
    assert response.book[early] == pytest.approx(response.flown[early], abs=0.1 * np.abs(response.flown[early]).max())


def test_the_books_pitch_begins_right(models):
    response = fly("milvus", models, MANOEUVRES["pitch to elevator"])
    early = response.t < 0.7
    assert response.book[early] == pytest.approx(response.flown[early], abs=0.1 * np.abs(response.flown[early]).max())
