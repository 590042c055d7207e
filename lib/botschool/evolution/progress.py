"""What a user sees while robots evolve: a progress bar, or a line per generation."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from botschool.evolution.run import Run
from botschool.terminal import progress_bar


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
