"""The table of failsafes: each begins on its cause and ends with it, orders what its parameter says, and does not flap."""

import re

import msgspec
import pytest

from services.autopilot.air.failsafes.table import AIR_RULES, FailsafeInputs
from services.autopilot.failsafes import FailsafeAction, FailsafeWatch, RuleChange
from uvf.models.scenario import ROOT
from uvf.models.vehicle.failsafe_params import FailsafeParams
from uvf.models.vehicle.flight_params import AirParams

PARAMS = AirParams()
DT = 0.02
CAUSES = {
    "link": {"silence": 6.0},
    "sticks": {"stick_released": True},
    "gnss": {"gnss_age": 3.0},
    "estimator": {"sigma": 60.0},
    "position": {"lost_for": 130.0},
    "air_data": {"has_air_data": False},
    "airspeed": {"pitot_gap": -9.0},
    "battery_low": {"charge": 0.12},
    "battery_critical": {"charge": 0.05},
    "battery_emergency": {"charge": 0.03},
    "fence": {"fence": -1.0},
    "breach": {"breached": True},
    "saturation": {"stop": "elevator", "stopped_for": 11.0},
    "attitude": {"roll": 1.5},
    "wind": {"wind": 20.0},
}
IN_BETWEEN = {
    "estimator": {"sigma": 45.0},
    "battery_low": {"charge": 0.16},
    "battery_critical": {"charge": 0.08},
    "battery_emergency": {"charge": 0.06},
    "saturation": {"stop": "elevator", "stopped_for": 1.0},
    "attitude": {"roll": 1.2},
    "wind": {"wind": 16.0},
}
RULES = {rule.name: rule for rule in AIR_RULES}


def known(**changes):
    return FailsafeInputs(PARAMS, **changes)


def run(watch, seconds, **changes):
    """(changes, orders) while it stays so."""
    seen, orders = [], []
    for _ in range(round(seconds / DT)):
        changed, order = watch.step(known(**changes), DT)
        seen += [(c.rule.name, c.began) for c in changed]
        orders += [order] if order else []
    return seen, orders


def test_every_rule_has_a_cause_here():
    assert list(CAUSES) == list(RULES)


@pytest.mark.parametrize("name", RULES)
def test_it_begins_on_its_cause_after_its_time_and_ends_after_the_cause(name):
    watch, rule = FailsafeWatch([RULES[name]]), RULES[name]
    after = rule.after(known())
    assert run(watch, max(after - 0.1, 0.0), **CAUSES[name])[0] == []
    assert run(watch, 0.2, **CAUSES[name])[0] == [(name, True)]
    assert run(watch, 20.0, **CAUSES[name])[0] == []
    assert run(watch, max(rule.clear_delay - 0.1, 0.0))[0] == []
    assert run(watch, 0.2)[0] == [(name, False)]


@pytest.mark.parametrize("name", IN_BETWEEN)
def test_between_the_limits_nothing_changes(name):
    watch = FailsafeWatch([RULES[name]])
    assert run(watch, 60.0, **IN_BETWEEN[name])[0] == []
    run(watch, 60.0, **CAUSES[name])
    assert run(watch, 60.0, **IN_BETWEEN[name])[0] == []


@pytest.mark.parametrize("name", [n for n in RULES if RULES[n].clear_delay])
def test_a_cause_that_comes_and_goes_does_not_flap(name):
    watch = FailsafeWatch([RULES[name]])
    run(watch, 60.0, **CAUSES[name])
    for _ in range(10):
        assert run(watch, RULES[name].clear_delay / 2)[0] == []
        assert run(watch, 0.1, **CAUSES[name])[0] == []


ACTED = [(n, p) for n, r in RULES.items() for p in r.parameters if p.endswith("_action") and p != "fence_action"]


@pytest.mark.parametrize(("name", "parameter"), ACTED)
@pytest.mark.parametrize("choice", ["warn", "hold", "return", "land"])
def test_the_parameter_decides_what_is_done(name, parameter, choice):
    changed = FailsafeInputs(msgspec.structs.replace(PARAMS, **{parameter: choice}))
    assert RULES[name].action(changed) is FailsafeAction[choice.upper()]


def test_nobody_at_the_stick_is_told_when_it_shall_only_be_waited_for():
    waiting = FailsafeInputs(msgspec.structs.replace(PARAMS, stick_action="wait"), stick_released=True)
    assert RULES["sticks"].action(waiting) is FailsafeAction.WARN


def test_the_way_home_counts_before_the_battery_is_low():
    watch = FailsafeWatch(AIR_RULES)
    assert run(watch, 10.0, charge=0.4, spare=0.2) == ([], [])
    seen, (order,) = run(watch, 10.0, charge=0.4, spare=0.05)
    assert seen == [("battery_low", True)]
    assert order.action is FailsafeAction.RETURN
    assert "5 % at home" in order.rule.detail(known(charge=0.4, spare=0.05))


def test_an_order_is_given_once_and_a_greater_one_goes_beyond_it():
    watch = FailsafeWatch(AIR_RULES)
    _, first = run(watch, 10.0, charge=0.12)
    _, second = run(watch, 10.0, charge=0.05)
    assert [o.action for o in first + second] == [FailsafeAction.RETURN, FailsafeAction.LAND]
    assert run(watch, 10.0, charge=0.05, silence=20.0)[1] == []


def test_after_an_operator_has_asked_for_a_mode_only_a_new_cause_orders_again():
    watch = FailsafeWatch(AIR_RULES)
    run(watch, 10.0, charge=0.12)
    watch.overrule()
    assert run(watch, 60.0, charge=0.12)[1] == []
    (order,) = run(watch, 10.0, charge=0.12, silence=20.0)[1]
    assert order.rule.name == "link"


def test_on_the_ground_nobody_is_missed():
    assert run(FailsafeWatch(AIR_RULES), 10.0, airborne=False, silence=60.0, roll=2.0, breached=True, wind=30.0) == ([], [])


def test_every_parameter_is_used_by_a_rule():
    assert {p for rule in AIR_RULES for p in rule.parameters} == set(FailsafeParams.__struct_fields__)
    assert all(len(name) <= 16 for name in FailsafeParams.__struct_fields__)


def test_the_documented_table_is_that_of_the_code():
    text = (ROOT / "docs" / "reference" / "failsafes.md").read_text().partition("## Ground")[0]
    rows = [[c.strip() for c in line.strip("|").split("|")] for line in text.splitlines() if line.startswith("| `")]
    shown = {row[0].strip("`"): row for row in rows}
    assert [name for name in shown if name in RULES] == list(RULES)
    for name, rule in RULES.items():
        assert re.findall(r"`(\w+)`", shown[name][2]) == list(rule.parameters), name
        assert rule.raised_text.split(":")[0] in shown[name][4], name


@pytest.mark.parametrize("rule", AIR_RULES, ids=lambda rule: rule.name)
def test_the_end_of_a_failsafe_quotes_no_figure_of_its_beginning_and_no_text_reads_as_an_order(rule):
    assert RuleChange(rule, True, "aileron for 3 s").event(0.0).cause == "aileron for 3 s"
    assert RuleChange(rule, False, "aileron for 0 s").event(0.0).cause == ""
    assert "less bank" not in rule.raised_text
