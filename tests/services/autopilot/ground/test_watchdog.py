"""A teleoperator or a program falls silent: multiplexer, ramp, motors and physics bring the vehicle to a stand."""

import numpy as np
import pytest

from schemas import topics
from schemas.messages import ArmRequest, DriveCommand, Mode, ModeRequest, Reply
from services.autopilot.ground.build import hosts
from services.autopilot.ground.multiplexer import COMMAND_MAX_AGE
from services.sim_ground.build import build as build_simulator
from tests.services.sim_ground.ride import site_with
from uvf.runtime.contract.declaration import Reads, Writes, answers, call, topic
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.contract.service import Answer, Service
from uvf.runtime.messages.convert import seconds, stamp
from uvf.runtime.time.lockstep import Lockstep

SILENT_FROM = 2.0  # s
SPEED = 0.2  # m/s
BRAKE = 0.8  # m/s^2, of the burger
START = (5.0, 4.4, 0.0)


class Operator(Service):
    """Takes over, drives straight on, and dies."""

    name = "operator"
    mode = Mode.MODE_MANUAL
    hz = 20.0

    class Inputs(Reads):
        mode: list[Answer[ModeRequest, Reply]] = answers(topics.SET_MODE)
        arm: list[Answer[ArmRequest, Reply]] = answers(topics.ARM)

    class Outputs(Writes):
        drive: DriveCommand | None = topic(topics.DRIVE.by("teleop"))
        mode: list[ModeRequest] = call(topics.SET_MODE)
        arm: list[ArmRequest] = call(topics.ARM)

    def step(self, t: float, now: Inputs) -> Outputs:
        out = self.Outputs(drive=DriveCommand(timestamp=stamp(t), linear=SPEED) if t <= SILENT_FROM else None)
        if t < 0.06:
            out.mode, out.arm = [ModeRequest(mode=self.mode)], [ArmRequest(arm=True)]
        return out


class Program(Operator):
    """The same from outside, in mode Offboard."""

    name = "program"
    mode = Mode.MODE_OFFBOARD

    class Outputs(Operator.Outputs):
        drive: DriveCommand | None = topic(topics.DRIVE.by("offboard"))


class Page(Service):
    """Somebody else, of lower priority, who never stops commanding a turn."""

    name = "page"
    hz = 20.0

    class Outputs(Writes):
        drive: DriveCommand | None = topic(topics.DRIVE.by("gcs"))

    def step(self, t: float, now) -> Outputs:
        return self.Outputs(drive=DriveCommand(timestamp=stamp(t), angular=0.5))


def ride(folder, *drivers):
    """(times [s], speeds [m/s], turn rates [rad/s]) of the truth, and the status messages."""
    site = site_with(folder, {"burger": START})
    commanders = [ServiceInstance(service, service, "burger") for service in drivers]
    run = Lockstep([*build_simulator(site), *hosts(site), *commanders])
    truth, status = [], []
    for of, kept in ((topics.TRUTH, truth), (topics.STATUS, status)):
        run.bus.subscribe(of.at("burger"), of.qos, lambda s, k=kept, m=of.message: k.append(m.FromString(s.payload)))
    run.run(4.0)
    run.close()
    rows = [(seconds(m.timestamp), np.hypot(m.velocity.x, m.velocity.y), m.angular_velocity.z) for m in truth]
    return np.array(rows).T, status


@pytest.fixture(scope="module")
def alone(tmp_path_factory):
    return ride(tmp_path_factory.mktemp("alone"), Operator)


def test_while_it_commands_the_vehicle_drives(alone):
    (t, speed, _), _ = alone
    assert speed[(t > 1.0) & (t < SILENT_FROM)] == pytest.approx(SPEED, rel=0.05)


def test_half_a_second_after_the_last_command_it_brakes_to_a_stand(alone):
    (t, speed, _), _ = alone
    last_heard = SILENT_FROM + COMMAND_MAX_AGE
    assert speed[(t > SILENT_FROM) & (t < last_heard)].min() > 0.9 * SPEED
    assert speed[t > last_heard + SPEED / BRAKE + 0.15].max() < 0.005


def test_the_reason_is_told(alone):
    _, status = alone
    told = {round(seconds(m.timestamp), 1): m for m in status}
    assert told[1.9].command_source == "teleop"
    assert told[3.9].command_source == ""
    assert told[3.9].reason == "mode MANUAL: no fresh command from teleop, mavlink, gcs, client, executive"


def test_teleop_comes_before_the_others_and_they_only_follow_when_it_is_silent(tmp_path):
    (t, speed, turn), status = ride(tmp_path, Operator, Page)
    assert abs(turn[(t > 1.0) & (t < SILENT_FROM)]).max() < 0.05
    assert turn[t > 3.5] == pytest.approx(0.5, abs=0.05)
    assert speed[t > 3.5].max() < 0.02
    assert status[-1].command_source == "gcs"


def test_a_program_drives_in_offboard_until_it_is_silent_then_it_stands_and_holds(tmp_path):
    (t, speed, _), status = ride(tmp_path, Program)
    assert speed[(t > 1.0) & (t < SILENT_FROM)] == pytest.approx(SPEED, rel=0.05)
    assert speed[t > SILENT_FROM + COMMAND_MAX_AGE + SPEED / BRAKE + 0.15].max() < 0.005
    told = {round(seconds(m.timestamp), 1): m for m in status}
    assert (told[1.9].mode, told[1.9].command_source) == (Mode.MODE_OFFBOARD, "offboard")
    assert (told[2.9].mode, told[3.9].mode) == (Mode.MODE_OFFBOARD, Mode.MODE_HOLD)
