"""A drive from the first key to the last zero, with a keyboard, vehicles and a clock of a few lines each."""

from contextlib import suppress

import pytest

from launch.teleop.command import drive, status_line, wanted_vehicles
from launch.teleop.terminal import TerminalClosed
from uvf.control.teleop_drive import STILL, DriveTeleop, GamepadState
from uvf.maths.kinematics import Twist
from uvf.models.scenario import ROOT, load_scenario
from uvf.models.yaml_data import BadInput


class Clock:
    def __init__(self):
        self.t = 0.0

    def __call__(self):
        return self.t


class Console:
    """Presses keys at times; an exception in the place of a key is raised. Waiting lets the time pass."""

    def __init__(self, clock, script):
        self.clock, self.script, self.lines = clock, sorted(script, key=lambda entry: entry[0]), []

    def read(self, patience):
        if self.script and self.script[0][0] <= self.clock.t + patience:
            t, key = self.script.pop(0)
            self.clock.t = max(t, self.clock.t)
            if not isinstance(key, str):
                raise key
            return [key]
        self.clock.t += max(patience, 1e-6)
        return []

    def show(self, line):
        self.lines.append(line)


class Vehicles:
    def __init__(self, clock, refused=""):
        self.clock, self.sent, self.asked, self.refused = clock, [], [], refused

    def send(self, vehicle, command):
        self.sent.append((self.clock.t, vehicle, command))

    def take_over(self, vehicle):
        self.asked.append(vehicle)
        return self.refused

    def state(self, vehicle):
        return "LIVE teleop"


class Stick:
    name = ""

    def __init__(self, clock, script=()):
        self.clock, self.script = clock, script

    def read(self):
        return next((pad for begin, end, pad in self.script if begin <= self.clock.t < end), GamepadState())


def run(script, *names, pad=(), refused=""):
    clock = Clock()
    vehicles, console = Vehicles(clock, refused), Console(clock, script)
    hand = DriveTeleop(names or ("one",), Twist(1.0, 1.0))
    with suppress(TerminalClosed):
        drive(hand, vehicles, console, Stick(clock, pad), clock)
    return vehicles, console


def test_commands_go_out_twenty_times_a_second_then_zero_then_nothing():
    vehicles, _ = run([(1.0, "w"), (5.0, "x")])
    moving = [t for t, _, command in vehicles.sent if command == Twist(0.5, 0.0)]
    standing = [t for t, _, command in vehicles.sent if command == STILL]
    assert 9 <= len(moving) <= 11 and 1.0 <= moving[0] <= 1.05 and moving[-1] < 1.5
    assert 9 <= len(standing) <= 11 and max(standing[:-1]) < 2.0
    assert standing[-1] == pytest.approx(5.0)


@pytest.mark.parametrize("end", ["x", TerminalClosed()])
def test_however_it_ends_every_vehicle_is_told_to_stand(end):
    vehicles, _ = run([(1.0, "w"), (1.2, end)], "one", "two")
    assert vehicles.sent[-2:] == [(1.2, "one", STILL), (1.2, "two", STILL)]


@pytest.mark.parametrize("error", [KeyboardInterrupt, ZeroDivisionError])
def test_an_exception_goes_on_but_the_vehicles_stand_before(error):
    clock = Clock()
    vehicles = Vehicles(clock)
    with pytest.raises(error):
        drive(DriveTeleop(("one",), Twist(1, 1)), vehicles, Console(clock, [(0.5, "w"), (0.7, error())]), Stick(clock), clock)
    assert vehicles.sent[-1] == (0.7, "one", STILL)


def test_keys_that_come_fast_do_not_make_commands_come_faster():
    vehicles, _ = run([(1.0 + 0.005 * i, "w") for i in range(200)] + [(2.0, "x")])
    assert len(vehicles.sent) <= 22


def test_one_device_drives_two_vehicles_alike():
    vehicles, _ = run([(1.0, "q"), (1.3, "x")], "one", "two")
    by_vehicle = {name: [(t, command) for t, vehicle, command in vehicles.sent if vehicle == name] for name in ("one", "two")}
    assert by_vehicle["one"] == by_vehicle["two"]
    assert by_vehicle["one"][0][1] == Twist(0.5, 0.5)


def test_a_gamepad_drives_without_a_key():
    vehicles, _ = run([(3.0, "x")], pad=[(1.0, 2.0, GamepadState(forward=-1.0, dead_man=True))])
    moving = [t for t, _, command in vehicles.sent if command == Twist(-0.5, 0.0)]
    assert 1.0 <= min(moving) < 1.06 and 1.94 < max(moving) < 2.0


def test_it_takes_the_vehicles_over_at_the_start_and_on_request():
    vehicles, _ = run([(1.0, "2"), (1.1, "m"), (2.0, "x")], "one", "two")
    assert vehicles.asked == ["one", "two", "one"]


def test_a_refusal_is_shown():
    _, console = run([(1.0, "x")], refused="one: STOP ALL is engaged: release it first")
    assert console.lines[-1].startswith("one: STOP ALL is engaged: release it first | ")


def test_the_line_tells_vehicles_links_scales_and_motion():
    clock = Clock()
    hand = DriveTeleop(("one", "two"), Twist(1.0, 1.0))
    hand.key(0.0, "2")
    hand.key(0.0, "s")
    line = status_line(hand, Vehicles(clock), "Pad X", 0.1)
    assert line == "1 one LIVE teleop, (2 two) LIVE teleop | 0.50 m/s 0.50 rad/s | now -0.50 +0.00 | Pad X"


@pytest.fixture(scope="module")
def site():
    return load_scenario(ROOT / "missions" / "demo.yaml")


def test_without_a_name_it_is_the_only_ground_vehicle(site):
    assert wanted_vehicles(site, []) == (["burger"], Twist(0.5, 2.0))
    assert wanted_vehicles(site, ["burger", "burger"])[0] == ["burger"]


def test_a_name_that_is_wrong_or_that_flies_is_refused_with_the_nearest(site):
    with pytest.raises(BadInput, match="no ground vehicle 'burgr' there; did you mean 'burger'"):
        wanted_vehicles(site, ["burgr"])
    with pytest.raises(BadInput, match="no ground vehicle 'milvus' there; there are: burger"):
        wanted_vehicles(site, [next(m.name for m in site.of_kind("fixed_wing"))])
