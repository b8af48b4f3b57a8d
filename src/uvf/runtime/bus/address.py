"""Where the router listens and the page is served: from the environment, checked before anything is opened."""

import ipaddress
import os
import re
import secrets
import socket
from collections.abc import Mapping
from dataclasses import dataclass

from uvf.models.yaml_data import BadInput

ROUTER, DEFAULT_ROUTER = "UVF_ROUTER", "tcp/127.0.0.1:7447"
HOST, PORT, TOKEN = "UVF_GCS_HOST", "UVF_GCS_PORT", "UVF_GCS_TOKEN"


def router_from(environment: Mapping[str, str] = os.environ) -> str:
    """Endpoint of the router, by UVF_ROUTER or the default. Raises BadInput."""
    endpoint = environment.get(ROUTER, DEFAULT_ROUTER)
    host_and_port(endpoint)
    return endpoint


def host_and_port(endpoint: str, given: str = f"{ROUTER}=") -> tuple[str, int]:
    """Host and port of an endpoint such as ``tcp/127.0.0.1:7447``. Raises BadInput; given: how the endpoint was given, for its text."""
    link, _, place = re.split("[?#]", endpoint)[0].partition("/")  # zenoh's settings of a link follow
    host, _, port = place.rpartition(":")
    if not link or not host or not port.isdecimal() or not 0 < int(port) < 65536:
        raise BadInput(f"{given}{endpoint}: not an endpoint; write it as {DEFAULT_ROUTER}")
    return host, int(port)


def peer(text: str, place: str, example: str) -> tuple[str, int]:
    """Host and port of a UDP peer written as ``host:port``, the name not yet looked up. Raises BadInput."""
    host, _, port = text.strip().rpartition(":")
    if not host or not port.isdecimal() or not 0 < int(port) < 65536:
        raise BadInput(f"{place}: '{text.strip()}' is not host:port, as in {example}")
    return host, int(port)


def is_loopback(host: str) -> bool:
    """Whether a host is this machine itself, by its address or as ``localhost``."""
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"


@dataclass(frozen=True)
class Address:
    """Where the page is served, and the token that it asks for; no token where it is empty."""

    host: str = "127.0.0.1"
    port: int = 8080
    token: str = ""

    @property
    def url(self) -> str:
        """URL of the page, with the token."""
        host = socket.gethostname() if self.host == "0.0.0.0" else self.host
        return f"http://{host}:{self.port}/" + (f"?token={self.token}" if self.token else "")


def address_from(environment: Mapping[str, str] = os.environ) -> Address:
    """Address of the page, by UVF_GCS_HOST, UVF_GCS_PORT and UVF_GCS_TOKEN. Raises BadInput.

    An address that others can reach gets a random token, unless one is given; an empty one is for containers whose
    port is published on the host's loopback only.
    """
    host, text = environment.get(HOST, "127.0.0.1"), environment.get(PORT, "8080")
    if not text.isdecimal() or not 0 < int(text) < 65536:
        raise BadInput(f"{PORT}={text}: not a port; choose one from 1 to 65535")
    token = environment.get(TOKEN, "" if is_loopback(host) else secrets.token_urlsafe(16))
    return Address(host, int(text), token)


def claim(address: Address) -> None:
    """Checks that the page's port is free, for viser would silently take the next one. Raises BadInput."""
    _claim(address.host, address.port, "the page", f"{PORT}=8081")


def claim_router(endpoint: str) -> None:
    """Checks that the router's port is free. Raises BadInput."""
    _claim(*host_and_port(endpoint), "the router", f"{ROUTER}=tcp/127.0.0.1:7448")


def _claim(host: str, port: int, what: str, mend: str) -> None:
    reason = refusal(host, port)
    if reason:
        line = f"port {port} for {what} is taken ({host}:{port}: {reason}): is another 'uvf up' running? Choose another with {mend}"
        raise BadInput(line)


def refusal(host: str, port: int) -> str:
    """Why nobody can listen at this host and port now; empty when one can."""
    with socket.socket(socket.AF_INET6 if ":" in host else socket.AF_INET) as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((host.strip("[]"), port))
        except OSError as error:
            return error.strerror or str(error)
    return ""
