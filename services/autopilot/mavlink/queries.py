"""Commands that ask: for one message, for a rate, for the reasons against arming."""

import math

from services.autopilot.mavlink.connection.command_server import Acknowledger, Handler, ReceivedCommand
from services.autopilot.mavlink.connection.line import VehicleConnection
from services.autopilot.mavlink.parameters.component_metadata import component_metadata
from services.autopilot.mavlink.telemetry.health import health
from services.autopilot.mavlink.telemetry.navigation import boot_ms
from services.autopilot.mavlink.telemetry.streams import Schedule
from services.autopilot.mavlink.telemetry.telemetry import STREAMS
from uvf.mavlink import dialect as mav
from uvf.runtime.mavlink import modes


class Queries:
    """Commands that request messages and rates. The acknowledgement always precedes the requested message."""

    def __init__(self, schedule: Schedule) -> None:
        self._schedule = schedule

    def handlers(self) -> dict[int, Handler]:
        """Handlers of these commands, by MAV_CMD."""
        return {
            mav.MAV_CMD_REQUEST_MESSAGE: self._request_message,
            mav.MAV_CMD_SET_MESSAGE_INTERVAL: self._set_interval,
            mav.MAV_CMD_GET_MESSAGE_INTERVAL: self._get_interval,
            mav.MAV_CMD_GET_HOME_POSITION: _fixed(mav.MAVLINK_MSG_ID_HOME_POSITION),
            mav.MAV_CMD_REQUEST_PROTOCOL_VERSION: _fixed(mav.MAVLINK_MSG_ID_PROTOCOL_VERSION),
            mav.MAV_CMD_REQUEST_AUTOPILOT_CAPABILITIES: _fixed(mav.MAVLINK_MSG_ID_AUTOPILOT_VERSION),
            mav.MAV_CMD_RUN_PREARM_CHECKS: _prearm,
        }

    def _request_message(self, line: VehicleConnection, command: ReceivedCommand, ack: Acknowledger) -> None:
        number = _number(command.p[0])
        if number == mav.MAVLINK_MSG_ID_AVAILABLE_MODES:
            _available_modes(line, command, ack)
        elif number == mav.MAVLINK_MSG_ID_COMPONENT_METADATA:
            ack(mav.MAV_RESULT_ACCEPTED)
            line.send(component_metadata(line.facts, line.files, boot_ms(line.t)), command.sender.peer)
        else:
            _answer(line, command, ack, number)

    def _set_interval(self, line: VehicleConnection, command: ReceivedCommand, ack: Acknowledger) -> None:
        interval = command.p[1]
        known = math.isfinite(interval) and self._schedule.set_interval(_number(command.p[0]), command.sender.peer, interval)
        ack(mav.MAV_RESULT_ACCEPTED if known else mav.MAV_RESULT_UNSUPPORTED)

    def _get_interval(self, line: VehicleConnection, command: ReceivedCommand, ack: Acknowledger) -> None:
        number = _number(command.p[0])
        if number not in STREAMS:
            ack(mav.MAV_RESULT_UNSUPPORTED)
            return
        ack(mav.MAV_RESULT_ACCEPTED)
        interval = self._schedule.interval(number, command.sender.peer)
        line.send(mav.MAVLink_message_interval_message(number, -1 if interval is None else round(interval * 1e6)), command.sender.peer)


def _number(value: float) -> int:
    return int(value) if math.isfinite(value) else -1


def _answer(line: VehicleConnection, command: ReceivedCommand, ack: Acknowledger, number: int) -> None:
    stream = STREAMS.get(number)
    if stream is None:
        ack(mav.MAV_RESULT_UNSUPPORTED)
        return
    messages = stream.messages(line.facts, line.latest, line.t) if line.tells(number, command.sender.peer) else []
    ack(mav.MAV_RESULT_ACCEPTED if messages else mav.MAV_RESULT_TEMPORARILY_REJECTED)
    for message in messages:
        line.send(message, command.sender.peer)


def _fixed(number: int) -> Handler:
    return lambda line, command, ack: _answer(line, command, ack, number)


def _available_modes(line: VehicleConnection, command: ReceivedCommand, ack: Acknowledger) -> None:
    """Parameter 2: which one, from 1; 0 or not given = all."""
    wanted = command.p[1]
    index = _number(wanted) if math.isfinite(wanted) else 0
    indices = range(1, len(modes.TABLE) + 1) if index == 0 else (index,)
    messages = [m for m in map(modes.available, indices) if m is not None]
    if not messages:
        ack(mav.MAV_RESULT_DENIED, f"There is no mode number {index}")
        return
    ack(mav.MAV_RESULT_ACCEPTED)
    for message in messages:
        line.send(message, command.sender.peer)


def _prearm(line: VehicleConnection, command: ReceivedCommand, ack: Acknowledger) -> None:
    ack(mav.MAV_RESULT_ACCEPTED)
    for complaint in health(line.facts, line.latest).complaints:
        line.text(mav.MAV_SEVERITY_WARNING, f"PreArm: {complaint}", command.sender.peer)
