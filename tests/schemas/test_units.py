"""Units are read off the comments of the message files."""

import pytest

from schemas.units import units


@pytest.mark.parametrize(
    ("kind", "field", "unit"),
    [
        ("NavState", "airspeed", "m/s"),
        ("NavState", "position", "m"),
        ("Imu", "angular_velocity", "rad/s"),
        ("Imu", "specific_force", "m/s^2"),
        ("AirData", "static_pressure", "Pa"),
        ("VehicleStatus", "battery_voltage", "V"),
        ("VehicleStatus", "armed", None),
        ("VehicleStatus", "throttle", None),
    ],
)
def test_a_field_has_the_unit_of_its_comment(kind, field, unit):
    assert units().get((f"uvf.v1.{kind}", field)) == unit
