"""The page of measured figures: where each section comes from, and whether the stated goals are met."""

import os
import platform
import shlex
import subprocess
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import msgspec

from launch.settings import ROOT
from uvf.models.yaml_data import load_yaml

Rows = Mapping[str, Mapping[str, float]]
GOALS = ROOT / "benchmarks" / "goals.yaml"


class BenchmarkGoal(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What a column shall be in some rows; source: the page that states it."""

    rows: list[str]
    column: str
    source: str
    at_most: float | None = None
    at_least: float | None = None


class Stated(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What goals.yaml states about a benchmark group. notes: where rows come from that the command does not measure."""

    goals: list[BenchmarkGoal] = []
    notes: list[str] = []


class _Page(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    groups: dict[str, Stated]


@dataclass(frozen=True)
class BenchmarkFacts:
    """How benchmark figures were obtained: command, commit, date and machine."""

    command: str
    commit: str
    date: str
    machine: str

    def line(self) -> str:
        """The facts as one line of Markdown."""
        return f"`{self.command}`; commit {self.commit}, {self.date}; {self.machine}"


def facts_now(names: Sequence[str]) -> BenchmarkFacts:
    """The facts of a benchmark run that begins now."""
    load = ", ".join(f"{value:.1f}" for value in os.getloadavg())
    machine = f"{os.cpu_count()} x {_processor()}, Python {platform.python_version()}, load before {load} (1, 5, 15 min)"
    return BenchmarkFacts(shlex.join(["./uvf", "bench", *names, "--write"]), _commit(), time.strftime("%Y-%m-%d"), machine)


def _processor() -> str:
    info = Path("/proc/cpuinfo")
    names = (
        [line.partition(":")[2].strip() for line in info.read_text().splitlines() if line.startswith("model name")] if info.exists() else []
    )
    return names[0] if names else platform.machine()


def _commit() -> str:
    """With a word when the tree was changed since."""
    try:
        done = subprocess.run(
            ["git", "describe", "--always", "--dirty=, changed since"], cwd=ROOT, capture_output=True, text=True, check=True
        )
    except (OSError, subprocess.CalledProcessError):
        return "not known"
    return done.stdout.strip()


def _stated(group: str) -> Stated:
    return load_yaml(GOALS, _Page).groups.get(group, Stated())


def notes_of(group: str) -> list[str]:
    """The notes that goals.yaml holds for a benchmark group."""
    return list(_stated(group).notes)


def verdicts(group: str, rows: Rows) -> list[str]:
    """One line for each goal whose row was measured, with the value and whether the goal is met."""
    lines = []
    for goal in _stated(group).goals:
        for name in goal.rows:
            value = rows.get(name, {}).get(goal.column)
            if value is not None:
                lines.append(f"Goal of {goal.source}: {name}, {goal.column} {_limits(goal)}: {value:.4g}, {_verdict(goal, value)}")
    return lines


def _limits(goal: BenchmarkGoal) -> str:
    limits = (("at least", goal.at_least), ("at most", goal.at_most))
    return " and ".join(f"{word} {limit:g}" for word, limit in limits if limit is not None)


def _verdict(goal: BenchmarkGoal, value: float) -> str:
    met = (goal.at_least is None or value >= goal.at_least) and (goal.at_most is None or value <= goal.at_most)
    return "met" if met else "not met"


def replace_section(text: str, title: str, figures: Rows, lines: Sequence[str]) -> str:
    """The results page with the section of that title renewed, or added; lines: the list above its table."""
    columns = list(dict.fromkeys(metric for row in figures.values() for metric in row))
    table = [f"| {title} | {' | '.join(columns)} |", "|---" * (len(columns) + 1) + "|"]
    table += [f"| {n} | {' | '.join(f'{row[c]:.4g}' if c in row else '' for c in columns)} |" for n, row in figures.items()]
    section = f"\n## {title}\n\n" + "\n".join([*(f"* {line}" for line in lines), "", *table]) + "\n"
    before, found, after = text.partition(f"\n## {title}\n")
    rest = after.partition("\n## ")
    tail = f"\n## {rest[2]}" if found and rest[1] else ""
    return before.rstrip("\n") + "\n" + section + tail
