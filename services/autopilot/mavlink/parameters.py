"""The parameter protocol: the list, paced; single values; and refusals of what cannot be set."""

from services.autopilot.mavlink import dialect as mav
from services.autopilot.mavlink.endpoint import Peer
from services.autopilot.mavlink.line import Line, Sender
from services.autopilot.mavlink.parameter_table import Parameter, hash_of, param_value, parameters_of

PER_STEP = 4  # at 50 steps a second: 200 a second
HASH = "_HASH_CHECK"
HASH_INDEX = 0xFFFF  # outside the list


class Parameters:
    def __init__(self, line: Line) -> None:
        self._line = line
        self._all = parameters_of(line.facts)
        self._by_name = {p.name: p for p in self._all}
        self._hash = hash_of(self._all)
        self._progress: dict[Peer, int] = {}
        """Where in the list each peer that asked for it is."""

    def on_request_list(self, message: mav.MAVLink_param_request_list_message, sender: Sender) -> None:
        """Starts (again); the hash goes first, so that a peer with a cache can stop the rest."""
        self._send_hash(sender.peer)
        self._progress[sender.peer] = 0

    def on_request_read(self, message: mav.MAVLink_param_request_read_message, sender: Sender) -> None:
        """By index, or by name when the index is -1."""
        if message.param_index == -1 and message.param_id == HASH:
            self._send_hash(sender.peer)
            return
        if message.param_index == -1:
            found = self._by_name.get(message.param_id)
        else:
            found = self._all[message.param_index] if 0 <= message.param_index < len(self._all) else None
        if found is None:
            self._error(message.param_id, message.param_index, mav.MAV_PARAM_ERROR_DOES_NOT_EXIST, sender)
        else:
            self._send(found, sender.peer)

    def on_set(self, message: mav.MAVLink_param_set_message, sender: Sender) -> None:
        """Nothing can be set yet: the error first, then the value that stays. A hash sent back ends the list."""
        if message.param_id == HASH:
            self._progress.pop(sender.peer, None)
            return
        kept = self._by_name.get(message.param_id)
        if kept is None:
            self._error(message.param_id, -1, mav.MAV_PARAM_ERROR_DOES_NOT_EXIST, sender)
            return
        self._error(kept.name, kept.index, mav.MAV_PARAM_ERROR_READ_ONLY, sender)
        self._send(kept, sender.peer)
        self._line.text(mav.MAV_SEVERITY_WARNING, f"{kept.name} is fixed in this simulator", sender.peer)

    def tick(self) -> None:
        """The next few values for each peer that waits for the list."""
        for peer, start in list(self._progress.items()):
            for parameter in self._all[start : start + PER_STEP]:
                self._send(parameter, peer)
            self._progress[peer] = start + PER_STEP
            if start + PER_STEP >= len(self._all):
                del self._progress[peer]

    def _send(self, p: Parameter, peer: Peer) -> None:
        self._line.send(param_value(p.name, p.raw, p.type, (len(self._all), p.index)), peer)

    def _send_hash(self, peer: Peer) -> None:
        raw = self._hash.to_bytes(4, "little")
        self._line.send(param_value(HASH, raw, mav.MAV_PARAM_TYPE_UINT32, (len(self._all), HASH_INDEX)), peer)

    def _error(self, name: str, index: int, error: int, sender: Sender) -> None:
        raw = name.encode("ascii", "replace")[:16]
        self._line.send(mav.MAVLink_param_error_message(sender.system, sender.component, raw, index, error), sender.peer)
