"""One XML file as it is written, and with the lines of its tags kept for after an expansion."""

from pathlib import Path
from typing import Any

from lxml import etree

from uvf.models.lfs_pointer import refuse_pointer
from uvf.models.yaml_data import BadInput

LINE = "uvf_line"
XACRO = "xacro"
"""The prefix by which xacro knows its tags; whatever name space it stands for, and old files have many, it does not look at."""
MARKED = ("link", "joint", "material")


def parsed(path: Path) -> Any:
    """Root element of an XML file. Raises BadInput."""
    refuse_pointer(path)
    try:
        return etree.fromstring(path.read_bytes())
    except etree.XMLSyntaxError as error:
        reason = str(error.msg).split(", line ")[0]
        raise BadInput(f"{path}:{error.lineno or 1}: not valid XML: {one_line(reason)}; mend the tag there") from error
    except (OSError, ValueError) as error:
        raise BadInput(f"{path}: cannot be read: {error}") from error


def marked(path: Path, shown: Path) -> Any:
    """Root element of an XML file with "shown:line" as an attribute of each link and joint, which expansion keeps. Raises BadInput."""
    root = parsed(path)
    for tag in root.iter(*MARKED):
        tag.set(LINE, f"{shown}:{tag.sourceline}")
    return root


def one_line(text: object) -> str:
    """The text on one line, each run of white space as one space."""
    return " ".join(str(text).split())
