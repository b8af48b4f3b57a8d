"""How QGroundControl downloads a file over MAVLink FTP (``Vehicle/FTPManager.cc``): open, bursts, gaps one by one, terminate."""

import struct

from uvf.mavlink import dialect as mav

HEAD = struct.Struct("<HBBBBBBI")  # sequence, session, opcode, size, requested opcode, burst complete, padding, offset
OPEN, TERMINATE, READ, BURST, ACK, NAK, EOF = 4, 1, 5, 15, 128, 129, 6
WAIT, TRIES = 1.0, 4  # s for an answer; the first try and three more
DATA = 239


class FileReader:
    """On behalf of a station that listens (``_await``) and has a rig to speak into."""

    def __init__(self, station):
        self._station = station
        self._seq = 0
        self._pieces = {}

    def read(self, path):
        """The whole content, or None."""
        opened = self._ask(OPEN, path.encode(), size=len(path))
        if opened is None or opened[0] != ACK or len(opened[3]) != 4:
            return None
        session, total = opened[1], struct.unpack("<I", opened[3])[0]
        if not self._bursts(session) or not self._gaps(session, total):
            return None
        self._ask(TERMINATE, session=session)
        return b"".join(self._pieces[offset] for offset in sorted(self._pieces))

    def _bursts(self, session):
        """Up to the end of the file, which is told by a refusal; a burst that falls silent is asked for again from where it stopped."""
        offset, tries = 0, 0
        while tries < TRIES:
            self._say(BURST, session=session, offset=offset, size=DATA)
            while answer := self._hear(lambda opcode, asked, seq: asked == BURST):
                opcode, _, at, data, complete, seq = answer
                if opcode == NAK:
                    return data[:1] == bytes((EOF,))
                self._pieces[at], offset, tries = data, at + len(data), 0
                self._seq = seq
                if complete:
                    break
            else:
                tries += 1
        return False

    def _gaps(self, session, total):
        at = 0
        while at < total:
            if at not in self._pieces:
                until = min((offset for offset in self._pieces if offset > at), default=total)
                answer = self._ask(READ, session=session, offset=at, size=min(until - at, DATA))
                if answer is None or answer[0] != ACK or not answer[3]:
                    return False
                self._pieces[at] = answer[3]
            at += len(self._pieces[at])
        return True

    def _ask(self, opcode, data=b"", session=0, offset=0, size=0):
        self._seq += 1
        for _ in range(TRIES):
            self._say(opcode, data, session, offset, size)
            answer = self._hear(lambda op, asked, seq: asked == opcode and seq == self._seq + 1)
            if answer is not None:
                self._seq += 1
                return answer
        return None

    def _say(self, opcode, data=b"", session=0, offset=0, size=0):
        payload = (HEAD.pack(self._seq, session, opcode, size, 0, 0, 0, offset) + data).ljust(251, b"\0")
        self._station.rig.say(mav.MAVLink_file_transfer_protocol_message(0, self._station.system, 1, payload))

    def _hear(self, fits):
        """(opcode, session, offset, data, complete, seq) of the next answer that fits."""
        m = self._station._await(
            "FILE_TRANSFER_PROTOCOL", WAIT, lambda m: fits(m.payload[3], m.payload[5], m.payload[0] | m.payload[1] << 8)
        )
        if m is None:
            return None
        seq, session, opcode, size, _, complete, _, offset = HEAD.unpack_from(bytes(m.payload))
        return opcode, session, offset, bytes(m.payload)[HEAD.size : HEAD.size + size], complete, seq
