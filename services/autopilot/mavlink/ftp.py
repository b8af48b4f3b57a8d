"""MAVLink FTP: there are no files, and every question about one is answered so at once instead of by silence."""

import struct

from services.autopilot.mavlink import dialect as mav
from services.autopilot.mavlink.line import Line, Sender

HEADER = struct.Struct("<HBBBBBxI")  # sequence, session, opcode, size, requested opcode, burst complete, offset
PAYLOAD_BYTES = 251

_CLOSING = (mav.MAV_FTP_OPCODE_TERMINATESESSION, mav.MAV_FTP_OPCODE_RESETSESSION)
_WRITING = range(mav.MAV_FTP_OPCODE_CREATEFILE, mav.MAV_FTP_OPCODE_RENAME + 1)
_ERRORS = {
    mav.MAV_FTP_OPCODE_LISTDIRECTORY: mav.MAV_FTP_ERR_FILENOTFOUND,
    mav.MAV_FTP_OPCODE_OPENFILERO: mav.MAV_FTP_ERR_FILENOTFOUND,
    mav.MAV_FTP_OPCODE_CALCFILECRC: mav.MAV_FTP_ERR_FILENOTFOUND,
    mav.MAV_FTP_OPCODE_READFILE: mav.MAV_FTP_ERR_INVALIDSESSION,
    mav.MAV_FTP_OPCODE_BURSTREADFILE: mav.MAV_FTP_ERR_INVALIDSESSION,
    **dict.fromkeys(_WRITING, mav.MAV_FTP_ERR_FILEPROTECTED),
}


def on_ftp(line: Line, message: mav.MAVLink_file_transfer_protocol_message, sender: Sender) -> None:
    seq, session, opcode, *_ = HEADER.unpack_from(bytes(message.payload))
    seq = (seq + 1) & 0xFFFF
    if opcode in _CLOSING:
        reply = HEADER.pack(seq, session, mav.MAV_FTP_OPCODE_ACK, 0, opcode, 0, 0)
    else:
        error = _ERRORS.get(opcode, mav.MAV_FTP_ERR_UNKNOWNCOMMAND)
        reply = HEADER.pack(seq, session, mav.MAV_FTP_OPCODE_NAK, 1, opcode, 0, 0) + bytes((error,))
    payload = reply.ljust(PAYLOAD_BYTES, b"\0")
    line.send(mav.MAVLink_file_transfer_protocol_message(0, sender.system, sender.component, payload), sender.peer)
