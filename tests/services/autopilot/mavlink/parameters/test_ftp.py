"""File transfer: what is there can be read by many at once, what is not there or not allowed is refused at once."""

import struct

import pytest

from services.autopilot.mavlink.parameters.component_metadata import general_of, parameters_file_of
from services.autopilot.mavlink.parameters.file_tree import FileTree
from services.autopilot.mavlink.parameters.ftp import HEADER, PAYLOAD_BYTES, SESSIONS_EACH
from services.autopilot.mavlink.parameters.parameter_values import crc32
from tests.services.autopilot.mavlink.rig import GCS, OTHER, PLANE, Rig, of
from uvf.mavlink import dialect as mav

GENERAL, PARAMETERS = general_of(PLANE), parameters_file_of(PLANE)

TERMINATE, RESET, LIST, OPEN, READ, CREATE, RENAME, CRC, BURST = 1, 2, 3, 4, 5, 6, 13, 14, 15
ACK, NAK = 128, 129


class Client:
    """One ground station's end."""

    def __init__(self, rig, peer=GCS, system=255):
        self.rig, self.peer, self.system = rig, peer, system
        self.seq = 0

    def say(self, opcode, data=b"", session=0, size=None, offset=0):
        head = HEADER.pack(self.seq, session, opcode, len(data) if size is None else size, 0, 0, offset)
        self.payload = (head + data).ljust(PAYLOAD_BYTES, b"\0")
        self.seq += 1
        self.repeat()

    def repeat(self):
        self.rig.say(mav.MAVLink_file_transfer_protocol_message(0, PLANE, 1, self.payload), system=self.system, peer=self.peer)

    def heard(self, seconds=0.04):
        """(opcode, session, data, offset, complete, seq) of each answer."""
        self.rig.run(seconds)
        found = []
        for m in of(self.rig.heard(self.peer), "FILE_TRANSFER_PROTOCOL"):
            if m.target_system == self.system:
                seq, session, opcode, size, _, complete, offset = HEADER.unpack_from(bytes(m.payload))
                found.append((opcode, session, bytes(m.payload)[HEADER.size : HEADER.size + size], offset, complete, seq))
        return found

    def ask(self, opcode, data=b"", **more):
        self.say(opcode, data, **more)
        (answer,) = self.heard()
        return answer

    def open(self, path):
        opcode, session, data, *_ = self.ask(OPEN, path.encode())
        assert opcode == ACK
        return session, struct.unpack("<I", data)[0]


def files(rig):
    return rig.service._vehicles["plane"].line.files


@pytest.mark.parametrize("path", [GENERAL, PARAMETERS, GENERAL.lstrip("/")])
def test_a_file_is_read_piece_by_piece(path):
    rig = Rig()
    client = Client(rig)
    session, size = client.open(path)
    content = b""
    while len(content) < size:
        opcode, _, data, offset, *_ = client.ask(READ, session=session, size=100, offset=len(content))
        assert (opcode, offset) == (ACK, len(content)) and 0 < len(data) <= 100
        content += data
    assert content == files(rig)["/" + path.lstrip("/")]
    assert client.ask(READ, session=session, size=100, offset=size)[:3] == (NAK, session, bytes((mav.MAV_FTP_ERR_EOF,)))
    assert client.ask(TERMINATE, session=session)[0] == ACK
    assert client.ask(READ, session=session, size=100)[2] == bytes((mav.MAV_FTP_ERR_INVALIDSESSION,))


def test_a_burst_brings_the_rest_in_order_and_says_where_it_ends():
    rig = Rig()
    client = Client(rig)
    session, size = client.open(PARAMETERS)
    client.say(BURST, session=session, size=239, offset=239)
    packets = client.heard(1.0)
    assert b"".join(p[2] for p in packets) == files(rig)[PARAMETERS][239:]
    assert [p[3] for p in packets] == list(range(239, size, 239))
    assert [p[4] for p in packets] == [0] * (len(packets) - 1) + [1]
    assert [p[5] for p in packets] == list(range(client.seq, client.seq + len(packets)))
    assert client.ask(BURST, session=session, size=239, offset=size)[2] == bytes((mav.MAV_FTP_ERR_EOF,))


def test_a_burst_is_paced_and_ends_with_its_session():
    rig = Rig()
    client = Client(rig)
    session, _ = client.open(PARAMETERS)
    client.say(BURST, session=session, size=20)
    assert len(client.heard(0.02)) == 8
    client.say(RESET)
    assert len(client.heard(0.2)) == 1


