"""Instruments say what a pilot expects: signs, scales, numbers."""

import re
import xml.etree.ElementTree as ET
from dataclasses import replace

import numpy as np
import pytest

from services.gcs.view.markup import html
from services.gcs.view.panels.vehicle.instruments import (
    CX,
    CY,
    PX_PER_DEGREE,
    DriveInstruments,
    FlightInstruments,
    drive_panel,
    primary_flight_display,
)

LEVEL = FlightInstruments(0.0, 0.0, np.pi / 2, 24.3, 60.0, 0.4, 25.0, html("MISSION"), True)
STILL = DriveInstruments(0.0, 0.0, 0.0, 0.5, 2.0, None, html("HOLD"), False)


def texts(svg):
    return [t.text for t in ET.fromstring(svg).iter("text")]


def horizon(flight):
    """(rotation about the aircraft symbol [deg, clockwise on the screen], shift down [px])."""
    svg = primary_flight_display(flight)
    turn, cx, cy = map(float, re.search(r"rotate\((\S+) (\S+) (\S+)\)'><g transform='translate", svg).groups())
    assert (cx, cy) == (CX, CY)
    return turn, float(re.search(r"translate\(0 (\S+)\)", svg).group(1))


def test_level_flight_shows_a_level_horizon():
    assert horizon(LEVEL) == pytest.approx((0.0, 0.0))


def test_the_right_wing_down_turns_the_horizon_left():
    assert horizon(replace(LEVEL, roll=np.radians(30)))[0] == pytest.approx(-30)


def test_the_nose_up_lowers_the_horizon():
    assert horizon(replace(LEVEL, pitch=np.radians(10)))[1] == pytest.approx(10 * PX_PER_DEGREE)


def test_speed_altitude_heading_and_climb_are_written_out():
    written = texts(primary_flight_display(LEVEL))
    assert {"24.3", "60", "090", "VS +0.4", "GS 25.0", "MISSION", "ARMED"} <= set(written)


@pytest.mark.parametrize(("heading", "digits"), [(-0.1, "354"), (0.0, "000"), (2 * np.pi - 1e-6, "000"), (np.pi, "180")])
def test_headings_run_from_000_to_359(heading, digits):
    assert digits in texts(primary_flight_display(replace(LEVEL, heading=heading)))


def test_the_speed_tape_is_linear_and_has_no_negative_marks():
    svg = ET.fromstring(primary_flight_display(replace(LEVEL, airspeed=3.0)))
    marks = {int(t.text): float(t.get("y")) for t in svg.iter("text") if t.get("text-anchor") == "end" and (t.text or "").isdigit()}
    assert min(marks) == 0
    steps = np.diff([marks[k] for k in sorted(marks)])
    assert steps == pytest.approx(np.full(len(steps), steps[0]))
    assert steps[0] < 0


@pytest.mark.parametrize("extreme", [{"roll": np.pi}, {"pitch": -np.pi / 2}, {"altitude": -40.0}, {"airspeed": 400.0}])
def test_extremes_are_still_drawn(extreme):
    assert ET.fromstring(primary_flight_display(replace(LEVEL, **extreme))).tag.endswith("svg")


def test_it_is_told_to_those_who_cannot_see_it():
    assert "roll 0 deg, pitch 0 deg, heading 090, 24.3 m/s, 60 m" in primary_flight_display(LEVEL)


def bars(drive):
    """(x, width) of the speed and the turn bar."""
    found = re.findall(r"<rect x='(\S+)' y='\d+' width='(\S+)' height='9' rx='3'", drive_panel(drive))
    return [tuple(map(float, f)) for f in found]


def test_bars_grow_from_the_middle_to_the_side_they_mean():
    (_, still), (_, straight) = bars(STILL)
    assert still == straight == 0.0
    (x, width), _ = bars(replace(STILL, speed=0.25))
    assert (x, width) == pytest.approx((251, 37.5))
    (x, width), _ = bars(replace(STILL, speed=-0.5))
    assert (x, width) == pytest.approx((176, 75))
    _, (x, width) = bars(replace(STILL, turn_rate=1.0))
    assert x + width == pytest.approx(251)


def test_bars_end_at_their_track():
    assert bars(replace(STILL, speed=9.0, turn_rate=-9.0)) == [(251, 75), (251, 75)]


def test_the_drivers_panel_writes_its_numbers():
    written = texts(drive_panel(replace(STILL, heading=np.pi / 2, speed=0.21, turn_rate=0.3, distance_left=2.44)))
    assert {"090", "+0.21 m/s", "+17 °/s", "2.4 m", "HOLD", "DISARMED"} <= set(written)
