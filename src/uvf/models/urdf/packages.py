"""Files of ROS packages without a ROS installation: looked for about the file that names them."""

import contextlib
import glob
from collections.abc import Iterable
from functools import lru_cache
from pathlib import Path

PARENTS_SEARCHED = 6


def package_folder(path: Path, package: str) -> Path | None:
    """The folder of a ROS package: one of that name among the file's parents or in one of them, or whose package.xml names it.

    Else, as in a workspace, one of that name with a package.xml up to three levels below a parent.
    """
    for parent in _near(path):
        for folder in (parent, parent / package):
            if folder.name == package and folder.is_dir():
                return folder
        manifest = parent / "package.xml"
        if manifest.is_file() and f"<name>{package}</name>" in manifest.read_text(encoding="utf-8", errors="replace"):
            return parent
    return _in_workspace(path.parent, package)


@lru_cache(maxsize=256)
def _in_workspace(folder: Path, package: str) -> Path | None:
    """Of all meshes of a package that is not there it is looked for once."""
    for parent in _near(folder / package):
        for levels in ("*", "*/*"):
            if parent != parent.parent and (found := _matching(parent, levels, f"{package}/package.xml")):
                return found[0].parent
    return None


def _matching(folder: Path, levels: str, name: str) -> list[Path]:
    """The files of this name so many levels below a folder, where others may come and go while it is looked at."""
    return [Path(found) for found in sorted(glob.glob(f"{glob.escape(str(folder))}/{levels}/{glob.escape(name)}"))]  # noqa: PTH207


def enclosing_package(path: Path) -> Path | None:
    """The folder of the ROS package in which a file lies: the nearest parent with a package.xml."""
    return next((folder for folder in path.parents if (folder / "package.xml").is_file()), None)


def installed(path: Path) -> Path | None:
    """The file that an installed package would have at a path where its sources have none: one folder deeper, or two.

    Packages of ros2_control's template keep under ``description`` what they install at the top.
    """
    package = enclosing_package(path)
    if package is None:
        return None
    rest = str(path.relative_to(package))
    return next((found for deeper in ("*", "*/*") for found in _matching(package, deeper, rest) if is_file(found)), None)


def find_mesh(path: Path, name: str) -> Path | None:
    """The file that a mesh's name stands for: package://, model://, file:// or a path beside the URDF; else one of the same
    name below the folders about it."""
    scheme, _, rest = name.rpartition("://")
    if scheme in ("", "file"):
        tries: Iterable[Path] = [path.parent / rest, Path(rest)]
    else:
        package, _, inside = rest.partition("/")
        folder = package_folder(path, package)
        there = folder / inside if folder else None
        deeper = installed(there) if there is not None and not is_file(there) else None
        tries = [*(each for each in (there, deeper) if each is not None), *(parent / inside for parent in _near(path))]
    found = next((p for p in tries if is_file(p)), None)
    return found or _beside(path, Path(rest).name)


def is_file(path: Path) -> bool:
    """Whether a path is a file; False also for a name that the system cannot take."""
    with contextlib.suppress(OSError, ValueError):
        return path.is_file()
    return False


def _near(path: Path) -> list[Path]:
    return list(path.resolve().parents)[:PARENTS_SEARCHED]


def _beside(path: Path, name: str) -> Path | None:
    """In a folder of meshes next to the URDF or to its folder."""
    folders = [parent / "meshes" for parent in path.resolve().parents[:2]]
    return next((p for folder in folders if folder.is_dir() for p in sorted(folder.rglob(name)) if p.is_file()), None)
