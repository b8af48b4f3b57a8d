"""Renders the generated pages of the documentation: ``python -m launch.docs.pages [--check]``."""

import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path

from launch.commands import table
from launch.docs import api_pages, command_page, keys_page, messages_page, params_page
from services.autopilot.mavlink.parameters import parameter_page
from uvf.models.scenario import ROOT

REFERENCE = ROOT / "docs" / "reference"
PAGES: dict[Path, Callable[[], str]] = {
    table.PAGE: table.render,
    parameter_page.PAGE: parameter_page.render,
    REFERENCE / "command-line.md": command_page.render,
    REFERENCE / "keys.md": keys_page.render,
    REFERENCE / "service-parameters.md": params_page.render,
    REFERENCE / "messages.md": messages_page.render,
    **{REFERENCE / "api" / f"{part}.md": partial(api_pages.render, part) for part in api_pages.PARTS},
}


def outdated() -> list[str]:
    """The pages that differ from what would be rendered now."""
    pages = ((path, path.read_text(encoding="utf-8") if path.exists() else "", render()) for path, render in PAGES.items())
    return [str(path.relative_to(ROOT)) for path, old, new in pages if old != new]


def main() -> None:
    """Writes the pages, or with ``--check`` only compares them."""
    if "--check" in sys.argv:
        if old := outdated():
            raise SystemExit(f"not up to date: {', '.join(old)}; run python -m launch.docs.pages")
        return
    for path, render in PAGES.items():
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(render(), encoding="utf-8")


if __name__ == "__main__":
    main()
