"""Files that Git LFS keeps elsewhere: what a clone without it has in their place."""

from pathlib import Path

from uvf.models.yaml_data import BadInput

BEGINNING = b"version https://git-lfs.github.com/spec/"


def refuse_pointer(path: Path) -> None:
    """Raises BadInput where only the pointer of a file is there; says nothing of a file that cannot be read."""
    try:
        with path.open("rb") as file:
            begins = file.read(len(BEGINNING))
    except OSError:
        return
    if begins == BEGINNING:
        raise BadInput(f"{path}: only a pointer of Git LFS is there; get the file itself with 'git lfs pull'")
