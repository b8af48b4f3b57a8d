"""Many runs on all cores of the machine; what comes out does not depend on how many there are."""

import os
from collections.abc import Callable, Generator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from multiprocessing import get_context

import typer
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

from benchmarks.measuring.processes import one_thread_each
from benchmarks.planning.barn.simulation import Run, Trial, run
from benchmarks.planning.barn.worlds import World

LINES = 10
"""Lines that tell of progress where there is no terminal."""


@dataclass(frozen=True)
class Series:
    """So many trials in each of some worlds. load: makes a world from its number, and can be sent to another process."""

    name: str
    load: Callable[[int], World]
    numbers: Sequence[int]
    trials: int
    seed: int
    controller: str


def make_runs(series: Series, processes: int | None = None) -> list[Run]:
    """All runs, by world and trial, in so many processes, as many as there are cores by default. Raises BadInput."""
    jobs = [(number, Trial(trial, series.seed, series.controller)) for number in series.numbers for trial in range(series.trials)]
    workers = min(processes or len(os.sched_getaffinity(0)), len(jobs))
    shown = _shown(series.name, len(jobs))
    next(shown)
    if workers == 1:
        runs = []
        for number, trial in jobs:
            runs.append(_one(series.load, number, trial))
            shown.send(runs[-1])
        shown.close()
        return runs
    with one_thread_each(), ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
        futures: list[Future[Run]] = [pool.submit(_one, series.load, *job) for job in jobs]
        try:
            for done in as_completed(futures):
                shown.send(done.result())
        finally:
            shown.close()
            pool.shutdown(wait=False, cancel_futures=True)
        return [future.result() for future in futures]


def _one(load: Callable[[int], World], number: int, trial: Trial) -> Run:
    return run(load(number), trial)


def _shown(name: str, total: int) -> Generator[None, Run, None]:
    """Takes runs as they are done: a bar on a terminal, else now and then a line on the standard error."""
    console = Console(stderr=True)
    failed = 0
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn("{task.completed} of {task.total} runs, {task.fields[failed]} failed"),
        TimeElapsedColumn(),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task(name, total=total, failed=0)
        for done in range(1, total + 1):
            made = yield
            failed += made.ending != "success"
            bar.update(task, completed=done, failed=failed)
            if not console.is_terminal and done * LINES // total > (done - 1) * LINES // total:
                typer.echo(f"uvf: {name} {done} of {total} runs, {failed} failed", err=True)
        yield
