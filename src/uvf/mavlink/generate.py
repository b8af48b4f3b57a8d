"""Generates ``dialect.py``, the module of MAVLink's messages, from ``schemas/mavlink`` with pymavlink's generator.

It is made at install, and at the first import where it is missing or the definitions or pymavlink have changed since (0.3 s).
"""

import atexit
import contextlib
import hashlib
import io
import os
import shutil
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path

PACKAGE = Path(__file__).parent
DEFINITIONS = Path(__file__).resolve().parents[3] / "schemas" / "mavlink"
NAME = "dialect.py"


def dialect_folder(package: Path = PACKAGE, definitions: Path = DEFINITIONS) -> Path:
    """The folder of a ``dialect.py`` made from these definitions: the package, if it is writable or already has one.

    Else the user's cache, else one that ends with this process. Raises ImportError for definitions that the generator refuses.
    """
    if not definitions.is_dir():  # an installed package: its dialect was made when it was built
        return package
    head = _head(definitions)
    folders = [package, *_user_cache(head)]
    found = next((folder for folder in folders if _begins_with(folder / NAME, head)), None)
    return found or _place(head + _generated(definitions / "common.xml"), folders)


def _user_cache(head: str) -> Iterator[Path]:
    """A folder for each content: other versions of the project use the same cache."""
    with contextlib.suppress(RuntimeError):  # a user without a home
        cache = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
        yield cache / "uvf" / f"mavlink-{hashlib.sha256(head.encode()).hexdigest()[:16]}"


def _head(definitions: Path) -> str:
    """The first line of a dialect: what it was made of. One that says something else is made anew."""
    import pymavlink

    digest = hashlib.sha256(pymavlink.__version__.encode())
    for path in sorted(definitions.glob("*.xml")):
        digest.update(path.read_bytes())
    return f"# pymavlink {pymavlink.__version__}, definitions {digest.hexdigest()}\n"


def _begins_with(path: Path, head: str) -> bool:
    try:
        with path.open(encoding="utf-8") as file:
            return file.readline() == head
    except (OSError, UnicodeDecodeError):
        return False


def _generated(definition: Path) -> str:
    """Raises ImportError with what the generator says."""
    from pymavlink.generator import mavgen, mavparse

    said = io.StringIO()
    with tempfile.TemporaryDirectory(prefix="uvf-mavlink-") as scratch:
        output = Path(scratch) / NAME
        options = mavgen.Opts(str(output), wire_protocol=mavparse.PROTOCOL_2_0, language="Python3")
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            try:
                done = mavgen.mavgen(options, [str(definition)])
            except (SystemExit, OSError, SyntaxError, mavparse.MAVParseError) as error:  # an invalid file makes it exit
                raise ImportError(f"{definition}: no dialect can be made of it: {error}") from error
        if not done:
            raise ImportError(f"{definition}: no dialect can be made of it: {said.getvalue().strip()}")
        return output.read_text(encoding="utf-8")


def _place(text: str, folders: Sequence[Path]) -> Path:
    """Writes it into the first folder that takes it."""
    for folder in folders:
        with contextlib.suppress(OSError):
            _write(folder, text)
            return folder
    folder = Path(tempfile.mkdtemp(prefix="uvf-mavlink-"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    _write(folder, text)
    return folder


def _write(folder: Path, text: str) -> None:
    """Whole or not at all, however many processes begin at once: each writes the same. Raises OSError."""
    folder.mkdir(parents=True, exist_ok=True)
    part = folder / f".{NAME}.{os.getpid()}"
    try:
        part.write_text(text, encoding="utf-8")
        part.replace(folder / NAME)
    finally:
        part.unlink(missing_ok=True)
