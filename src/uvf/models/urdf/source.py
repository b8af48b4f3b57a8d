"""The XML of a URDF: xacro expanded, every link and joint knowing its line."""

import io
import os
import re
import tempfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, redirect_stderr
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

import xacro
from lxml import etree
from xacro import substitution_args

from uvf.models.urdf.copies import Copies
from uvf.models.urdf.marked import XACRO, one_line, parsed
from uvf.models.urdf.packages import is_file
from uvf.models.yaml_data import BadInput, nearest

LACKS = re.compile(r"Undefined substitution argument (\w+)")
MATCHED_NOTHING = re.compile('filename spec "(.+)" matched no files')
Note = Callable[[str], None]


class XacroValues(NamedTuple):
    """What a xacro is given: its arguments, and variables of the environment that are set while it is expanded."""

    arguments: Mapping[str, str] = MappingProxyType({})
    environment: Mapping[str, str] = MappingProxyType({})


NO_VALUES = XacroValues()


def read_xml(path: Path, values: XacroValues = NO_VALUES, note: Note | None = None) -> Any:
    """Root element of a URDF, xacro expanded; ``uvf_line`` of links and joints is "file:line" where they are written.

    note: is told of included files that are not there, which then are left out, and of variables of the environment that turn parts
    on and off; without it missing files are an error. Raises BadInput.
    """
    if not is_file(path):
        known = (p.name for pattern in ("*.urdf", "*.xacro") for p in path.parent.glob(pattern))
        raise BadInput(f"{path}: no such file; {nearest(path.name, known)}")
    root = parsed(path)
    if XACRO not in root.nsmap:
        return root
    with tempfile.TemporaryDirectory(prefix="uvf-xacro-") as scratch:
        copies = Copies(path, Path(scratch), note)
        with _environment(values.environment):
            expanded = etree.fromstring(_expanded(copies, dict(values.arguments)))
        if note is not None and (others := sorted(copies.switches - set(values.environment))):
            note(f"parts that --env NAME=1 or NAME=0 turns on or off: {', '.join(others)}")
        for tag in expanded.iter(etree.Element):
            for key, value in tag.items():
                tag.set(key, copies.original_names(value))
            tag.text = copies.original_names(tag.text) if tag.text else tag.text
        return expanded


@contextmanager
def _environment(values: Mapping[str, str]) -> Iterator[None]:
    """xacro reads the environment of its process."""
    before = dict(os.environ)
    os.environ.update(values)
    try:
        yield
    finally:
        os.environ.clear()
        os.environ.update(before)


def _expanded(copies: Copies, arguments: dict[str, str]) -> bytes:
    """Runs xacro until it misses none of the files that there are: some names are computed, and only it knows them. Raises BadInput."""
    while True:
        said = io.StringIO()
        try:
            with redirect_stderr(said):
                document = xacro.process_file(copies.main, mappings=dict(arguments), verbosity=0)
        except (xacro.XacroException, substitution_args.ArgException, substitution_args.SubstitutionException) as error:
            if not _brought(copies, said.getvalue(), _missing(error)):
                lacks = LACKS.search(str(error))
                remedy = f"give it with --arg {lacks[1]}:=VALUE" if lacks else "mend the macro or give its arguments"
                raise _refusal(copies, error, remedy) from error
        except RecursionError as error:
            raise _refusal(copies, "a macro or an included file uses itself", "cut the ring") from error
        except (NameError, TypeError, ValueError, KeyError, AttributeError, SyntaxError) as error:
            raise _refusal(copies, error, "mend the expression there") from error
        else:
            if not _brought(copies, said.getvalue()):
                return str(document.toxml()).encode()


def _brought(copies: Copies, said: str, missing: str = "") -> bool:
    """Whether there are files, not yet copied, that were missed, or for names with wild cards, of which xacro only warns."""
    brought = [copies.bring(missing), *(copies.bring_matching(spec) for spec in MATCHED_NOTHING.findall(said))]
    return any(brought)


def _missing(error: BaseException | None) -> str:
    """The file that could not be opened, where that is what was wrong."""
    while isinstance(error, xacro.XacroException):
        error = error.exc
    return str(error.filename or "") if isinstance(error, OSError) else ""


def _refusal(copies: Copies, reason: object, remedy: str) -> BadInput:
    """Macros of a file that is not there are unknown: then it is that file that is missing, often of the macro's name."""
    if copies.missed:
        macro = str(reason).rpartition(":")[2].strip()
        files = [file for file in copies.missed if macro and macro in file] or copies.missed
        here = [file for file in files if file.startswith("/")]
        nowhere = [file for file in files if file not in here]
        remedies = (
            [f"it includes files that are not there, so put their packages in a folder about it: {', '.join(nowhere)}"] if nowhere else []
        )
        remedies += [f"packages that are there have no such file, so get the version that has it: {', '.join(here)}"] if here else []
        remedy = "; ".join(remedies)
    return BadInput(f"{copies.path}: xacro cannot expand it: {one_line(copies.original_names(str(reason)))}; {remedy}")
