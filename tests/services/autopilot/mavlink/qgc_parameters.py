"""What QGroundControl does about parameters and their metadata, with its time limits.

After ``FactSystem/ParameterManager.cc`` and ``Vehicle/ComponentInformation/*`` in QGroundControl's master of May 2026.
"""

import json
import lzma
import struct

from tests.services.autopilot.mavlink.file_reader import FileReader
from uvf.mavlink import dialect as mav

PARAM_WAIT, GAP_WAIT = 5.0, 3.0  # s
TRIES = 3
BATCH = 10  # missing parameters asked for at once
INDEX_TRIES = 5
WRITE_WAIT = 1.0  # s
NO_PARAMETERS = "Vehicle did not respond to request for parameters"
SOME_PARAMETERS = "unable to retrieve the full set of parameters from vehicle"
WRITE = "Parameter write failed"
PARAM_ERRORS = {1: "Parameter does not exist", 2: "Parameter value out of range", 3: "Permission denied", 5: "Parameter is read only"}
PARAM_ERRORS |= {7: "Parameter type mismatch"}
FOREIGN_TEXTS = "parameters are explained by PX4's texts"


class ParameterManager:
    """Part of a station that speaks (``rig``), listens (``_await``) and asks for messages (``_request``)."""

    def __init__(self):
        self.parameters = {}
        self.types = {}
        self.metadata = {}
        self.notes = []
        """What is worse for the user, who is not told."""
        self.cache = []
        """Of an earlier connection: the values as they came."""

    def _download_parameters(self):
        """The list, or nothing but the hash when the values of the last time still hold."""
        self.rig.say(mav.MAVLink_param_request_read_message(self.system, 1, b"_HASH_CHECK", -1))
        told = self._await("PARAM_VALUE", 1.0, lambda m: m.param_id == "_HASH_CHECK")
        if told is not None and self.cache and _bits(told) == self.hash_of(self.cache):
            self.rig.say(mav.MAVLink_param_set_message(self.system, 1, b"_HASH_CHECK", told.param_value, mav.MAV_PARAM_TYPE_UINT32))
            self._take({m.param_index: m for m in self.cache})
            return
        values = {}
        for _ in range(5):
            self.rig.say(mav.MAVLink_param_request_list_message(self.system, 0))
            if self._collect(values, PARAM_WAIT):
                break
        total = next((m.param_count for m in values.values()), None)
        if total is None:
            self.complaints.append(NO_PARAMETERS)
            return
        self._fill_gaps(values, total)
        if len(values) < total:
            self.complaints.append(SOME_PARAMETERS)
        self._take(values)

    def _collect(self, values, seconds):
        """Takes in parameters until there are all or a while passes without one; whether any came."""
        any_came = False
        while m := self._await("PARAM_VALUE", seconds, lambda m: m.param_index != 0xFFFF):
            values[m.param_index], any_came, seconds = m, True, GAP_WAIT
            if len(values) == m.param_count:
                break
        return any_came

    def _take(self, values):
        self.cache = list(values.values())
        self.parameters = {m.param_id: _number(m) for m in self.cache}
        self.types = {m.param_id: m.param_type for m in self.cache}

    def _fill_gaps(self, values, total):
        """A queue of ten that is filled up as answers come; all over again after 3 s without one; five tries for each."""
        tries, queue = dict.fromkeys(range(total), 0), []
        while waiting := [i for i in range(total) if i not in values and tries[i] <= INDEX_TRIES]:
            for index in waiting:
                if index not in queue and len(queue) <= BATCH:
                    tries[index] += 1
                    queue.append(index)
                    self.rig.say(mav.MAVLink_param_request_read_message(self.system, 1, b"", index))
            m = self._await("PARAM_VALUE", GAP_WAIT, lambda m: m.param_index != 0xFFFF)
            if m is None:
                queue.clear()
            else:
                values[m.param_index] = m
                queue = [index for index in queue if index != m.param_index]

    def hash_of(self, values):
        """As ParameterManager's: over those of the cache that the metadata does not call volatile, in the order of their names."""
        crc = 0
        for m in sorted(values, key=lambda m: m.param_id):
            if not self.metadata.get(m.param_id, {}).get("volatile", False):
                crc = _crc32(m.param_id.encode() + struct.pack("<I", _bits(m)), crc)
        return crc

    def set(self, name, number):
        """Writes a parameter: three tries of 1 s for a matching value or an error; whether the user is told nothing."""
        kind = self.types[name]
        raw = struct.pack("<i" if kind == mav.MAV_PARAM_TYPE_INT32 else "<f", number)
        self._heard = [m for m in self._heard if m.get_type() not in ("PARAM_VALUE", "PARAM_ERROR")]
        for _ in range(TRIES):
            message = mav.MAVLink_param_set_message(self.system, 1, name.encode(), 0.0, kind)
            message.unpacker, message.param_value = struct.Struct("<4sBB16sB"), raw
            self.rig.say(message)
            answer = self._await_either(name, kind, struct.unpack("<i" if kind == mav.MAV_PARAM_TYPE_INT32 else "<f", raw)[0])
            if answer is not None:
                break
        if answer is None or answer.get_type() == "PARAM_ERROR":
            self.complaints.append(f"{WRITE}: param: {name}" + (f" - {PARAM_ERRORS.get(answer.error)}" if answer else ""))
            return False
        self.parameters[name] = _number(answer)
        return True

    def _await_either(self, name, kind, number):
        def matches(m):
            same = _number(m) == number or abs(_number(m) - number) <= 1e-5 * min(abs(_number(m)), abs(number))
            return m.param_id == name and m.param_type == kind and same

        end = self.rig.t + WRITE_WAIT
        while self.rig.t < end:
            self._listen(0.02)
            for m in list(self._heard):
                error = m.get_type() == "PARAM_ERROR" and m.param_id == name
                if error or (m.get_type() == "PARAM_VALUE" and matches(m)):
                    self._heard.remove(m)
                    return m
        return None

    def _download_metadata(self):
        """The general file, then that of the parameters; anything wrong with them and PX4's own texts are shown."""
        told = self._request(mav.MAVLINK_MSG_ID_COMPONENT_METADATA, "COMPONENT_METADATA")
        if told is None:
            self._request(mav.MAVLINK_MSG_ID_COMPONENT_INFORMATION, None)
        general = self._json(told.uri, told.file_crc) if told is not None else None
        if general is None or general.get("version") != 1:
            self.notes.append(FOREIGN_TEXTS)
            return
        entry = next((e for e in general["metadataTypes"] if e["type"] == 1 and "fileCrc" in e), None)
        parameters = self._json(entry["uri"], entry["fileCrc"]) if entry else None
        if parameters is None or parameters.get("version") != 1:
            self.notes.append(FOREIGN_TEXTS)
            return
        self.metadata = {p["name"]: p for p in parameters["parameters"]}

    def _json(self, uri, crc):
        """None when it does not come, or is not what was promised."""
        path = uri.rstrip("\0").removeprefix("mftp://")
        content = FileReader(self).read(path)
        if content is None or _crc32(content, 0) != crc:
            return None
        try:
            return json.loads(lzma.decompress(content) if path.endswith(".xz") else content)
        except (ValueError, lzma.LZMAError):
            return None


def _number(message):
    raw = struct.pack("<f", message.param_value)
    return struct.unpack("<i" if message.param_type == mav.MAV_PARAM_TYPE_INT32 else "<f", raw)[0]


def _bits(message):
    return struct.unpack("<I", struct.pack("<f", message.param_value))[0]


def _crc32(data, crc):
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (0xEDB88320 if crc & 1 else 0)
    return crc
