"""What a package of the library offers by name, imported only when it is asked for: a student's first line loads one algorithm, not all."""

import difflib
import importlib
import sys
from collections.abc import Callable, Mapping
from importlib.util import find_spec
from typing import Any


def lazily(package: str, offered: Mapping[str, str]) -> tuple[Callable[[str], Any], Callable[[], list[str]]]:
    """A package's ``__getattr__`` and ``__dir__``. offered: name -> ``module:name`` that it stands for.

    An unknown name raises AttributeError, and ImportError in ``from package import name``, both with the nearest name.
    """

    def getattr_of_package(name: str) -> Any:
        if name not in offered:
            hint = f"no '{name}' in {package}; {_nearest(name, offered)}"
            is_imported = sys._getframe(1).f_code.co_name == FROM_IMPORT
            if is_imported and find_spec(f"{package}.{name}") is None:
                raise ImportError(hint, name=package)
            raise AttributeError(hint)
        module, _, attribute = offered[name].partition(":")
        return getattr(importlib.import_module(module), attribute)

    def dir_of_package() -> list[str]:
        return sorted({*vars(sys.modules[package]), *offered})

    return getattr_of_package, dir_of_package


FROM_IMPORT = "_handle_fromlist"
"""Function of importlib that looks up the names of ``from package import name``; of an AttributeError Python would keep no word."""


def _nearest(name: str, offered: Mapping[str, str]) -> str:
    lower = {each.lower(): each for each in offered}
    close = difflib.get_close_matches(name.lower(), lower, n=1, cutoff=0.5)
    return f"did you mean '{lower[close[0]]}'?" if close else f"there are: {', '.join(sorted(offered))}"
