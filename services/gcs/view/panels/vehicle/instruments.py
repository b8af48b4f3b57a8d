"""Instruments as SVG: a primary flight display and a driver's panel; nothing but numbers and markup goes in, so what is drawn is markup."""

from dataclasses import dataclass
from math import cos, degrees, radians, sin

from services.gcs.view.markup import Html, trusted

WIDTH, HEIGHT = 340, 250
CX, CY = 170.0, 122.0
PX_PER_DEGREE = 4.0
SKY, EARTH, INK, AMBER, GREEN, CYAN = "#2a78c8", "#7a5230", "#ffffff", "#ffd23f", "#5ee08a", "#7fdcff"
FONT = "font-family='ui-sans-serif,system-ui,DejaVu Sans,sans-serif' font-variant-numeric='tabular-nums'"


@dataclass(frozen=True)
class FlightInstruments:
    """Readings of an aircraft [rad, m, m/s]: nose up and right wing down are positive; heading from north, clockwise."""

    roll: float
    pitch: float
    heading: float
    airspeed: float
    altitude: float
    climb: float
    ground_speed: float
    mode: Html
    armed: bool


@dataclass(frozen=True)
class DriveInstruments:
    """Readings of a ground vehicle [rad, m/s, rad/s, m]; heading from north, clockwise; limits are the vehicle's own."""

    heading: float
    speed: float
    turn_rate: float
    max_speed: float
    max_turn_rate: float
    distance_left: float | None
    mode: Html
    armed: bool


def primary_flight_display(f: FlightInstruments) -> Html:
    """The primary flight display as SVG: horizon, tapes of airspeed and altitude, heading."""
    roll, pitch, heading = degrees(f.roll), degrees(f.pitch), degrees(f.heading) % 360
    label = f"roll {roll:.0f} deg, pitch {pitch:.0f} deg, heading {heading:03.0f}, {f.airspeed:.1f} m/s, {f.altitude:.0f} m"
    return trusted(
        f"<svg id='gcs-pfd' role='img' aria-label='{label}' viewBox='0 0 {WIDTH} {HEIGHT}' width='100%' {FONT} fill='{INK}' font-size='11'>"
        f"<defs><clipPath id='pfd-all'><rect width='{WIDTH}' height='{HEIGHT}' rx='10'/></clipPath>"
        "<linearGradient id='pfd-sky' x1='0' y1='0' x2='0' y2='1'><stop offset='0' stop-color='#174a8c'/>"
        f"<stop offset='1' stop-color='{SKY}'/></linearGradient></defs>"
        f"<g clip-path='url(#pfd-all)'>{_horizon(roll, pitch)}{_bank(roll)}{_wings()}"
        f"{_tape(6, 'left', f.airspeed, 1, 5, 7.0)}{_tape(WIDTH - 62, 'right', f.altitude, 5, 10, 2.6)}"
        f"{_heading_strip(heading)}{_corners(f)}</g></svg>"
    )


def _horizon(roll: float, pitch: float) -> str:
    down = pitch * PX_PER_DEGREE
    rungs = []
    for at in range(-80, 81, 5):
        if at == 0 or abs(at - pitch) > 21:
            continue
        y, half = CY - at * PX_PER_DEGREE, 34 if at % 10 == 0 else 16
        rungs.append(f"<path d='M{CX - half} {y}H{CX + half}' stroke='{INK}' stroke-width='1.4' opacity='.9'/>")
        if at % 10 == 0:
            rungs += [f"<text x='{CX + s * (half + 12)}' y='{y + 4}' text-anchor='middle' font-size='10'>{abs(at)}</text>" for s in (-1, 1)]
    return (
        f"<g transform='rotate({-roll:.2f} {CX} {CY})'><g transform='translate(0 {down:.2f})'>"
        f"<rect x='-300' y='{CY - 700}' width='940' height='700' fill='url(#pfd-sky)'/>"
        f"<rect x='-300' y='{CY}' width='940' height='700' fill='{EARTH}'/>"
        f"<path d='M-300 {CY}H640' stroke='{INK}' stroke-width='2'/>{''.join(rungs)}</g></g>"
    )


