"""Commands and joints reach the properties that the vehicle's file names, and none that the model has not."""

import math

import pytest

from services.sim_air.engine.wiring import Controls, Wiring
from uvf.models.scenario import ROOT
from uvf.models.vehicle.air import AirBody, CommandProperties, JointReading, Lever, Surface, check_air
from uvf.models.vehicle.file import load_vehicle
from uvf.models.yaml_data import BadInput, FileLocation

MILVUS = load_vehicle(ROOT / "vehicles", "milvus").air
STANDARD = ("fcs/aileron-cmd-norm", "fcs/elevator-cmd-norm", "fcs/rudder-cmd-norm", "fcs/flap-cmd-norm", "fcs/throttle-cmd-norm")
HERE = FileLocation("vehicle.yaml", ("air",))


def body(**changes):
    return AirBody(model="x", physics_hz=100.0, trim_speed=20.0, servo_rate=5.0, servo_lag=0.0, **changes)


def written(asked, known=STANDARD, **changes):
    properties = {}
    Wiring(properties, known, body(**changes), HERE).write(asked)
    return properties


def test_what_is_left_out_goes_to_the_standard_names_at_its_limit():
    properties = written(Controls(aileron=0.35, elevator=-0.175, rudder=0.0, throttle=0.7, flap=0.3))
    assert properties == pytest.approx(dict(zip(STANDARD, (1.0, -0.5, 0.0, 0.5, 0.7), strict=True)))


def test_sign_limit_and_name_are_those_of_the_file():
    controls = CommandProperties(aileron=Surface(property="fcs/roll", limit=0.5, sign=-1))
    assert written(Controls(aileron=0.25), (*STANDARD, "fcs/roll"), controls=controls)["fcs/roll"] == -0.5


def test_a_surface_may_go_further_one_way_than_the_other():
    controls = CommandProperties(elevator=Surface(limit=0.07, negative_limit=0.244))
    for deflection, norm in ((0.035, 0.5), (-0.122, -0.5), (-0.244, -1.0)):
        assert written(Controls(elevator=deflection), controls=controls)["fcs/elevator-cmd-norm"] == pytest.approx(norm)
        assert controls.elevator.deflection(norm) == pytest.approx(deflection)


def test_a_surface_that_is_not_there_is_not_moved():
    assert "fcs/flap-cmd-norm" not in written(Controls(flap=0.3), controls=CommandProperties(flap=Surface(limit=0.0)))


def test_a_surface_that_is_not_there_leaves_its_property_to_another():
    controls = CommandProperties(aileron=Surface(property="fcs/rudder-cmd-norm", limit=0.5), rudder=Surface(limit=0.0))
    assert written(Controls(aileron=0.25, rudder=0.3), controls=controls)["fcs/rudder-cmd-norm"] == 0.5


def test_each_engine_gets_the_throttle():
    engines = ("fcs/throttle-cmd-norm", "fcs/throttle-cmd-norm[1]")
    assert written(Controls(throttle=0.4), engines) == dict.fromkeys(engines, 0.4)
    assert written(Controls(throttle=0.4), engines, controls=CommandProperties(throttle=Lever(property=[engines[1]]))) == {engines[1]: 0.4}


def test_the_first_of_several_may_be_written_with_its_number():
    assert (
        written(Controls(throttle=0.4), controls=CommandProperties(throttle=Lever(property="fcs/throttle-cmd-norm[0]")))[STANDARD[-1]]
        == 0.4
    )


def test_a_wheel_that_steers_goes_with_the_rudder_to_the_left():
    assert written(Controls(rudder=0.35), (*STANDARD, "fcs/steer-cmd-norm"))["fcs/steer-cmd-norm"] == -1.0


def test_settings_are_made_at_each_beginning():
    properties = {}
    wiring = Wiring(properties, ("gear/gear-cmd-norm",), body(settings={"gear/gear-cmd-norm": 1.0}), HERE)
    wiring.set_up()
    assert properties == {"gear/gear-cmd-norm": 1.0}


