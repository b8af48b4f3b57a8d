"""The tutorial's pages as what a reader does with them: files that are written, commands that are typed, outputs that are seen."""

import re
from dataclasses import dataclass
from pathlib import Path

FENCE = re.compile(r"^```(\w+)([^\n]*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
LESSONS = ("first-mission", "first-vehicle", "first-world", "first-algorithm")
DIFFERS = ("simulated ", "log ")
"""Lines that tell of this machine and this moment."""


@dataclass(frozen=True)
class File:
    """replaces: the beginning of the line that the text stands in place of; the whole file when empty."""

    path: str
    text: str
    replaces: str

    def write(self, folder: Path) -> None:
        path = folder / self.path
        path.parent.mkdir(parents=True, exist_ok=True)
        text = self.text
        if self.replaces:
            lines = path.read_text().splitlines(keepends=True)
            (at,) = (i for i, line in enumerate(lines) if line.startswith(self.replaces))
            text = "".join([*lines[:at], self.text, *lines[at + 1 :]])
        path.write_text(text)


@dataclass(frozen=True)
class Command:
    line: str
    output: list[str]


def steps(page: Path) -> list[File | Command]:
    """What a page asks its reader to do, in order; commands that run until Ctrl-C are left out."""
    found: list[File | Command] = []
    for language, attributes, text in FENCE.findall(page.read_text()):
        given = dict(re.findall(r'(\w+)="([^"]*)"', attributes))
        if "title" in given:
            found.append(File(given["title"], text, given.get("replaces", "")))
        elif language == "console":
            command, *output = text.splitlines()
            found.append(Command(command.removeprefix("$ "), [line for line in output if not line.startswith(DIFFERS)]))
    return found


def alike(line: str) -> str:
    """A line without what differs from run to run: figures, folders, widths of columns."""
    line = re.sub(r"(/[\w.-]+?)+?/(?=runs/|vehicles/|missions/|worlds/)", "", line)
    return " ".join(re.sub(r"[━┏┳┓┡╇┩└┴┘─]+", "-", re.sub(r"\d+(\.\d+)?", "#", line)).split())
