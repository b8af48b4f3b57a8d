"""A log of any format that SLAM can be run on, by its ending."""

from pathlib import Path

from uvf.models.yaml_data import BadInput
from uvf.runtime.log.laser_log import ENDING as MCAP_ENDING
from uvf.runtime.log.laser_log import read_mcap
from uvf.slam.logs.carmen import read_carmen
from uvf.slam.logs.laser_log import LaserLog

CARMEN_ENDINGS = (".clf", ".log")


def open_log(path: Path, vehicle: str | None = None) -> LaserLog:
    """Opens a log, or the log of a run's folder; vehicle: which one, where a run has several. Raises BadInput."""
    if is_recorded(path):
        return read_mcap(path, vehicle)
    if path.is_dir():
        inside = sorted(p.name for p in path.iterdir() if p.suffix.lower() in CARMEN_ENDINGS)
        hint = f"name a log in it: {', '.join(inside)}" if inside else "and there is no log in it"
        raise BadInput(f"log {path}: is a folder; {hint}")
    if path.suffix.lower() not in CARMEN_ENDINGS:
        raise BadInput(f"log {path}: neither a CARMEN log ({', '.join(CARMEN_ENDINGS)}) nor a log of a run ({MCAP_ENDING})")
    if vehicle is not None:
        raise BadInput(f"log {path}: CARMEN logs are of one robot, which has no name; leave out --vehicle")
    return read_carmen(path)


def is_recorded(path: Path) -> bool:
    """Whether the path is a log recorded by uvf, or the folder of a run."""
    return path.suffix == MCAP_ENDING or (path.is_dir() and any(path.glob(f"*{MCAP_ENDING}")))
