"""MAVLink FTP: a few files made by this program, to be read by several ground stations at once; nothing of the machine's disk.

After the MAVLink guide (services/ftp). Paths are looked up in a table, so there is nothing outside of it to be reached.
"""

import struct
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from services.autopilot.mavlink.connection.line import Sender, VehicleConnection
from services.autopilot.mavlink.parameters.file_tree import FileTree
from services.autopilot.mavlink.parameters.parameter_values import crc32
from uvf.mavlink import dialect as mav
from uvf.mavlink.bounded import make_room

HEADER = struct.Struct("<HBBBBBxI")  # sequence, session, opcode, size, requested opcode, burst complete, offset
PAYLOAD_BYTES = 251
DATA_BYTES = PAYLOAD_BYTES - HEADER.size
SESSIONS_MOST, SESSIONS_EACH = 32, 4
TALKS_MOST = 64
FORGET_AFTER = 10.0  # s of silence
BURST_PER_STEP = 8  # packets; at 50 steps a second 96 kB/s
BURSTS_AT_ONCE = 4

ACK, NAK = mav.MAV_FTP_OPCODE_ACK, mav.MAV_FTP_OPCODE_NAK
_WRITING = range(mav.MAV_FTP_OPCODE_CREATEFILE, mav.MAV_FTP_OPCODE_RENAME + 1)


@dataclass(frozen=True)
class FtpRequest:
    """A request of MAVLink FTP."""

    seq: int
    session: int
    opcode: int
    size: int
    offset: int
    data: bytes

    @classmethod
    def read(cls, payload: bytes) -> "FtpRequest":
        """Decodes a request from the payload of FILE_TRANSFER_PROTOCOL."""
        seq, session, opcode, size, _, _, offset = HEADER.unpack_from(payload)
        return cls(seq, session, opcode, size, offset, payload[HEADER.size : HEADER.size + min(size, DATA_BYTES)])

    @property
    def path(self) -> str:
        """The path that the request names."""
        return self.data.split(b"\0")[0].decode("utf-8", "replace")


@dataclass(frozen=True)
class FtpReply:
    """A reply, without its sequence number."""

    session: int
    opcode: int
    data: bytes = b""
    offset: int = 0
    complete: bool = False


@dataclass
class FtpSession:
    """A file that a peer has opened, and perhaps begun to read."""

    owner: Sender
    content: bytes
    t: float
    is_read: bool = False


@dataclass
class Burst:
    """The part of a file that is still to be sent in a burst."""

    asked: FtpRequest
    content: bytes
    offset: int
    seq: int


@dataclass
class Talk:
    """The exchange with one peer: its last request and the reply, to be repeated when the reply is lost."""

    asked: FtpRequest
    t: float
    reply: mav.MAVLink_message | None = None
    burst: Burst | None = field(default=None)


class FtpRefusal(Exception):
    """A refusal with the MAV_FTP_ERR to reply."""

    def __init__(self, error: int) -> None:
        super().__init__(error)
        self.error = error