def _bank(roll: float) -> str:
    r, ticks = 92.0, []
    for at in (-60, -45, -30, -20, -10, 10, 20, 30, 45, 60):
        long = 10 if abs(at) in (30, 60) else 6
        s, c = sin(radians(at)), cos(radians(at))
        ticks.append(f"M{CX + r * s:.1f} {CY - r * c:.1f}L{CX + (r + long) * s:.1f} {CY - (r + long) * c:.1f}")
    zero = f"<path d='M{CX} {CY - r}l-6 -10h12z' fill='{INK}'/>"
    pointer = f"<path transform='rotate({-roll:.2f} {CX} {CY})' d='M{CX} {CY - r + 1}l-6 10h12z' fill='{AMBER}'/>"
    return f"<path d='{''.join(ticks)}' stroke='{INK}' stroke-width='1.6'/>{zero}{pointer}"


def _wings() -> str:
    left, right = f"M{CX - 62} {CY}h34l9 9", f"M{CX + 62} {CY}h-34l-9 9"
    return (
        f"<path d='{left}{right}' fill='none' stroke='#111' stroke-width='6'/>"
        f"<path d='{left}{right}' fill='none' stroke='{AMBER}' stroke-width='3.2'/>"
        f"<rect x='{CX - 3}' y='{CY - 3}' width='6' height='6' fill='{AMBER}' stroke='#111'/>"
    )


