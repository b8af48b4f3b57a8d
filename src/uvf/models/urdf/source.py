"""The XML of a URDF: xacro expanded, every link and joint knowing its line, files of packages found."""

import contextlib
import io
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager, redirect_stderr
from pathlib import Path
from typing import Any
from xml.dom import minidom

import xacro
from lxml import etree
from xacro import substitution_args

from uvf.models.yaml_data import BadInput, nearest

LINE = "uvf_line"
XACRO = "http://www.ros.org/wiki/xacro"
XACRO_SPACES = (XACRO, "http://ros.org/wiki/xacro", "http://wiki.ros.org/xacro")
MARKED = ("link", "joint", "material")
PARENTS_SEARCHED = 6
Note = Callable[[str], None]


def read_xml(path: Path, arguments: Mapping[str, str] | None = None, note: Note | None = None) -> Any:
    """The root element, xacro expanded; ``uvf_line`` of links and joints is "file:line" where they are written.

    note: is told of included files that are not there, which then are left out; without it they are an error. Raises BadInput.
    """
    if not _is_file(path):
        known = (p.name for pattern in ("*.urdf", "*.xacro") for p in path.parent.glob(pattern))
        raise BadInput(f"{path}: no such file; {nearest(path.name, known)}")
    root = _parsed(path)
    if not any(space in XACRO_SPACES for space in root.nsmap.values()):
        return root
    with _own_files(path, note), redirect_stderr(io.StringIO()):
        try:
            document = xacro.process_file(str(path), mappings=dict(arguments or {}), verbosity=0)
        except (xacro.XacroException, substitution_args.ArgException, substitution_args.SubstitutionException) as error:
            raise BadInput(f"{path}: xacro cannot expand it: {_one_line(error)}; mend the macro or give its arguments") from error
        except RecursionError as error:
            raise BadInput(f"{path}: xacro cannot expand it: a macro or an included file uses itself; cut the ring") from error
        except (NameError, TypeError, ValueError, KeyError, AttributeError, SyntaxError) as error:
            raise BadInput(f"{path}: xacro cannot expand it: {_one_line(error)}; mend the expression there") from error
    return etree.fromstring(document.toxml().encode())


def _parsed(path: Path) -> Any:
    """Raises BadInput."""
    try:
        return etree.fromstring(path.read_bytes())
    except etree.XMLSyntaxError as error:
        reason = str(error.msg).split(", line ")[0]
        raise BadInput(f"{path}:{error.lineno or 1}: not valid XML: {_one_line(reason)}; mend the tag there") from error
    except (OSError, ValueError) as error:
        raise BadInput(f"{path}: cannot be read: {error}") from error


def _marked(path: Path) -> bytes:
    """The file's text with a line in each link and joint, which expansion keeps. Raises BadInput."""
    root = _parsed(path)
    for tag in root.iter(*MARKED):
        tag.set(LINE, f"{path}:{tag.sourceline}")
    text: bytes = etree.tostring(root)
    return text


@contextmanager
def _own_files(path: Path, note: Note | None) -> Iterator[None]:
    """xacro looks for packages about the file instead of in a ROS installation, and reads files through ``_marked``."""
    parse, find = xacro.parse, substitution_args._eval_find

    def find_near(package: str) -> str:
        folder = package_folder(path, package)
        if folder is None and note is None:
            raise BadInput(f"{path}: $(find {package}): no folder '{package}' about the file; put the package there")
        return str(folder or f"/package/{package}")

    def parse_marked(source: Any, filename: str | None = None) -> Any:
        if source is not None or filename is None:
            return parse(source, filename)
        if note is not None and not Path(filename).is_file():
            note(f"included file not found, left out: {filename.removeprefix('/package/')}")
            return minidom.parseString("<robot/>")
        if not Path(filename).is_file():
            raise BadInput(f"{path}: included file '{filename}' is not there; put it there or mend its name")
        return minidom.parseString(_marked(Path(filename)))

    xacro.parse, substitution_args._eval_find = parse_marked, find_near
    try:
        yield
    finally:
        xacro.parse, substitution_args._eval_find = parse, find


def package_folder(path: Path, package: str) -> Path | None:
    """The folder of a ROS package: one of that name among the file's parents or in one of them, or whose package.xml names it."""
    for parent in _near(path):
        for folder in (parent, parent / package):
            if folder.name == package and folder.is_dir():
                return folder
        manifest = parent / "package.xml"
        if manifest.is_file() and f"<name>{package}</name>" in manifest.read_text(encoding="utf-8", errors="replace"):
            return parent
    return None


def find_mesh(path: Path, name: str) -> Path | None:
    """The file that a mesh's name stands for: package://, model://, file:// or a path beside the URDF; else one of the same
    name below the folders about it."""
    scheme, _, rest = name.rpartition("://")
    if scheme in ("", "file"):
        tries: Iterable[Path] = [path.parent / rest, Path(rest)]
    else:
        package, _, inside = rest.partition("/")
        folder = package_folder(path, package)
        tries = [*([folder / inside] if folder else []), *(parent / inside for parent in _near(path))]
    found = next((p for p in tries if _is_file(p)), None)
    return found or _beside(path, Path(rest).name)


def _is_file(path: Path) -> bool:
    """False also for a name that the system cannot take."""
    with contextlib.suppress(OSError, ValueError):
        return path.is_file()
    return False


def _near(path: Path) -> list[Path]:
    return list(path.resolve().parents)[:PARENTS_SEARCHED]


def _beside(path: Path, name: str) -> Path | None:
    """In a folder of meshes next to the URDF or to its folder."""
    folders = [parent / "meshes" for parent in path.resolve().parents[:2]]
    return next((p for folder in folders if folder.is_dir() for p in sorted(folder.rglob(name)) if p.is_file()), None)


def _one_line(text: object) -> str:
    return " ".join(str(text).split())