def joints(known, **readings):
    return {j.name: j for j in Wiring(known, known, body(joints=readings), HERE).joints()}


def test_joints_are_told_in_radians_whatever_the_model_counts_in():
    known = {"fcs/left-pos-deg": 90.0, "fcs/flap-pos-norm": 0.5, "e/propeller-rpm": 60.0, "fcs/right-pos-rad[1]": -0.2}
    told = joints(
        known,
        left=JointReading(position="fcs/left-pos-deg"),
        right=JointReading(position="fcs/right-pos-rad[1]"),
        flap=JointReading(position="fcs/flap-pos-norm", limit=0.6),
        propeller=JointReading(speed="e/propeller-rpm"),
    )
    assert told["left"].position == pytest.approx(math.pi / 2)
    assert told["right"].position == -0.2
    assert told["flap"].position == pytest.approx(0.3)
    assert (told["propeller"].speed, told["propeller"].position) == (pytest.approx(2 * math.pi), 0.0)


def test_without_joints_in_the_file_the_standard_ones_that_the_model_has_are_told():
    assert set(joints({"fcs/elevator-pos-rad": 0.1, "fcs/rudder-pos-rad": 0.0})) == {"elevator", "rudder"}


BAD = {
    "controls: aileron: property: the model has no property 'fcs/aileron-cmd'; did you mean 'fcs/aileron-cmd-norm'?": {
        "controls": CommandProperties(aileron=Surface(property="fcs/aileron-cmd"))
    },
    "controls: throttle: property: the model has no property 'fcs/throttle-cmd-norm[1]'; did you mean 'fcs/throttle-cmd-norm'?": {
        "controls": CommandProperties(throttle=Lever(property=["fcs/throttle-cmd-norm", "fcs/throttle-cmd-norm[1]"]))
    },
    "joints: tail: position: the model has no property 'fcs/elevator-pos-rad'; did you mean 'fcs/elevator-cmd-norm'?": {
        "joints": {"tail": JointReading(position="fcs/elevator-pos-rad")}
    },
    "settings: gear/gear-cmd-norm: the model has no property 'gear/gear-cmd-norm'": {"settings": {"gear/gear-cmd-norm": 1.0}},
}


@pytest.mark.parametrize("why", BAD)
def test_a_property_that_the_model_has_not_is_refused_with_its_place_and_the_nearest(why):
    with pytest.raises(BadInput) as caught:
        written(Controls(), **BAD[why])
    assert str(caught.value).startswith(f"vehicle.yaml: air: {why}")


@pytest.mark.parametrize(
    ("reading", "why"),
    [
        (JointReading(), "give either position: or speed:"),
        (JointReading(position="fcs/x-pos-rad", speed="e/x-rpm"), "give either position: or speed:"),
        (JointReading(position="fcs/x-pos-ft"), "the unit of 'fcs/x-pos-ft' is not known; take a property that ends in -rad, -deg, -norm"),
        (JointReading(speed="e/x-pos-rad"), "take a property that ends in -rpm, -rad_sec"),
    ],
)
def test_a_joint_whose_unit_cannot_be_known_is_refused(reading, why):
    with pytest.raises(BadInput, match="joints: odd") as caught:
        check_air(body(joints={"odd": reading}), HERE)
    assert why in str(caught.value)


def test_a_misspelt_command_is_refused_with_the_nearest(tmp_path):
    text = (ROOT / "vehicles" / "milvus" / "vehicle.yaml").read_text()
    (tmp_path / "milvus").mkdir()
    (tmp_path / "milvus" / "vehicle.yaml").write_text(text.replace("elevator: {limit", "elevater: {limit"))
    with pytest.raises(BadInput, match=r"vehicle.yaml:\d+: air: controls: elevater: unknown key 'elevater'; did you mean 'elevator'\?"):
        load_vehicle(tmp_path, "milvus")
