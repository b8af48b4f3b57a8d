"""What a run was made with, so that it can be made again."""

import platform
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version

PACKAGES = ("uvf", "eclipse-zenoh", "pybullet", "jsbsim", "numpy", "scipy", "numba", "pymavlink")
"""Those whose results, or messages, a run consists of."""


def versions() -> dict[str, str]:
    """Date, system, Python and packages by name; a package that is not installed is left out."""
    found = {"recorded": datetime.now(UTC).isoformat(timespec="seconds")}
    found |= {"system": platform.platform(), "python": platform.python_version()}
    for package in PACKAGES:
        try:
            found[package] = version(package)
        except PackageNotFoundError:
            continue
    return found
