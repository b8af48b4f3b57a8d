"""What a package of the library offers by name, imported only when it is asked for: a student's first line loads one algorithm, not all."""

import importlib
from collections.abc import Callable, Mapping
from typing import Any


def lazily(package: str, offered: Mapping[str, str]) -> Callable[[str], Any]:
    """A module's ``__getattr__``. offered: name -> ``module:name`` that it stands for. Raises AttributeError for any other name."""

    def getattr_of_package(name: str) -> Any:
        if name not in offered:
            raise AttributeError(f"module '{package}' has no attribute '{name}'")
        module, _, attribute = offered[name].partition(":")
        return getattr(importlib.import_module(module), attribute)

    return getattr_of_package
