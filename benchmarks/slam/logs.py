"""The recorded logs that benchmarks of SLAM run over: those below DATA/slam."""

from pathlib import Path

from launch.slam.opening import CARMEN_ENDINGS
from uvf.models.yaml_data import BadInput


def logs_below(data: Path | None, bench: str, endings: tuple[str, ...] = CARMEN_ENDINGS) -> dict[str, Path]:
    """By stem; where two folders have the same, by folder and stem. bench: who asks. Raises BadInput without a folder of logs."""
    if data is None:
        raise BadInput(f"bench {bench} needs logs: name the folder above slam/ with --data")
    folder = data / "slam"
    if not folder.is_dir():
        raise BadInput(f"bench {bench} needs logs: there is no folder {folder}")
    paths = sorted(p for p in folder.rglob("*") if p.suffix in endings)
    stems = [p.stem for p in paths]
    return {p.stem if stems.count(p.stem) == 1 else f"{p.parent.name}/{p.stem}": p for p in paths}


def has_relations(log: Path) -> bool:
    """Whether relations lie beside it."""
    return any(log.parent.glob("*.relations"))
