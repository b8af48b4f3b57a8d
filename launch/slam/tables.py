"""The figures of a run as rows of text, the first one the heading."""

from launch.slam.scoring import Figures
from uvf.slam.evaluation.reference import ALIGNABLE

Rows = list[tuple[str, ...]]

RELATION_HEAD = ("poses", "pairs", "number", "m, Freiburg", "m, Cartographer", "deg", "p95 m", "worst m", "> 0.5 m")
REFERENCE_HEAD = ("poses", "error", "number", "RMSE m", "mean m", "worst m", "RMSE deg")


def run_rows(figures: Figures) -> Rows:
    """Size and times of the run, as rows."""
    r = figures["run"]
    return [
        ("readings", "keyframes", "duration", "way", "wall", "CPU", "times real time"),
        (
            f"{r['readings']}",
            f"{r['keyframes']}",
            f"{r['duration_s']:.1f} s",
            f"{r['path_length_m']:.1f} m",
            f"{r['wall_s']:.2f} s",
            f"{r['cpu_s']:.2f} s",
            f"{r['times_real_time']:.1f}",
        ),
    ]


def relation_rows(figures: Figures) -> dict[str, Rows]:
    """Errors by poses and group, as rows for each file of relations."""
    return {name: [RELATION_HEAD, *_relation_rows(by_poses)] for name, by_poses in figures["relations"].items()}


def _relation_rows(by_poses: Figures) -> Rows:
    rows: Rows = []
    for poses, groups in by_poses.items():
        for group, f in groups.items():
            metres, degrees = f["freiburg_m"], f["rotation_deg"]
            means = (_spread(metres), f"{f['cartographer_m']['mean']:.4f}", _spread(degrees))
            rows.append((poses, group, f"{f['number']}", *means, f"{metres['p95']:.3f}", f"{metres['max']:.3f}", f"{f['gross']}"))
    return rows


def _spread(f: dict[str, float]) -> str:
    return f"{f['mean']:.4f} ± {f['std']:.4f}"


def reference_rows(figures: Figures) -> dict[str, Rows]:
    """Errors by poses and kind, as rows for each reference file."""
    return {name: [REFERENCE_HEAD, *_reference_rows(by_poses)] for name, by_poses in figures["references"].items()}


def _reference_rows(by_poses: Figures) -> Rows:
    rows: Rows = []
    for poses, kinds in by_poses.items():
        for kind, f in kinds.items():
            metres = [f"{f[key]:.3f}" for key in ("rmse_m", "mean_m", "max_m")]
            turn = f["rotation_rmse_deg"]
            rows.append((poses, kind, f"{f['number']}", *metres, "-" if turn is None else f"{turn:.2f}"))
    return rows


def remarks(figures: Figures) -> list[str]:
    """A line for each reference that has a figure which cannot be told."""
    return [
        f"distance to {name}: the path is too short to align (it reaches less than {ALIGNABLE:g} m), so no error of the rotation is told"
        for name, by_poses in figures["references"].items()
        if any(f["rotation_rmse_deg"] is None for kinds in by_poses.values() for f in kinds.values())
    ]


def all_tables(figures: Figures) -> dict[str, Rows]:
    """All tables by heading: the run itself, each file of relations, each reference."""
    relations = {f"errors of {name}": rows for name, rows in relation_rows(figures).items()}
    references = {f"distance to {name}": rows for name, rows in reference_rows(figures).items()}
    return {"run": run_rows(figures), **relations, **references}
