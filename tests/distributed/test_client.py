"""What people's own programs say counts like what the page says."""

import pytest

import uvf
from schemas import topics
from schemas.messages import Clock
from tests.runtime.modes import free_port
from uvf.runtime.bus.wire import Malformed
from uvf.runtime.bus.zenoh_bus import ZenohBus, open_router


def test_what_a_client_sends_bears_time_and_epoch_of_the_clock():
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    router = open_router(endpoint)
    stop, heard = topics.STOP.by("client"), []
    with ZenohBus(endpoint, timeout=5.0) as bus, uvf.connect(endpoint) as client:
        bus.subscribe(stop.at("sys"), stop.qos, heard.append)
        clock = bus.publisher(topics.CLOCK.at("sys"), "uvf.v1.Clock", topics.CLOCK.qos)

        def ticks():
            clock.put(Clock(t_ns=5_000_000_000, epoch=3).SerializeToString(), 5_000_000_000)
            return client.time == 5.0

        client.wait(ticks, 20.0)
        client.stop_all("test")
        client.wait(lambda: (bus.poll(), heard)[1], 20.0)
    router.close()
    assert (heard[-1].epoch, heard[-1].stamp_ns) == (3, 5_000_000_000)


def test_what_is_no_message_never_reaches_a_program():
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    router = open_router(endpoint)
    with ZenohBus(endpoint, timeout=5.0) as bus, uvf.connect(endpoint) as client:
        clock = bus.publisher(topics.CLOCK.at("sys"), "uvf.v1.Clock", topics.CLOCK.qos)

        def says(payload, heard):
            # One at a time: of two that come together only the newest is kept.
            clock.put(payload, 0)
            return heard()

        sound = Clock(t_ns=5_000_000_000).SerializeToString()
        client.wait(lambda: says(sound, lambda: client.time == 5.0), 20.0, "the clock is not heard")
        client.wait(lambda: says(b"\xff\xff", lambda: client.time and client.refused["uvf/sys/time/clock"] > 3), 20.0, "not refused")
        assert client.time == 5.0
        arm = topics.ARM.at("burger")
        answering = bus._session.declare_queryable(arm, lambda query: query.reply(arm, b"\xff\xff"))
        client.wait(lambda: client._bus._session.declare_querier(arm).matching_status.matching, 20.0, "nobody is asked there")
        with pytest.raises(Malformed, match=r"uvf/burger/srv/arm: broken uvf\.v1\.Reply"):
            client.ask("burger", topics.ARM, topics.ARM.message())
        answering.undeclare()
    router.close()


def test_without_a_router_it_is_one_error_that_says_what_to_start():
    with pytest.raises(ConnectionError, match=r"no router at tcp/127\.0\.0\.1:9: start 'uvf up' first") as caught:
        uvf.connect("tcp/127.0.0.1:9", timeout=0.2)
    assert caught.value.__suppress_context__


def test_a_vehicle_that_is_not_there_is_told_with_those_that_are():
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    router = open_router(endpoint)
    with ZenohBus(endpoint, timeout=5.0) as bus, uvf.connect(endpoint) as client:
        bus.token(f"@ep/scout/autopilot_ground/pub/{topics.STATUS.at('scout').replace('/', '%')}/uvf.v1.VehicleStatus")
        client.wait(lambda: client.vehicles() == ["scout"], 20.0, "the vehicle is not seen")
        with pytest.raises(TimeoutError, match="nobody answers uvf/scuot/srv/arm: no vehicle 'scuot' is running; did you mean 'scout'"):
            client.ask("scuot", topics.ARM, topics.ARM.message())
        with pytest.raises(TimeoutError, match=r"nothing on uvf/other/nav/pose within 0.1 s: no vehicle 'other' .*there are: scout"):
            client.read("other", topics.POSE, 0.1)
        with pytest.raises(TimeoutError, match=r"nothing on uvf/scout/nav/pose within 0.1 s$"):
            client.read("scout", topics.POSE, 0.1)
    router.close()
