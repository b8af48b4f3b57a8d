"""The parameter protocol: the list, paced; single values; values set, or refused with the reason."""

import math
from collections.abc import Collection
from itertools import islice

from services.autopilot.mavlink.connection.command_server import Acknowledger, Handler, ReceivedCommand
from services.autopilot.mavlink.connection.line import Sender, VehicleConnection
from services.autopilot.mavlink.parameters.parameter_store import Store
from services.autopilot.mavlink.parameters.parameter_table import Parameter, parameters_of
from services.autopilot.mavlink.parameters.parameter_values import ParameterValues, decoded, param_value, raw_of
from services.autopilot.mavlink.parameters.settings import ParameterSettings
from uvf.mavlink import dialect as mav
from uvf.mavlink.endpoint import Peer

PER_STEP = 4  # at 50 steps a second: 200 a second
LISTS_AT_ONCE = 8  # who asks beyond waits its turn
HASH = "_HASH_CHECK"
HASH_INDEX = 0xFFFF  # outside the list
LOAD, SAVE, RESET = 0.0, 1.0, 2.0  # of MAV_CMD_PREFLIGHT_STORAGE


class ParameterServer:
    """The parameter protocol of one vehicle."""

    def __init__(self, line: VehicleConnection, store: Store) -> None:
        self._line = line
        self._settings = ParameterSettings(line, store)
        self.table = parameters_of(line.facts)
        self._values = ParameterValues(self.table, self._settings.own)
        self._progress: dict[Peer, int] = {}
        """Where in the list each peer that asked for it is."""

    @property
    def note(self) -> str:
        """What every ground station should hear about the stored parameters."""
        return self._settings.note

    def commands(self) -> dict[int, Handler]:
        """Handlers of the parameter commands, by MAV_CMD."""
        return {mav.MAV_CMD_PREFLIGHT_STORAGE: self._storage}

    def on_request_list(self, message: mav.MAVLink_param_request_list_message, sender: Sender) -> None:
        """Starts the list (again); the hash goes first, so that a peer with a cache can stop the rest."""
        self._send_hash(sender.peer)
        self._progress[sender.peer] = 0

    def on_request_read(self, message: mav.MAVLink_param_request_read_message, sender: Sender) -> None:
        """Sends a parameter by index, or by name when the index is -1; by index twice, for the asker has lost messages."""
        if message.param_index == -1 and message.param_id == HASH:
            self._send_hash(sender.peer)
            return
        if message.param_index == -1:
            found = self._values.by_name.get(message.param_id)
        else:
            found = self.table[message.param_index] if 0 <= message.param_index < len(self.table) else None
        if found is None:
            self._error(message.param_id, message.param_index, mav.MAV_PARAM_ERROR_DOES_NOT_EXIST, sender)
        else:
            for _ in range(1 if message.param_index == -1 else 2):
                self._send(found, sender.peer)

    def on_set(self, message: mav.MAVLink_param_set_message, sender: Sender) -> None:
        """Sets a parameter; all are told once the autopilot has it. A hash sent back ends the list."""
        if message.param_id == HASH:
            self._progress.pop(sender.peer, None)
            return
        p = self._values.by_name.get(message.param_id)
        if p is None:
            self._error(message.param_id, -1, mav.MAV_PARAM_ERROR_DOES_NOT_EXIST, sender)
        elif p.fixed:
            self._refuse(p, mav.MAV_PARAM_ERROR_READ_ONLY, f"cannot be set: {p.fixed}", sender)
        elif p.type != message.param_type:
            wanted = "a whole number (INT32)" if p.is_int else "REAL32"
            self._refuse(p, mav.MAV_PARAM_ERROR_TYPE_MISMATCH, f"is {wanted}", sender)
        else:
            self._set(p, decoded(p, raw_of(message)), sender)

    def _set(self, p: Parameter, number: float, sender: Sender) -> None:
        settings = {} if math.isnan(number) else p.settings(number)
        if not settings:
            self._refuse(p, mav.MAV_PARAM_ERROR_VALUE_OUT_OF_RANGE, f"is {possible(p)}", sender)
            return

        def done(accepted: bool, reason: str) -> None:
            if accepted:
                self._tell(p)
            else:
                self._refuse(p, mav.MAV_PARAM_ERROR_PERMISSION_DENIED, f"not set: {reason}", sender)

        self._settings.set(settings, done)

    def forget(self, peers: Collection[Peer]) -> None:
        """Ends the lists of peers that are gone."""
        self._progress = {peer: start for peer, start in self._progress.items() if peer in peers}

    def tick(self) -> None:
        """Sends changed values to all, and the next few values to each peer that waits for the list."""
        if self._settings.hear():
            self._tell()
        self._settings.tick()
        for peer, start in list(islice(self._progress.items(), LISTS_AT_ONCE)):
            for parameter in self.table[start : start + PER_STEP]:
                self._send(parameter, peer)
            self._progress[peer] = start + PER_STEP
            if start + PER_STEP >= len(self.table):
                del self._progress[peer]

    def _storage(self, line: VehicleConnection, command: ReceivedCommand, ack: Acknowledger) -> None:
        """Parameter 1: 0 read again what is remembered, 1 remember (which is done at each change anyway), 2 back to the vehicle's file."""
        what = command.p[0]
        if what not in (LOAD, SAVE, RESET):
            ack(mav.MAV_RESULT_DENIED, "Parameters: 0 loads, 1 saves, 2 resets them")
        elif what == SAVE:
            trouble = self._settings.save()
            ack(mav.MAV_RESULT_FAILED if trouble else mav.MAV_RESULT_ACCEPTED, trouble)
        elif line.latest.is_paused:
            ack(mav.MAV_RESULT_TEMPORARILY_REJECTED, "Parameters not set: the simulation is paused")
        else:
            self._settings.reset() if what == RESET else self._settings.reload()
            self._tell()
            line.when(lambda: self._settings.is_settled, ack.outcome("Parameters not set"))

    def _tell(self, *asked: Parameter) -> None:
        """These and whatever has changed, to everybody."""
        changed = self._values.update(self._settings.own)
        for p in (*asked, *(p for p in changed if p not in asked)):
            self._send(p, None)

    def _refuse(self, p: Parameter, error: int, why: str, sender: Sender) -> None:
        """The error first, then the value that stays, then words."""
        self._error(p.name, p.index, error, sender)
        self._send(p, sender.peer)
        self._line.text(mav.MAV_SEVERITY_WARNING, f"{p.name} {why}", sender.peer)

    def _send(self, p: Parameter, peer: Peer | None) -> None:
        self._line.send(param_value(p.name, self._values.raw(p), p.type, (len(self.table), p.index)), peer)

    def _send_hash(self, peer: Peer) -> None:
        raw = self._values.hash.to_bytes(4, "little")
        self._line.send(param_value(HASH, raw, mav.MAV_PARAM_TYPE_UINT32, (len(self.table), HASH_INDEX)), peer)

    def _error(self, name: str, index: int, error: int, sender: Sender) -> None:
        raw = name.encode("ascii", "replace")[:16]
        self._line.send(mav.MAVLink_param_error_message(sender.system, sender.component, raw, index, error), sender.peer)


def possible(p: Parameter) -> str:
    """The values that it may be set to, in words."""
    if p.cases:
        return ", ".join(f"{number} ({case.says})" for number, case in p.cases.items() if case.sets)
    return f"{p.low:g} to {p.high:g}{' ' + p.unit if p.unit else ''}"
