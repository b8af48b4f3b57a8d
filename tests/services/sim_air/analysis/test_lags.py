"""What a model's own filters and actuators add to the servos: found by a step of the command."""

import pytest

from launch.vehicles.linearize import airframe_of
from services.sim_air.analysis.equilibrium import level
from services.sim_air.analysis.lags import lags
from services.sim_air.analysis.linear import held_still
from uvf.models.scenario import ROOT

LAG = """<lag_filter name="fcs/late"><input>fcs/elevator-cmd-norm</input><c1>8.0</c1><output>fcs/late-norm</output></lag_filter>"""


@pytest.fixture
def late_elevator(tmp_path):
    """stick25 whose elevator follows its command behind a lag of 1/8 s, in the model itself."""
    import shutil

    folder = shutil.copytree(ROOT / "vehicles" / "stick25", tmp_path / "stick25")
    model = folder / "stick25" / "stick25.xml"
    text = model.read_text()
    channel = text.index("<channel", text.index("<flight_control"))
    begin = text.index(">", channel) + 1
    text = text[:begin] + LAG + text[begin:].replace("fcs/elevator-cmd-norm", "fcs/late-norm")
    model.write_text(text)
    return folder


def found(folder, speed=17.0):
    airframe = airframe_of(folder)
    with held_still(airframe):
        trim = level(airframe, speed, 200.0)
        assert trim is not None
        return lags(airframe, trim, 400.0)


def test_a_model_without_any_has_none_but_its_propeller():
    delays = found(ROOT / "vehicles" / "stick25")
    assert (delays["aileron"], delays["elevator"], delays["rudder"]) == (0.0, 0.0, 0.0)
    assert 0.0 < delays["throttle"] < 0.2


def test_a_filter_in_the_model_is_found(late_elevator):
    delays = found(late_elevator)
    assert delays["elevator"] == pytest.approx(0.125, abs=0.01)
    assert delays["aileron"] == 0.0
