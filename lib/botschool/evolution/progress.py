"""What a user sees while robots evolve: a progress bar, or a line per generation."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from botschool.evolution.run import Run


@contextmanager
def reporting(seed: int, terminal: bool) -> Iterator[Callable[[Run], None]]:
    """Gives a function to call with the run after each generation, and at will during one."""
    if terminal:
        with progress_bar(seed) as show:
            yield lambda run: show(
                run.limit.share(run),
                run.record.steps,
                2,
                run.numbers() if run.record.generation else "",
            )
        return
    printed = 0

    def line(run: Run) -> None:
        nonlocal printed
        if run.record.generation > printed:
            printed = run.record.generation
            print(run.line(), flush=True)

    yield line


@contextmanager
def progress_bar(seed: int) -> Iterator[Callable[[float, int, int, str], None]]:
    """Gives a function to call with the share done, the steps so far, decimals of their millions,
    and a text."""
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
        task = progress.add_task("", total=1.0, seed=seed, steps="", numbers="")

        def show(share: float, steps: int, decimals: int, numbers: str) -> None:
            millions = f"{steps / 1e6:.{decimals}f}M"
            progress.update(task, completed=min(share, 1.0), steps=millions, numbers=numbers)

        yield show
