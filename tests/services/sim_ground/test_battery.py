"""What the wheels' motors draw from the battery."""

import pytest

from services.sim_ground.motor import WheelMotor
from uvf.models.vehicle.air import BatteryPack
from uvf.models.vehicle.file import Motor, _check_ground_battery
from uvf.models.yaml_data import BadInput, FileLocation

MOTOR = WheelMotor(Motor(stall_torque=0.05, no_load_speed=30.0), 0.005)


def test_at_a_stand_all_is_lost_in_the_winding_and_without_load_nothing_is_drawn():
    assert MOTOR.power(0.05, 0.0) == pytest.approx(0.05 * 30.0)
    assert MOTOR.power(0.0, 30.0) == 0.0


def test_on_its_straight_line_it_draws_voltage_times_current():
    """At full voltage current goes with torque, so power is torque times no-load speed everywhere on the line."""
    for speed in (5.0, 15.0, 25.0):
        torque = 0.05 * (1 - speed / 30.0)
        assert MOTOR.power(torque, speed) == pytest.approx(torque * 30.0)


def test_braking_gives_nothing_back():
    assert MOTOR.power(-0.02, 20.0) == 0.0


@pytest.mark.parametrize(("wrong", "says"), [({"power": "a/b"}, "power"), ({"rated": 12.0}, "rated"), ({"empty": 13.0}, "exchange them")])
def test_what_only_an_aircraft_has_and_what_cannot_be_is_refused(wrong, says):
    pack = BatteryPack(**{"energy": 100.0, "full": 12.6, "empty": 9.6, **wrong})
    with pytest.raises(BadInput, match=says):
        _check_ground_battery(pack, FileLocation("vehicle.yaml"))