class FileServer:
    """The MAVLink FTP server of one vehicle."""

    def __init__(self, line: VehicleConnection, files: Mapping[str, bytes]) -> None:
        self._line = line
        self._tree = FileTree(files)
        self._sessions: dict[int, FtpSession] = {}
        self._talks: dict[Sender, Talk] = {}
        self._next = 0
        self._does: dict[int, Callable[[FtpRequest, Sender], FtpReply]] = {
            mav.MAV_FTP_OPCODE_TERMINATESESSION: self._terminate,
            mav.MAV_FTP_OPCODE_RESETSESSION: self._reset,
            mav.MAV_FTP_OPCODE_LISTDIRECTORY: self._list,
            mav.MAV_FTP_OPCODE_OPENFILERO: self._open,
            mav.MAV_FTP_OPCODE_READFILE: self._read,
            mav.MAV_FTP_OPCODE_CALCFILECRC: self._crc,
            mav.MAV_FTP_OPCODE_BURSTREADFILE: self._burst,
        }

    def on_ftp(self, message: mav.MAVLink_file_transfer_protocol_message, sender: Sender) -> None:
        """Answers a request at once; a repeated request gets the same reply again."""
        asked = FtpRequest.read(bytes(message.payload))
        if asked.opcode >= ACK:
            return  # an answer, of somebody else
        talk = self._talks.get(sender)
        if talk is not None and talk.asked == asked and talk.reply is not None:
            talk.t = self._line.t
            self._line.send(talk.reply, sender.peer)
            return
        make_room(self._talks, sender, TALKS_MOST, lambda who: (self._talks[who].burst is not None, self._talks[who].t))
        talk = self._talks[sender] = Talk(asked, self._line.t)
        try:
            said = self._answer(asked, sender)
        except FtpRefusal as refused:
            said = FtpReply(asked.session, NAK, bytes((refused.error,)))
        if talk.burst is None:
            talk.reply = self._send(said, asked, (asked.seq + 1) & 0xFFFF, sender)

    def _answer(self, asked: FtpRequest, sender: Sender) -> FtpReply:
        if asked.opcode in _WRITING:
            raise FtpRefusal(mav.MAV_FTP_ERR_FILEPROTECTED)
        if asked.opcode not in self._does:
            raise FtpRefusal(mav.MAV_FTP_ERR_UNKNOWNCOMMAND)
        return self._does[asked.opcode](asked, sender)

    def tick(self) -> None:
        """Continues bursts, and drops peers that have fallen silent."""
        t = self._line.t
        self._sessions = {number: s for number, s in self._sessions.items() if t - s.t < FORGET_AFTER}
        self._talks = {sender: talk for sender, talk in self._talks.items() if t - talk.t < FORGET_AFTER}
        bursts = [(sender, talk) for sender, talk in self._talks.items() if talk.burst is not None]
        for sender, talk in sorted(bursts, key=lambda one: one[1].t)[:BURSTS_AT_ONCE]:
            for _ in range(BURST_PER_STEP):
                talk.t = t
                self._burst_on(talk, sender)

    def _burst_on(self, talk: Talk, sender: Sender) -> None:
        burst = talk.burst
        if burst is None:
            return
        data = burst.content[burst.offset : burst.offset + (burst.asked.size or DATA_BYTES)]
        last = burst.offset + len(data) >= len(burst.content)
        burst.seq = (burst.seq + 1) & 0xFFFF
        self._send(FtpReply(burst.asked.session, ACK, data, burst.offset, last), burst.asked, burst.seq, sender)
        burst.offset += len(data)
        if last:
            talk.burst = None

    def _send(self, said: FtpReply, asked: FtpRequest, seq: int, to: Sender) -> mav.MAVLink_message:
        head = HEADER.pack(seq, said.session, said.opcode, len(said.data), asked.opcode, said.complete, said.offset)
        payload = (head + said.data).ljust(PAYLOAD_BYTES, b"\0")
        message = mav.MAVLink_file_transfer_protocol_message(0, to.system, to.component, payload)
        self._line.send(message, to.peer)
        return message

    def _session(self, asked: FtpRequest, sender: Sender) -> FtpSession:
        session = self._sessions.get(asked.session)
        if session is None or session.owner != sender:
            raise FtpRefusal(mav.MAV_FTP_ERR_INVALIDSESSION)
        session.t, session.is_read = self._line.t, True
        if asked.offset >= len(session.content):
            raise FtpRefusal(mav.MAV_FTP_ERR_EOF)
        return session

    def _terminate(self, asked: FtpRequest, sender: Sender) -> FtpReply:
        """Also of a session that has ended already: then the answer was lost."""
        session = self._sessions.get(asked.session)
        if session is not None and session.owner == sender:
            del self._sessions[asked.session]
        return FtpReply(asked.session, ACK)

    def _reset(self, asked: FtpRequest, sender: Sender) -> FtpReply:
        """All of this peer's; others go on."""
        self._sessions = {number: s for number, s in self._sessions.items() if s.owner != sender}
        return FtpReply(asked.session, ACK)

    def _list(self, asked: FtpRequest, sender: Sender) -> FtpReply:
        entries = self._tree.entries(asked.path)
        if entries is None:
            raise FtpRefusal(mav.MAV_FTP_ERR_FILENOTFOUND)
        if asked.offset >= len(entries):
            raise FtpRefusal(mav.MAV_FTP_ERR_EOF)
        data = b""
        for entry in entries[asked.offset :]:
            if len(data) + len(entry) > DATA_BYTES:
                break
            data += entry
        return FtpReply(asked.session, ACK, data, asked.offset)

    def _open(self, asked: FtpRequest, sender: Sender) -> FtpReply:
        content = self._content(asked)
        if sum(session.owner == sender for session in self._sessions.values()) >= SESSIONS_EACH:
            raise FtpRefusal(mav.MAV_FTP_ERR_NOSESSIONSAVAILABLE)
        make_room(self._sessions, -1, SESSIONS_MOST, lambda number: (self._sessions[number].is_read, self._sessions[number].t))
        while self._next in self._sessions:
            self._next = (self._next + 1) % 256
        number, self._next = self._next, (self._next + 1) % 256
        self._sessions[number] = FtpSession(sender, content, self._line.t)
        return FtpReply(number, ACK, struct.pack("<I", len(content)))

    def _read(self, asked: FtpRequest, sender: Sender) -> FtpReply:
        content = self._session(asked, sender).content
        if not 0 < asked.size <= DATA_BYTES:
            raise FtpRefusal(mav.MAV_FTP_ERR_INVALIDDATASIZE)
        return FtpReply(asked.session, ACK, content[asked.offset : asked.offset + asked.size], asked.offset)

    def _crc(self, asked: FtpRequest, sender: Sender) -> FtpReply:
        return FtpReply(asked.session, ACK, struct.pack("<I", crc32(self._content(asked))))

    def _burst(self, asked: FtpRequest, sender: Sender) -> FtpReply:
        """Sent by ``tick``; the last packet says that the burst is complete, and what is asked beyond it is the end of the file."""
        content = self._session(asked, sender).content
        if asked.size > DATA_BYTES:
            raise FtpRefusal(mav.MAV_FTP_ERR_INVALIDDATASIZE)
        self._talks[sender].burst = Burst(asked, content, asked.offset, asked.seq)
        return FtpReply(asked.session, ACK)

    def _content(self, asked: FtpRequest) -> bytes:
        content = self._tree.content(asked.path)
        if content is None:
            raise FtpRefusal(mav.MAV_FTP_ERR_FILENOTFOUND)
        return content
