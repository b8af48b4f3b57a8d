"""What ground stations ask for and a simulator has not, answered at once: logs, a console, calibration."""

from collections.abc import Callable
from typing import Any

from services.autopilot.mavlink.connection.command_server import Acknowledger, Handler, ReceivedCommand
from services.autopilot.mavlink.connection.line import Sender, VehicleConnection
from uvf.mavlink import dialect as mav

NO_CONSOLE = b"There is no console here: this is UVF, not PX4.\n"
CONSOLE_BYTES, LOG_BYTES = 70, 90


def handlers(line: VehicleConnection) -> dict[int, Callable[[Any, Sender], None]]:
    """Handlers that answer requests for logs and a console, by message id."""

    def on_log_list(m: mav.MAVLink_log_request_list_message, sender: Sender) -> None:
        line.send(mav.MAVLink_log_entry_message(0, 0, 0, 0, 0), sender.peer)

    def on_log_data(m: mav.MAVLink_log_request_data_message, sender: Sender) -> None:
        """Nothing, which is the end of the log."""
        line.send(mav.MAVLink_log_data_message(m.id, m.ofs, 0, bytes(LOG_BYTES)), sender.peer)

    def on_log_erase(m: mav.MAVLink_log_erase_message, sender: Sender) -> None:
        line.text(mav.MAV_SEVERITY_INFO, "There are no logs to be erased here: the run's recorder keeps them", sender.peer)

    def on_serial(m: mav.MAVLink_serial_control_message, sender: Sender) -> None:
        """A console says that it is none; another port has nothing to say."""
        if m.flags & mav.SERIAL_CONTROL_FLAG_REPLY:
            return
        said = NO_CONSOLE if m.device == mav.SERIAL_CONTROL_DEV_SHELL and m.count else b""
        reply = (
            m.device,
            mav.SERIAL_CONTROL_FLAG_REPLY,
            0,
            0,
            len(said),
            said.ljust(CONSOLE_BYTES, b"\0"),
            sender.system,
            sender.component,
        )
        line.send(mav.MAVLink_serial_control_message(*reply), sender.peer)

    return {
        mav.MAVLINK_MSG_ID_LOG_REQUEST_LIST: on_log_list,
        mav.MAVLINK_MSG_ID_LOG_REQUEST_DATA: on_log_data,
        mav.MAVLINK_MSG_ID_LOG_ERASE: on_log_erase,
        mav.MAVLINK_MSG_ID_SERIAL_CONTROL: on_serial,
    }


def _calibration(line: VehicleConnection, command: ReceivedCommand, ack: Acknowledger) -> None:
    ack(mav.MAV_RESULT_UNSUPPORTED, "Calibration refused: simulated sensors need none")


NOT_OFFERED: dict[int, Handler] = {
    mav.MAV_CMD_PREFLIGHT_CALIBRATION: _calibration,
    mav.MAV_CMD_PREFLIGHT_SET_SENSOR_OFFSETS: _calibration,
}
