"""Show the progress of a training: a progress bar, or a line per post-evaluation."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from botschool.rl.folder import Evaluations
from botschool.terminal import progress_bar, readable


@contextmanager
def reporting(
    budget: int, seed: int, terminal: bool
) -> Iterator[Callable[[int, Evaluations], None]]:
    """Yield a function to call with the steps and the post-evaluations so far."""
    if terminal:
        with progress_bar(seed) as show:
            yield lambda steps, evaluations: show(steps / budget, steps, 3, _numbers(evaluations))
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
        f"post-evaluated {readable(evaluations.last)} \u00b1 {readable(sd)}  "
        f"best so far {readable(evaluations.best)}"
    )
