"""What an autopilot is asked as soon as it is heard, and again after a restart or a silence: what it is, its rates, its modes."""

import math
from collections.abc import Callable
from typing import Any

from services.mavlink_bridge.commands import CommandSender, command
from services.mavlink_bridge.connection import Wire
from services.mavlink_bridge.modes import LARGEST_LIST, Modes
from uvf.mavlink import dialect as mav

RATES: dict[int, float] = {
    mav.MAVLINK_MSG_ID_ATTITUDE_QUATERNION: 25,
    mav.MAVLINK_MSG_ID_GLOBAL_POSITION_INT: 25,
    mav.MAVLINK_MSG_ID_VFR_HUD: 5,
    mav.MAVLINK_MSG_ID_GPS_RAW_INT: 5,
    mav.MAVLINK_MSG_ID_NAV_CONTROLLER_OUTPUT: 5,
    mav.MAVLINK_MSG_ID_SYS_STATUS: 1,
    mav.MAVLINK_MSG_ID_BATTERY_STATUS: 1,
    mav.MAVLINK_MSG_ID_EXTENDED_SYS_STATE: 2,
    mav.MAVLINK_MSG_ID_MISSION_CURRENT: 2,
    mav.MAVLINK_MSG_ID_HOME_POSITION: 0.5,
    mav.MAVLINK_MSG_ID_WIND_COV: 1,
    mav.MAVLINK_MSG_ID_ESTIMATOR_STATUS: 1,
    mav.MAVLINK_MSG_ID_FENCE_STATUS: 1,
    mav.MAVLINK_MSG_ID_ORBIT_EXECUTION_STATUS: 2,
}
"""1/s, wall. What an autopilot does not have, it refuses, and the system does not learn."""
OLD_STREAM_HZ = 10
INSTEAD = {mav.MAVLINK_MSG_ID_ATTITUDE_QUATERNION: mav.MAVLINK_MSG_ID_ATTITUDE}


class Connecting:
    """Requests of a new connection: capabilities, home, modes and message rates."""

    def __init__(self, wire: Wire, commands: CommandSender, modes: Modes) -> None:
        self._wire, self._commands, self._modes = wire, commands, modes
        self.capabilities = 0
        """MAV_PROTOCOL_CAPABILITY, 0 until they are told."""
        self._refused = 0
        self._mode_due = 0
        """Which line of its list of modes was asked for."""

    def handlers(self) -> dict[int, Callable[[Any], None]]:
        """Handlers of the answers, by message id."""
        return {mav.MAVLINK_MSG_ID_AUTOPILOT_VERSION: self._on_version, mav.MAVLINK_MSG_ID_AVAILABLE_MODES: self._on_mode}

    def begin(self) -> None:
        """Sends the requests."""
        self._refused = 0
        self._request(mav.MAVLINK_MSG_ID_AUTOPILOT_VERSION)
        self._request(mav.MAVLINK_MSG_ID_HOME_POSITION)
        self._ask_mode(1)
        for number, hz in RATES.items():
            self._rate(number, hz)

    def _rate(self, number: int, hz: float) -> None:
        def done(accepted: bool, reason: str) -> None:
            if not accepted and number in INSTEAD:
                self._rate(INSTEAD[number], hz)
            self._refused += not accepted
            if self._refused == len(RATES):  # an old one, which knows its streams by groups only
                to = self._wire.system, self._wire.component
                self._wire.send(mav.MAVLink_request_data_stream_message(*to, mav.MAV_DATA_STREAM_ALL, OLD_STREAM_HZ, 1))

        self._commands.ask(command(mav.MAV_CMD_SET_MESSAGE_INTERVAL, (number, 1e6 / hz, 0.0, 0.0, 0.0, 0.0, 0.0), done), math.inf)

    def _request(self, number: int, index: float = 0.0) -> None:
        asked = (number, index, 0.0, 0.0, 0.0, 0.0, 0.0)
        self._commands.ask(command(mav.MAV_CMD_REQUEST_MESSAGE, asked, lambda accepted, reason: None), math.inf)

    def _ask_mode(self, index: int) -> None:
        self._mode_due = index
        self._request(mav.MAVLINK_MSG_ID_AVAILABLE_MODES, index)

    def _on_version(self, message: mav.MAVLink_autopilot_version_message) -> None:
        self.capabilities = message.capabilities

    def _on_mode(self, message: mav.MAVLink_available_modes_message) -> None:
        """Each line asks for the next one: once, however often it comes."""
        self._modes.hear(message)
        if message.mode_index == self._mode_due < min(message.number_modes, LARGEST_LIST):
            self._ask_mode(self._mode_due + 1)
