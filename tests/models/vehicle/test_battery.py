"""The battery: what is drawn is what is gone, its voltage gives way under load, and the motors get no more of it than there is."""

from math import sqrt

import pytest

from uvf.models.vehicle.air import BatteryPack
from uvf.models.vehicle.battery import Charge, lasts

IDEAL = BatteryPack(energy=1000.0, full=50.0, empty=40.0)
REAL = BatteryPack(energy=2.6e6, full=50.4, empty=42.0, resistance=0.06, rated=44.4)


def test_an_ideal_battery_gives_its_energy_and_sinks_in_voltage():
    charge = Charge(IDEAL)
    charge.draw(100.0, 5.0)
    assert charge.remaining == pytest.approx(0.5)
    assert charge.voltage == pytest.approx(45.0)
    charge.draw(100.0, 0.1)
    assert charge.current * 45.0 == pytest.approx(100.0)


def test_an_empty_battery_stays_empty_and_stops_the_motors():
    charge = Charge(BatteryPack(energy=10.0, full=50.0, empty=40.0, avionics=5.0))
    assert charge.throttle(0.7) == 0.7
    charge.draw(0.0, 100.0)
    assert charge.remaining == 0.0
    assert charge.throttle(0.7) == 0.0


def test_under_load_the_voltage_settles_where_what_is_lost_is_resistance_times_current():
    """V = (E + sqrt(E^2 - 4 R P)) / 2."""
    charge = Charge(REAL)
    for _ in range(2000):
        charge.draw(1500.0, 0.005)
    cells = charge.open_circuit
    assert charge.voltage == pytest.approx((cells + sqrt(cells**2 - 4 * 0.06 * 1500.0)) / 2, abs=1e-3)
    assert charge.current == pytest.approx(1500.0 / charge.voltage, rel=1e-4)


def test_the_motors_get_no_more_than_the_voltage_that_there_is():
    charge = Charge(REAL)
    assert charge.throttle(1.0) == 1.0, "full, it has more than the motor is rated for"
    while charge.remaining > 0.01:
        charge.draw(1500.0, 0.5)
    assert charge.throttle(1.0) == pytest.approx(charge.voltage / 44.4)
    assert charge.throttle(1.0) < 0.92
    assert charge.throttle(0.5) == 0.5


@pytest.mark.parametrize("power", [200.0, 1500.0])
def test_it_lasts_as_long_as_it_takes_to_draw_it_empty_and_as_by_hand(power):
    """By hand, for small R: t = energy / P (1 - R P / (E_full E_empty)), the mean of 1 / E^2 along a straight line."""
    charge, t = Charge(REAL), 0.0
    while charge.remaining > 0:
        charge.draw(power, 0.5)
        t += 0.5
    assert lasts(REAL, power) == pytest.approx(t, rel=1e-3)
    assert lasts(REAL, power) == pytest.approx(2.6e6 / power * (1 - 0.06 * power / (50.4 * 42.0)), rel=5e-3)


def test_a_load_beyond_what_it_can_give_takes_half_its_voltage_and_no_more():
    charge = Charge(REAL)
    for _ in range(2000):
        charge.draw(50_000.0, 0.005)
        assert charge.voltage >= 0.5 * charge.open_circuit


def test_a_charger_fills_it_and_no_fuller_than_full():
    charge = Charge(IDEAL, 0.5)
    charge.draw(0.0, 2.0, charger=100.0)
    assert charge.remaining == pytest.approx(0.7) and charge.current < 0.0
    charge.draw(0.0, 100.0, charger=100.0)
    assert charge.remaining == 1.0
    charge.draw(0.0, 1.0, charger=100.0)
    assert (charge.remaining, charge.current) == (1.0, 0.0)


def test_a_charger_that_gives_less_than_is_drawn_only_slows_it_down():
    charge = Charge(IDEAL, 0.5)
    charge.draw(30.0, 1.0, charger=20.0)
    assert charge.remaining == pytest.approx(0.49)


def test_an_empty_one_is_filled_again():
    charge = Charge(IDEAL, 0.0)
    charge.draw(0.0, 1.0, charger=100.0)
    assert charge.remaining == pytest.approx(0.1) and charge.throttle(0.7) == 0.7
