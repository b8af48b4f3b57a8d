"""What the surroundings decide: endpoints, folders and limits, each by one environment variable with a default."""

import os
from pathlib import Path

from uvf.runtime.params import BadInput, nearest
from uvf.runtime.site import ROOT

GIGABYTE = 1_000_000_000


def router_endpoint() -> str:
    return os.environ.get("UVF_ROUTER", "tcp/127.0.0.1:7447")


def gcs_address() -> tuple[str, int]:
    """Where the page will be. Raises BadInput."""
    from uvf.runtime.address import address_from

    address = address_from()
    return address.host, address.port


def runs_folder() -> Path:
    return Path(os.environ.get("UVF_RUNS", str(ROOT / "runs")))


def runs_quota() -> float:
    """Bytes that old runs may take together."""
    return float(os.environ.get("UVF_RUNS_QUOTA_GB", "5")) * GIGABYTE


def mission_path(name: str) -> Path:
    """A mission by its file's path or by its name in ``missions/``. Raises BadInput."""
    for path in (Path(name), ROOT / "missions" / f"{name}.yaml", ROOT / name):
        if path.is_file():
            return path
    known = [p.stem for p in (ROOT / "missions").glob("*.yaml")]
    raise BadInput(f"no mission '{name}'; {nearest(Path(name).stem, known)}")
