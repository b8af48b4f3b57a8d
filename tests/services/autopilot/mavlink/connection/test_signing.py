"""Signed messages: set up and given up, believed once, refused otherwise; the key stays where it belongs."""

import hashlib
import logging
import stat

import pytest

from services.autopilot.mavlink.build import open_keys
from services.autopilot.mavlink.connection.key_store import KeyStore
from services.autopilot.mavlink.connection.signing import BEGINNING, PER_SECOND, Signing
from services.autopilot.mavlink.service import MavlinkService
from tests.services.autopilot.mavlink.rig import GCS, OTHER, PLANE, PLANE_FACTS, ROVER_FACTS, Rig, acks, long, of, shelves, texts
from uvf.mavlink import dialect as mav

KEY = hashlib.sha256(b"open sesame").digest()
FAR = ("192.168.1.20", 14550)
NOW = 1_800_000_000.0  # Unix time [s] at t = 0
ARM, DISARM = long(400, 1.0), long(400, 0.0)
BEAT = mav.MAVLink_heartbeat_message(mav.MAV_TYPE_GCS, mav.MAV_AUTOPILOT_INVALID, 0, 0, 0, 3)


def setup(key=KEY, timestamp=0, system=PLANE):
    return mav.MAVLink_setup_signing_message(system, 1, list(key), timestamp)


def ticks(unix):
    return round((unix - BEGINNING) * PER_SECOND)


class Signer:
    """The dialect's own signatures, of another hand than ours: a ground station's side."""

    def __init__(self, key=KEY, timestamp=None, link=0):
        self.mav = mav.MAVLink(None, 255, 190)
        self.mav.signing.secret_key, self.mav.signing.sign_outgoing, self.mav.signing.link_id = key, True, link
        self.mav.signing.timestamp = ticks(NOW) if timestamp is None else timestamp

    def pack(self, message):
        return message.pack(self.mav)

    def read(self, datagrams):
        """What is believed of these."""
        self.mav.robust_parsing = True
        parsed = [m for data in datagrams for m in self.mav.parse_buffer(data)]
        return [m for m in parsed if m.get_type() != "BAD_DATA"]


def rig_with(required=False, store=None, started=NOW):
    rig = Rig()
    rig.service = MavlinkService([PLANE_FACTS, ROVER_FACTS], rig.link, shelves(), Signing(store, started, required))
    rig.link.listening.append(FAR)
    rig.run()
    return rig


def throw(rig, packet, peer=GCS):
    rig.link.incoming.append((packet, peer))


def sent(rig, peer):
    return [data for data, to in rig.link.outgoing if to == peer]


def signed(datagrams):
    return [bool(data[2] & mav.MAVLINK_IFLAG_SIGNED) for data in datagrams]


def test_a_peer_that_sets_signing_up_is_signed_to_at_once_and_the_others_are_not():
    rig, station = rig_with(), Signer()
    rig.say(setup())
    rig.run(2.0)
    assert all(signed(sent(rig, GCS))) and not any(signed(sent(rig, OTHER)))
    assert len(station.read(sent(rig, GCS))) == len(sent(rig, GCS)) > 100
    assert "This link is signed from now on" in texts(rig.heard())


def test_all_vehicles_of_the_link_sign():
    rig, station = rig_with(), Signer()
    rig.say(setup())
    rig.run(2.0)
    assert {m.get_srcSystem() for m in station.read(sent(rig, GCS))} == {1, 2}


def test_timestamps_rise_with_each_packet_and_stay_near_the_time_of_day():
    rig = rig_with()
    rig.say(setup())
    rig.run(2.0)
    stamps = [int.from_bytes(data[-12:-6], "little") for data in sent(rig, GCS)]
    assert stamps == sorted(set(stamps))
    assert abs(stamps[-1] - ticks(NOW + rig.t)) < 0.1 * PER_SECOND


