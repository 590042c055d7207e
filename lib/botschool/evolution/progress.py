"""What a user sees while robots evolve: a progress bar, or a line per generation."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from botschool.evolution.run import Run


@contextmanager
def reporting(budget: int, seed: int, terminal: bool):
    """Gives a function to call with the run after each generation."""
    if terminal:
        with _bar(budget, seed) as report:
            yield report
    else:
        yield _line


def _numbers(run: Run) -> str:
    last = run.record.last
    return (
        f"best {last['best fitness']:.1f}  post-evaluated {last['best post-evaluated']:.1f}  "
        f"mean {last['average']:.1f}"
    )


def _line(run: Run) -> None:
    if not run.record.generation:
        return
    last = run.record.last
    print(
        f"seed {run.seed}  generation {run.record.generation}  steps {run.record.steps} "
        f"({100 * run.record.steps / run.max_steps:.1f}%)  {_numbers(run)}  "
        f"of this generation {last['best of generation']:.1f}  "
        f"parameter {last['average parameter']:.3f}",
        flush=True,
    )


@contextmanager
def _bar(budget: int, seed: int):
    with progress_bar(budget, seed) as show:
        yield lambda run: show(run.record.steps, 2, _numbers(run) if run.record.generation else "")


@contextmanager
def progress_bar(budget: int, seed: int) -> Iterator[Callable[[int, int, str], None]]:
    """Gives a function to call with the steps so far, decimals of their millions, and a text."""
    from rich.progress import (
        BarColumn,
        Progress,
        TaskProgressColumn,
        TextColumn,
        TimeRemainingColumn,
    )

    columns = (
        TextColumn("seed {task.fields[seed]}"),
        BarColumn(bar_width=8),
        TaskProgressColumn(),
        TextColumn("{task.fields[steps]}"),
        TimeRemainingColumn(compact=True),
        TextColumn("{task.fields[numbers]}"),
    )
    with Progress(*columns, refresh_per_second=5) as progress:
        task = progress.add_task("", total=budget, seed=seed, steps="", numbers="")

        def show(steps: int, decimals: int, numbers: str) -> None:
            millions = f"{steps / 1e6:.{decimals}f}M"
            progress.update(task, completed=min(steps, budget), steps=millions, numbers=numbers)

        yield show