def test_folders_are_listed_entry_by_entry():
    rig = Rig()
    client = Client(rig)
    assert client.ask(LIST, b"/")[2] == b"Detc\0"
    listed = client.ask(LIST, b"/etc/extras\0")[2].split(b"\0")
    assert listed == [b"Fgeneral_1.json\t%d" % len(files(rig)[GENERAL]), b"Fparameters_1.json.xz\t%d" % len(files(rig)[PARAMETERS]), b""]
    assert client.ask(LIST, b"/etc/extras", offset=1)[2].startswith(b"Fparameters")
    assert client.ask(LIST, b"/etc/extras", offset=2)[2] == bytes((mav.MAV_FTP_ERR_EOF,))
    assert client.ask(LIST, b"/nowhere")[2] == bytes((mav.MAV_FTP_ERR_FILENOTFOUND,))


def test_the_checksum_of_a_file_can_be_asked_for():
    rig = Rig()
    assert Client(rig).ask(CRC, GENERAL.encode())[2] == struct.pack("<I", crc32(files(rig)[GENERAL]))


OUTSIDE = [
    "/etc/passwd",
    "/etc/extras/../../etc/passwd",
    "../state",
    "/etc/extras/..",
    "/proc/self/environ",
    "",
    "/",
    "~",
    "@PARAM/param.pck",
]


@pytest.mark.parametrize("path", [*OUTSIDE, "/etc/extras/./general.json", "/etc\0/extras/general.json", "/etc/extras/general.json/x"])
def test_nothing_else_can_be_opened(path):
    assert Client(Rig()).ask(OPEN, path.encode())[::2][:2] == (NAK, bytes((mav.MAV_FTP_ERR_FILENOTFOUND,)))


@pytest.mark.parametrize("opcode", range(CREATE, RENAME + 1))
def test_nothing_can_be_written(opcode):
    rig = Rig()
    before = dict(files(rig))
    assert Client(rig).ask(opcode, GENERAL.encode())[::2][:2] == (NAK, bytes((mav.MAV_FTP_ERR_FILEPROTECTED,)))
    assert files(rig) == before


@pytest.mark.parametrize("opcode", [0, 16, 99])
def test_what_it_does_not_know_it_refuses(opcode):
    assert Client(Rig()).ask(opcode)[::2][:2] == (NAK, bytes((mav.MAV_FTP_ERR_UNKNOWNCOMMAND,)))


@pytest.mark.parametrize("opcode", [ACK, NAK, 255])
def test_answers_are_not_answered(opcode):
    client = Client(Rig())
    client.say(opcode)
    assert client.heard(0.2) == []


def test_a_repeated_request_gets_the_same_answer_and_is_not_done_again():
    rig = Rig()
    client = Client(rig)
    first = client.ask(OPEN, GENERAL.encode())
    client.repeat()
    assert client.heard() == [first]
    second = client.ask(OPEN, GENERAL.encode())
    assert second[1] == first[1] + 1  # the repetition has opened nothing


def test_several_read_at_once_and_nobody_reads_on_in_anothers_session():
    rig = Rig()
    one, other = Client(rig), Client(rig, OTHER, 245)
    mine, _ = one.open(PARAMETERS)
    theirs, _ = other.open(GENERAL)
    assert other.ask(READ, session=mine, size=10)[2] == bytes((mav.MAV_FTP_ERR_INVALIDSESSION,))
    other.ask(TERMINATE, session=mine)
    one.say(BURST, session=mine, size=239)
    other.say(BURST, session=theirs, size=239)
    rig.run(1.0)
    found = dict.fromkeys((GCS, OTHER), b"")
    for peer in found:
        for m in of(rig.heard(peer), "FILE_TRANSFER_PROTOCOL"):
            found[peer] += bytes(m.payload)[HEADER.size : HEADER.size + m.payload[4]]
    assert found == {GCS: files(rig)[PARAMETERS], OTHER: files(rig)[GENERAL]}
    other.ask(RESET)
    assert one.ask(READ, session=mine, size=10)[0] == ACK


def test_a_silent_session_ends_and_makes_room():
    rig = Rig()
    client = Client(rig)
    sessions = [client.open(GENERAL)[0] for _ in range(SESSIONS_EACH)]
    assert client.ask(OPEN, GENERAL.encode())[2] == bytes((mav.MAV_FTP_ERR_NOSESSIONSAVAILABLE,))
    rig.run(10.1)
    assert client.ask(READ, session=sessions[0], size=10)[2] == bytes((mav.MAV_FTP_ERR_INVALIDSESSION,))
    client.open(GENERAL)


def test_a_tree_knows_what_is_a_folder():
    tree = FileTree({"/a/b.txt": b"12", "/c": b""})
    assert tree.entries("") == [b"Da\0", b"Fc\t0\0"]
    assert tree.entries("/c") is None and tree.entries("/a/b.txt") is None
    assert tree.content("/a") is None and tree.content("c") == b""