def test_signed_commands_are_obeyed_and_unsigned_ones_refused_aloud():
    rig, station = rig_with(), Signer()
    rig.say(setup())
    rig.run()
    rig.say(ARM)
    heard = rig.run()
    assert rig.plane.asked == [] and not acks(heard)
    assert "Unsigned message refused: this link is signed" in texts(heard)
    throw(rig, station.pack(ARM))
    assert acks(rig.run()) == [(400, 0)]
    assert [name for name, _ in rig.plane.asked] == ["arm"]


def test_another_port_stays_unsigned():
    rig = rig_with()
    rig.say(setup())
    rig.run()
    rig.say(ARM, peer=OTHER)
    rig.run()
    assert of(rig.heard(OTHER), "COMMAND_ACK")[0].result == 0 and rig.plane.status.armed


def test_a_packet_counts_once_from_whatever_address_it_is_repeated():
    rig, station = rig_with(), Signer()
    rig.say(setup())
    packet = station.pack(ARM)
    throw(rig, packet)
    rig.run()
    asked = list(rig.plane.asked)
    for peer in (GCS, OTHER, FAR):
        throw(rig, packet, peer)
        rig.run()
    assert rig.plane.asked == asked and rig.service._signing.counts.replayed == 3


def test_a_packet_of_more_than_a_minute_ago_is_no_beginning():
    for age, accepted in ((61.5, False), (50.0, True)):
        rig = rig_with()
        rig.say(setup())
        throw(rig, Signer(timestamp=ticks(NOW - age)).pack(ARM))
        rig.run()
        assert rig.plane.status.armed is accepted


def test_a_forged_signature_does_not_spoil_the_stream():
    rig, station = rig_with(), Signer()
    rig.say(setup())
    rig.run()
    forged = bytearray(Signer(key=bytes(31) + b"x", timestamp=ticks(NOW + 1e6)).pack(ARM))
    throw(rig, bytes(forged))
    rig.run()
    assert rig.plane.asked == []
    throw(rig, station.pack(ARM))
    assert acks(rig.run()) == [(400, 0)]


