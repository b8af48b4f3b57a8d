"""Which file of a folder is JSBSim's model: FlightGear's set files name it, and folders may hold several."""

import pytest

from uvf.models.importing.jsbsim import has_actuators, jsbsim_model
from uvf.models.yaml_data import BadInput

MODEL = '<fdm_config name="x"><flight_control name="f">{}</flight_control></fdm_config>'
SET = "<PropertyList><sim><flight-model>{}</flight-model><aero>{}</aero></sim></PropertyList>"


def test_the_set_file_of_flightgear_names_the_model_beside_it(tmp_path):
    (tmp_path / "rascal.xml").write_text(MODEL)
    (tmp_path / "rascal-set.xml").write_text(SET.format("jsb", "rascal"))
    assert jsbsim_model(tmp_path / "rascal-set.xml") == tmp_path / "rascal.xml"


@pytest.mark.parametrize(
    ("kind", "name", "said"),
    [("yasim", "rascal", "flight model 'yasim'; give an aircraft"), ("jsb", "other", "its JSBSim model other.xml is not there; put it")],
)
def test_a_set_file_without_such_a_model_is_one_line(tmp_path, kind, name, said):
    (tmp_path / "rascal.xml").write_text(MODEL)
    (tmp_path / "rascal-set.xml").write_text(SET.format(kind, name))
    with pytest.raises(BadInput, match=said):
        jsbsim_model(tmp_path / "rascal-set.xml")


def test_a_folder_with_one_model_is_that_model_and_of_several_one_is_to_be_named(tmp_path):
    (tmp_path / "one.xml").write_text(MODEL)
    (tmp_path / "dialog.xml").write_text("<PropertyList/>")
    assert jsbsim_model(tmp_path) == tmp_path / "one.xml"
    (tmp_path / "two.xml").write_text(MODEL)
    with pytest.raises(BadInput, match=r"2 JSBSim models lie there, one\.xml, two\.xml: name one of them"):
        jsbsim_model(tmp_path)
    (tmp_path / f"{tmp_path.name}.xml").write_text(MODEL)
    assert jsbsim_model(tmp_path) == tmp_path / f"{tmp_path.name}.xml"


def test_what_is_not_jsbsims_is_left_to_others(tmp_path):
    (tmp_path / "robot.xml").write_text("<robot/>")
    assert jsbsim_model(tmp_path) is None and jsbsim_model(tmp_path / "robot.xml") is None


def test_servos_in_the_model_are_seen(tmp_path):
    (tmp_path / "a.xml").write_text(MODEL.format('<channel name="r"><actuator name="fcs/r"><lag>20</lag></actuator></channel>'))
    (tmp_path / "b.xml").write_text(MODEL.format(""))
    assert has_actuators(tmp_path / "a.xml") and not has_actuators(tmp_path / "b.xml")
