"""The UDP endpoint of MAVLink on the loopback: who hears, who is learned, and that nobody listening is normal."""

import logging
import socket
import time

import pytest

from services.autopilot.mavlink.build import open_link
from uvf.mavlink.endpoint import FORGET_AFTER, MOST_LEARNED, UdpLink


@pytest.fixture
def station():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sock:
        sock.bind(("127.0.0.1", 0))
        sock.settimeout(2.0)
        yield sock


@pytest.fixture
def link(station):
    link = UdpLink([station.getsockname()], ("127.0.0.1", 0))
    yield link
    link.close()


def receive(link, t):
    """The next datagrams; the loopback delivers at once, but not in the same instruction."""
    end = time.monotonic() + 2.0
    while time.monotonic() < end:
        if arrived := link.receive(t):
            return arrived
    raise AssertionError("nothing arrived")


def test_the_vehicle_speaks_first(link, station):
    link.send(b"hello", station.getsockname())
    data, sender = station.recvfrom(100)
    assert (data, sender) == (b"hello", link.addresses[0])


def test_answers_come_back_on_the_same_socket(link, station):
    station.sendto(b"yes", link.addresses[0])
    assert receive(link, 0.0) == [(b"yes", station.getsockname())]
    assert link.peers(0.0) == [station.getsockname()]


def test_whoever_calls_the_listening_port_is_answered_from_it_and_forgotten_after_a_minute(link):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as caller:
        caller.settimeout(2.0)
        caller.sendto(b"hi", link.addresses[1])
        ((_, peer),) = receive(link, 10.0)
        assert peer not in link.peers(10.0), "nothing sound has come yet"
        link.keep(10.0, peer)
        link.send(b"there", peer)
        assert caller.recvfrom(100) == (b"there", link.addresses[1])
        assert peer in link.peers(10.0)
        link.receive(10.0 + FORGET_AFTER + 0.1)
        assert peer not in link.peers(71.0) and len(link.peers(71.0)) == 1


def test_when_too_many_call_the_longest_silent_one_makes_room(link):
    callers = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(MOST_LEARNED + 1)]
    for t, caller in enumerate(callers):
        caller.sendto(b"hi", link.addresses[1])
        for _, peer in receive(link, float(t)):
            link.keep(float(t), peer)
    learned = link.peers(40.0)[1:]
    assert len(learned) == MOST_LEARNED
    assert [caller.getsockname()[1] for caller in callers[1:]] == [port for _, port in learned]
    for caller in callers:
        caller.close()


def test_nobody_listening_is_normal_and_a_later_station_hears():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sock:
        sock.bind(("127.0.0.1", 0))
        address = sock.getsockname()
    link = UdpLink([address])
    for t in range(20):
        link.send(b"anybody?", address)
        assert link.receive(float(t)) == []
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as late:
        late.bind(address)
        late.settimeout(2.0)
        link.send(b"hello", address)
        assert late.recv(100) == b"hello"
    link.close()


def test_a_taken_listening_port_costs_one_warning_only(station, caplog):
    with caplog.at_level(logging.WARNING):
        link = open_link([("127.0.0.1", 9)], station.getsockname())
    assert len(link.addresses) == 1 and len(caplog.records) == 1
    assert "UVF_MAVLINK_LISTEN" in caplog.text
    link.close()


def test_an_unknown_name_is_left_out_with_a_warning(caplog):
    with caplog.at_level(logging.WARNING):
        link = open_link([("no-such-host.invalid", 14550), ("127.0.0.1", 9)], None)
    assert link.peers(0.0) == [("127.0.0.1", 9)] and "no-such-host.invalid" in caplog.text
    link.close()
