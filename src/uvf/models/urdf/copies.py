"""The files of a xacro, copied for its expansion: packages found, every link and joint marked with its line.

xacro reads what it is told to read. So the copies lie in a scratch folder as the originals lie in the file system, names relative to
another file hold, and what it asks for beyond them tells which file to copy next.
"""

import glob
import os
import re
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

from lxml import etree

from uvf.models.urdf.marked import XACRO, marked
from uvf.models.urdf.packages import installed, is_file, package_folder
from uvf.models.yaml_data import BadInput

FIND = re.compile(r"\$\(find\s+([^)]+?)\s*\)")
COMPUTED = re.compile(r"\$\{[^}]*\}|\$\([^)]*\)")
SWITCH = re.compile(r"\$\(optenv\s+(\w+)\s+(?:0|1|true|false)\s*\)", re.IGNORECASE)
WILD = re.compile(r"[*?[]")
DATA = (".yaml", ".yml")  # read by expressions
NOTHING = b"<robot/>"


class Copies:
    """The scratch copies of a xacro file and of what it includes.

    path: the file to expand; scratch: an empty folder; note: is told of files that are not there, which then are left out.
    """

    def __init__(self, path: Path, scratch: Path, note: Callable[[str], None] | None) -> None:
        self.path = path
        self._note = note
        self._files, self._packages = f"{scratch}/files", f"{scratch}/packages"
        self._optional: list[re.Pattern[str]] = []
        self._done: set[str] = set()
        self.missed: list[str] = []
        """Files that are included and not there."""
        self.switches: set[str] = set()
        """Variables of the environment that turn a part of the robot on or off."""
        self.main = f"{self._files}{path.absolute()}"
        self._copy(path, self.main)

    def bring(self, name: str) -> bool:
        """Copies the file that xacro missed under this name; False where that changes nothing. Raises BadInput for one that is nowhere."""
        if name in self._done or not name.startswith((self._files, self._packages)):
            return False
        original = self._original(name)
        if original is not None and is_file(original):
            self._copy(original, name)
        elif Path(name).suffix in DATA:
            return False
        else:
            if not any(pattern.search(name) for pattern in self._optional):
                self._miss(name)
            self._write(name, NOTHING)
        return True

    def bring_matching(self, spec: str) -> bool:
        """Copies the files that a name with wild cards matches; False where it matches nothing new."""
        brought = [self.bring(name) for name in self._matching(spec)]
        return any(brought)

    def original_names(self, text: str) -> str:
        """A text of the expansion with the names of the original files. Raises BadInput for a package that is nowhere."""
        text = re.sub(rf"{re.escape(self._packages)}/([^/\"'<>\s]+)", lambda found: self._folder(found[1]), text)
        return text.replace(self._files, "")

    def _copy(self, original: Path, name: str) -> None:
        if original.suffix in DATA:
            self._write(name, original.read_bytes())
            return
        root = marked(original, self._shown(original))
        for tag in root.iter(etree.Element):
            for key, value in tag.items():
                self.switches.update(SWITCH.findall(value))
                tag.set(key, FIND.sub(self._found, value))
            tag.text = FIND.sub(self._found, tag.text) if tag.text else tag.text
        includes = [tag for tag in root.iter("{*}include") if tag.prefix == XACRO]
        for tag in includes:
            self._prepare(tag)
        self._write(name, etree.tostring(root))
        for tag in includes:
            self._bring_ahead(tag.get("filename", ""), name)

    def _prepare(self, include: Any) -> None:
        """An optional file is asked for like any other: nobody would hear of one that is there, but not yet copied."""
        filename = include.get("filename", "")
        if filename.startswith("/") and not filename.startswith((self._files, self._packages)):
            include.set("filename", self._files + filename)
        if include.attrib.pop("optional", "false").lower() not in ("false", "0"):
            self._optional.append(re.compile(".*".join(map(re.escape, COMPUTED.split(filename))) + r"\Z"))

    def _bring_ahead(self, filename: str, by: str) -> None:
        """What a file includes under a plain name: xacro has not to begin again for it. Whether it is needed shows later."""
        if COMPUTED.search(filename):
            return
        name = os.path.join(os.path.dirname(by), filename)  # noqa: PTH118, PTH120  as xacro does; ".." stays
        original = self._original(name)
        with suppress(BadInput):
            if WILD.search(filename):
                self.bring_matching(name)
            elif original is not None and is_file(original):
                self.bring(name)

    def _write(self, name: str, content: bytes) -> None:
        self._done.add(name)
        target = Path(name)
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(content)

    def _found(self, find: re.Match[str]) -> str:
        """For $(find package): the copy of its folder. Computed names are looked up when they are used."""
        folder = None if COMPUTED.search(find[1]) else package_folder(self.path, find[1])
        return f"{self._packages}/{find[1]}" if folder is None else f"{self._files}{folder}"

    def _folder(self, package: str) -> str:
        folder = package_folder(self.path, package)
        if folder is None and self._note is None:
            raise BadInput(f"{self.path}: $(find {package}): no folder '{package}' about the file; put the package there")
        return str(folder or f"/package/{package}")

    def _root(self, name: str) -> tuple[str, Path | None]:
        """The folder of copies that a name begins with, and what it is the copy of; None for a package that is nowhere."""
        if not name.startswith(self._packages):
            return self._files, Path("/")
        package = name.removeprefix(f"{self._packages}/").split("/", 1)[0]
        return f"{self._packages}/{package}", package_folder(self.path, package)

    def _original(self, name: str) -> Path | None:
        start, folder = self._root(name)
        if folder is None:
            return None
        path = folder / name.removeprefix(start).lstrip("/")
        return path if WILD.search(name) or is_file(path) else installed(path) or path

    def _matching(self, spec: str) -> Iterator[str]:
        start, folder = self._root(spec)
        if folder is not None:
            for match in sorted(glob.glob(str(self._original(spec)))):  # noqa: PTH207  as xacro does
                yield f"{start}/{match.removeprefix(str(folder)).lstrip('/')}"

    def _miss(self, name: str) -> None:
        original = self.original_names(name)
        if self._note is None:
            raise BadInput(f"{self.path}: included file '{self._shown(Path(original))}' is not there; put it there or mend its name")
        self.missed.append(original.removeprefix("/package/"))
        self._note(f"included file not found, left out: {self.missed[-1]}")

    def _shown(self, original: Path) -> Path:
        """As the user writes it: below the folder he is in, where the file to expand was so named."""
        return original if self.path.is_absolute() or not original.is_relative_to(Path.cwd()) else original.relative_to(Path.cwd())