def _tape(x: float, side: str, value: float, small: int, big: int, scale: float) -> str:
    """A sliding scale with the value in a window; small, big: units between ticks and between numbers."""
    inner, out = (x + 56 if side == "left" else x), (-1 if side == "left" else 1)
    marks = []
    first = int((value - 92 / scale) // small) * small
    for at in range(first, int(value + 92 / scale) + small + 1, small):
        y = CY - (at - value) * scale
        if at < 0 or not 26 < y < 218:
            continue
        if at % big == 0:
            anchor = "end" if side == "left" else "start"
            marks.append(f"<text x='{inner + out * 14}' y='{y + 4:.1f}' text-anchor='{anchor}'>{at}</text>")
        marks.append(f"<path d='M{inner} {y:.1f}h{out * (9 if at % big == 0 else 5)}' stroke='{INK}'/>")
    digits = f"{value:.1f}" if side == "left" else f"{value:.0f}"
    return (
        f"<rect x='{x}' y='26' width='56' height='192' fill='#0b1524' opacity='.55' rx='4'/>{''.join(marks)}"
        f"<rect x='{x - 1}' y='{CY - 13}' width='58' height='26' rx='4' fill='#05080d' stroke='{AMBER}' stroke-width='1.4'/>"
        f"<text x='{x + 28}' y='{CY + 6}' text-anchor='middle' font-size='17' font-weight='600'>{digits}</text>"
    )


def _heading_strip(heading: float) -> str:
    marks = []
    for at in range(int(heading // 10) * 10 - 50, int(heading) + 60, 10):
        x = CX + (at - heading) * 2.2
        if abs(x - CX) > 96:
            continue
        name = {0: "N", 90: "E", 180: "S", 270: "W"}.get(at % 360, f"{at % 360 // 10:02d}" if at % 30 == 0 else "")
        marks.append(f"<path d='M{x:.1f} 222v5' stroke='{INK}'/><text x='{x:.1f}' y='240' text-anchor='middle'>{name}</text>")
    window = f"<rect x='{CX - 20}' y='204' width='40' height='18' rx='4' fill='#05080d' stroke='{AMBER}'/>"
    value = f"<text x='{CX}' y='217.5' text-anchor='middle' font-size='13' font-weight='600'>{round(heading) % 360:03d}</text>"
    return f"<rect x='68' y='222' width='204' height='28' fill='#0b1524' opacity='.6'/>{''.join(marks)}{window}{value}"


def _corners(f: FlightInstruments) -> str:
    armed = (GREEN, "ARMED") if f.armed else (AMBER, "DISARMED")
    small = "font-size='10' opacity='.95'"
    return (
        f"<text x='34' y='18' text-anchor='middle' {small}>IAS m/s</text>"
        f"<text x='{WIDTH - 34}' y='18' text-anchor='middle' {small}>ALT m</text>"
        f"<text x='{CX - 6}' y='17' text-anchor='end' fill='{GREEN}' font-size='13' font-weight='700'>{f.mode}</text>"
        f"<text x='{CX + 6}' y='17' fill='{armed[0]}' font-size='13' font-weight='700'>{armed[1]}</text>"
        f"<text x='34' y='236' text-anchor='middle' fill='{CYAN}'>GS {f.ground_speed:.1f}</text>"
        f"<text x='{WIDTH - 34}' y='236' text-anchor='middle' fill='{CYAN}'>VS {f.climb:+.1f}</text>"
    )


def drive_panel(d: DriveInstruments) -> Html:
    """The driver's panel as SVG: compass rose, bars of speed and turn rate, distance to the goal."""
    heading = degrees(d.heading) % 360
    label = f"heading {heading:03.0f}, {d.speed:.2f} m/s, turning {degrees(d.turn_rate):.0f} deg/s"
    armed = (GREEN, "ARMED") if d.armed else (AMBER, "DISARMED")
    left = "–" if d.distance_left is None else f"{d.distance_left:.1f} m"
    return trusted(
        f"<svg id='gcs-drive' role='img' aria-label='{label}' viewBox='0 0 {WIDTH} 170' width='100%' {FONT} fill='{INK}' font-size='11'>"
        f"<rect width='{WIDTH}' height='170' rx='10' fill='#101a2b'/>{_rose(heading)}"
        f"<text x='176' y='26' fill='{GREEN}' font-size='13' font-weight='700'>{d.mode}</text>"
        f"<text x='326' y='26' text-anchor='end' fill='{armed[0]}' font-size='13' font-weight='700'>{armed[1]}</text>"
        f"{_bar(48, 'speed', f'{d.speed:+.2f} m/s', d.speed / d.max_speed)}"
        f"{_bar(90, 'turn, left +', f'{degrees(d.turn_rate):+.0f} °/s', -d.turn_rate / d.max_turn_rate)}"
        f"<text x='176' y='150' opacity='.75'>to the goal</text>"
        f"<text x='326' y='152' text-anchor='end' font-size='16' font-weight='600'>{left}</text></svg>"
    )


def _rose(heading: float) -> str:
    cx, cy, r, marks = 84.0, 90.0, 60.0, []
    for at in range(0, 360, 30):
        s, c = sin(radians(at)), cos(radians(at))
        name = {0: "N", 90: "E", 180: "S", 270: "W"}.get(at, "")
        marks.append(
            f"<path d='M{cx + r * s:.1f} {cy - r * c:.1f}L{cx + (r - 7) * s:.1f} {cy - (r - 7) * c:.1f}' stroke='{INK}' opacity='.8'/>"
        )
        x, y = cx + (r - 17) * s, cy - (r - 17) * c
        marks.append(
            f"<text transform='rotate({heading:.1f} {x:.1f} {y:.1f})' x='{x:.1f}' y='{y + 4:.1f}' text-anchor='middle'>{name}</text>"
        )
    return (
        f"<circle cx='{cx}' cy='{cy}' r='{r}' fill='#0b1220' stroke='#3a4a66' stroke-width='2'/>"
        f"<g transform='rotate({-heading:.1f} {cx} {cy})'>{''.join(marks)}</g>"
        f"<path d='M{cx} {cy - 26}l11 34l-11 -8l-11 8z' fill='{AMBER}'/>"
        f"<rect x='{cx - 24}' y='8' width='48' height='20' rx='4' fill='#05080d' stroke='{AMBER}'/>"
        f"<text x='{cx}' y='23' text-anchor='middle' font-size='14' font-weight='600'>{round(heading) % 360:03d}</text>"
    )


def _bar(y: float, name: str, value: str, share: float) -> str:
    """A bar from the middle of its track; share: -1..1, positive to the right."""
    share = max(-1.0, min(1.0, share))
    x, width = (251 + min(share, 0) * 75), abs(share) * 75
    return (
        f"<text x='176' y='{y}' opacity='.75'>{name}</text>"
        f"<text x='326' y='{y}' text-anchor='end' font-size='13' font-weight='600'>{value}</text>"
        f"<rect x='176' y='{y + 7}' width='150' height='9' rx='4.5' fill='#22304a'/>"
        f"<rect x='{x:.1f}' y='{y + 7}' width='{width:.1f}' height='9' rx='3' fill='{CYAN}'/><path d='M251 {y + 4}v15' stroke='{INK}'/>"
    )
