"""The options of ``uvf bench`` that only some cases know: which runs of a case are made, and what is kept of them.

A module of a group whose cases know such options has ``OPTIONS``, the names of the options by case, and its ``CASES`` is a
function of the data folder and the selection.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, fields
from pathlib import Path

from uvf.models.yaml_data import BadInput, listed


@dataclass(frozen=True)
class Selection:
    """What was given on the command line; None = not given. Each case has defaults of its own.

    worlds: names, numbers and ranges; csv: file for rows of single runs; pictures: folder for one of each failure.
    """

    worlds: str | None = None
    trials: int | None = None
    seed: int | None = None
    controller: str | None = None
    csv: Path | None = None
    pictures: Path | None = None

    def words(self) -> list[str]:
        """The options as they can be typed."""
        return [word for name in self.given() for word in (f"--{name}", str(getattr(self, name)))]

    def given(self) -> list[str]:
        """Names of the options that were given."""
        return [field.name for field in fields(self) if getattr(self, field.name) is not None]

    def begin(self) -> None:
        """Empties the file of rows and makes the folder of pictures, so that what cannot be written is told first. Raises BadInput."""
        try:
            if self.csv is not None:
                self.csv.write_text("", encoding="utf-8")
            if self.pictures is not None:
                self.pictures.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise BadInput(f"{error.filename}: cannot be written ({error.strerror}); name another place") from error


EVERYTHING = Selection()


def check_known(group: str, cases: Iterable[str], options: Mapping[str, Iterable[str]], selection: Selection) -> None:
    """Refuses an option that one of the chosen cases does not know. options: names by case. Raises BadInput."""
    for name in selection.given():
        if lacking := [case for case in cases if name not in options.get(case, ())]:
            knowing = [case for case, known in options.items() if name in known]
            mend = f"name cases that have it: {listed(knowing)}" if knowing else "leave it out"
            which = f"{group} {lacking[0]}" if options else group
            raise BadInput(f"bench {which} has no --{name}; {mend}")
