"""Puts the generated MAVLink dialect into the wheel: an installed package needs neither a writable place nor the generator."""

import sys
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class DialectHook(BuildHookInterface[Any]):
    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        sys.path.insert(0, str(Path(self.root) / "src"))
        from uvf.mavlink.generate import NAME, dialect_folder

        build_data["force_include"][str(dialect_folder() / NAME)] = f"uvf/mavlink/{NAME}"