def test_every_broken_bit_of_a_signature_is_noticed():
    rig, station = rig_with(), Signer()
    rig.say(setup())
    rig.run()
    packet = station.pack(ARM)
    for i in range(8 * 13):
        broken = bytearray(packet)
        broken[-13 + i // 8] ^= 1 << i % 8
        throw(rig, bytes(broken))
    rig.run()
    assert rig.plane.asked == []


def test_heartbeats_are_heard_unsigned_too():
    rig = rig_with()
    rig.say(setup())
    rig.run()
    rig.say(BEAT)
    rig.run(1.0)
    assert rig.service._reception.stations.count(rig.t) == 1


def test_signing_is_not_set_up_while_armed():
    rig = rig_with()
    rig.say(ARM)
    rig.run()
    rig.say(setup())
    heard = rig.run()
    assert "Signing refused: disarm first" in texts(heard)
    assert not any(signed(sent(rig, GCS)))


def test_setting_it_up_twice_as_qgroundcontrol_does_says_so_once():
    rig = rig_with()
    rig.say(setup())
    rig.say(setup())
    assert [t for t in texts(rig.run(1.0)) if "igned" in t] == ["This link is signed from now on"]


def test_from_another_machine_it_is_set_up_over_a_signed_link_only():
    rig, new = rig_with(), hashlib.sha256(b"another").digest()
    rig.say(setup(), peer=FAR)
    rig.run()
    assert not any(signed(sent(rig, FAR)))
    assert any("set up from this machine" in t for t in texts(rig.heard(FAR)))
    rig.say(setup())
    rig.run()
    station = Signer()
    throw(rig, station.pack(setup(new)), FAR)
    rig.run(0.5)
    assert len(Signer(new).read(sent(rig, FAR))) > 10
    assert all(signed(sent(rig, FAR)))


def test_all_zeros_end_it():
    rig = rig_with()
    rig.say(setup())
    rig.run()
    rig.say(setup(bytes(32)))
    assert "This link is no longer signed" in texts(rig.run())
    rig.run(1.0)
    assert not any(signed(sent(rig, GCS)))
    rig.say(ARM)
    assert acks(rig.run()) == [(400, 0)]


def test_it_is_not_ended_while_armed():
    rig, station = rig_with(), Signer()
    rig.say(setup())
    throw(rig, station.pack(ARM))
    rig.run()
    throw(rig, station.pack(setup(bytes(32))))
    rig.run(1.0)
    assert all(signed(sent(rig, GCS)))


def test_a_ground_station_that_comes_back_without_a_key_is_heard_again():
    rig = rig_with()
    rig.say(setup())
    rig.run(15.0)
    rig.say(ARM)
    assert acks(rig.run()) == [(400, 0)]
    assert not any(signed(sent(rig, GCS)[-3:]))


def test_required_unsigned_messages_of_other_machines_are_refused_but_heartbeats(tmp_path):
    store = KeyStore(tmp_path / "keys")
    store.save([KEY], 0)
    rig = rig_with(required=True, store=store)
    for message in (BEAT, ARM, mav.MAVLink_param_request_list_message(PLANE, 1)):
        rig.say(message, peer=FAR)
    rig.run(0.5)
    assert rig.plane.asked == [] and rig.service._reception.stations.count(rig.t) == 1
    assert not of(rig.heard(FAR), "PARAM_VALUE")
    assert any("signing is required" in t for t in texts(rig.heard(FAR)))
    throw(rig, Signer().pack(ARM), FAR)
    rig.say(DISARM, peer=OTHER)
    rig.run()
    assert [request.arm for _, request in rig.plane.asked] == [True, False]


def test_keys_outlive_the_process_and_a_signed_word_is_answered_signed(tmp_path):
    path = tmp_path / "keys"
    rig = rig_with(store=KeyStore(path))
    rig.say(setup(timestamp=ticks(NOW + 5000)))
    rig.run()
    assert stat.S_IMODE(path.stat().st_mode) == 0o600
    again = rig_with(store=KeyStore(path), started=NOW - 1000)  # with a clock that is behind
    again.run(0.5)
    assert not any(signed(sent(again, GCS)))
    throw(again, Signer(timestamp=ticks(NOW + 5001)).pack(ARM))
    again.run(0.5)
    assert again.plane.status.armed and all(signed(sent(again, GCS)[-5:]))
    newest = int.from_bytes(sent(again, GCS)[-1][-12:-6], "little")
    assert newest > ticks(NOW + 5000), "never below what has been used before"


def test_an_absurd_timestamp_is_refused():
    rig = rig_with()
    rig.say(setup(timestamp=2**64 - 1))
    rig.run(1.0)
    assert not any(signed(sent(rig, GCS)))


def test_a_folder_that_cannot_be_written_costs_a_warning_only(tmp_path):
    (tmp_path / "file").write_text("")
    rig = rig_with(store=KeyStore(tmp_path / "file" / "keys"))
    rig.say(setup())
    assert any("cannot be kept" in t for t in texts(rig.run()))
    rig.run(0.5)
    assert all(signed(sent(rig, GCS)))


def test_the_key_is_in_no_log_no_packet_and_no_text(tmp_path, caplog):
    with caplog.at_level(logging.DEBUG):
        rig = rig_with(store=KeyStore(tmp_path / "keys"))
        rig.say(setup())
        rig.run(2.0)
    everything = b"".join(data for data, _ in rig.link.outgoing) + caplog.text.encode() + str(rig.outputs).encode()
    assert KEY not in everything and KEY.hex().encode() not in everything


@pytest.mark.parametrize("content", [b"rubbish", b'{"keys": ["00ff"]}', b'{"keys": ["zz"]}', b'{"kyes": []}'])
def test_a_broken_file_of_keys_is_put_aside_without_showing_it(tmp_path, monkeypatch, caplog, content):
    monkeypatch.setenv("UVF_STATE", str(tmp_path))
    (tmp_path / "mavlink-keys.json").write_bytes(content)
    with caplog.at_level(logging.WARNING):
        open_keys(NOW, required=False)
    assert len(caplog.records) == 1 and "set signing up again" in caplog.text and content.decode() not in caplog.text
    assert (tmp_path / "mavlink-keys.broken").read_bytes() == content
