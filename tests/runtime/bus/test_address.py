"""The page's address comes from the environment, and a wrong or taken one ends in one clear line."""

import socket

import pytest

from uvf.models.yaml_data import BadInput
from uvf.runtime.bus.address import Address, address_from, claim, claim_router, refusal


def test_by_default_only_this_machine_is_served():
    assert address_from({}) == Address("127.0.0.1", 8080, "")
    assert address_from({}).url == "http://127.0.0.1:8080/"


def test_an_address_that_others_reach_gets_a_token_in_its_url():
    address = address_from({"UVF_GCS_HOST": "0.0.0.0", "UVF_GCS_PORT": "9000"})
    assert len(address.token) >= 16
    assert address.url.endswith(f":9000/?token={address.token}")
    assert address.token != address_from({"UVF_GCS_HOST": "0.0.0.0"}).token


@pytest.mark.parametrize("port", ["0", "65536", "-1", "http", ""])
def test_a_wrong_port_is_refused(port):
    with pytest.raises(BadInput, match="UVF_GCS_PORT"):
        address_from({"UVF_GCS_PORT": port})


def test_a_taken_port_is_named_with_a_way_out():
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()
        port = other.getsockname()[1]
        with pytest.raises(BadInput, match=rf"127\.0\.0\.1:{port}.*UVF_GCS_PORT=8081"):
            claim(Address("127.0.0.1", port))
        with pytest.raises(BadInput, match=f"port {port} for the router is taken.*UVF_ROUTER=tcp/"):
            claim_router(f"tcp/127.0.0.1:{port}")
        assert "in use" in refusal("127.0.0.1", port)
    claim(Address("127.0.0.1", port))
    claim_router(f"tcp/127.0.0.1:{port}")


def test_an_address_of_the_newer_kind_is_asked_for_too():
    """Where this machine has none, the reason says so; it is not taken for a broken address."""
    assert refusal("[::1]", 1) in ("", "Cannot assign requested address", "Address family not supported by protocol")


def test_the_token_can_be_chosen_and_for_a_container_left_empty():
    assert address_from({"UVF_GCS_HOST": "0.0.0.0", "UVF_GCS_TOKEN": "chosen"}).token == "chosen"
    assert address_from({"UVF_GCS_HOST": "0.0.0.0", "UVF_GCS_TOKEN": ""}).token == ""
