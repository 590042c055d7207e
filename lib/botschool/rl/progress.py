"""What a user sees during a training: a progress bar, or a line per post-evaluation."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from botschool.rl.folder import Evaluations


@contextmanager
def reporting(
    budget: int, seed: int, terminal: bool
) -> Iterator[Callable[[int, Evaluations], None]]:
    """Gives a function to call with the steps and the post-evaluations so far."""
    if terminal:
        with _bar(budget, seed) as report:
            yield report
        return
    printed = 0

    def line(steps: int, evaluations: Evaluations) -> None:
        nonlocal printed
        if len(evaluations.steps) > printed:
            printed = len(evaluations.steps)
            percent = min(100.0, 100 * steps / budget)
            print(
                f"seed {seed}  steps {steps} ({percent:.0f}%)  {_numbers(evaluations)}", flush=True
            )

    yield line


def _numbers(evaluations: Evaluations) -> str:
    sd = evaluations.returns[-1].std()
    return (
        f"post-evaluated {evaluations.last:.1f} \u00b1 {sd:.1f}  best so far {evaluations.best:.1f}"
    )


@contextmanager
def _bar(budget: int, seed: int) -> Iterator[Callable[[int, Evaluations], None]]:
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

        def report(steps: int, evaluations: Evaluations) -> None:
            fields = {"steps": f"{steps / 1e6:.3f}M", "numbers": _numbers(evaluations)}
            progress.update(task, completed=min(steps, budget), **fields)

        yield report
