"""Several runs of one experiment, with consecutive seeds."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path

from botschool.cluster import Open
from botschool.config import Experiment
from botschool.errors import BotschoolError
from botschool.evolution.coevolution import Coevolution
from botschool.evolution.progress import print_lines, reporting
from botschool.evolution.record import RunFiles, claimed
from botschool.evolution.run import Run, evolve
from botschool.terminal import stoppable


def replicate(
    experiment: Experiment,
    seeds: list[int],
    folder: Path,
    workers: int,
    steps: int | None,
    resume: bool,
    force: bool,
    terminal: bool,
    generations: int | None = None,
    keep_every: int | None = None,
    cluster: Open | None = None,
) -> bool:
    """Runs every seed and prints where the results are; False when the user stopped it.

    Several runs of a native problem share the workers: they run side by side, each on as many
    workers as there are for it. Everything else runs one after another, each on all workers; so
    do all runs on a cluster, which takes the place of `workers`.
    """
    kind = Coevolution if experiment.competitive else Run
    if keep_every and kind is Coevolution:
        raise BotschoolError(
            "--keep-every is for one population: the files of a co-evolution keep populations "
            "every saveeach generations, so set that."
        )
    with stoppable() as stopping, ExitStack() as stack:
        problem = None
        if cluster:
            problem = stack.enter_context(cluster(_say)).problem(experiment)
        runs = [kind(experiment, seed, workers, stopping, problem) for seed in seeds[:1]]
        stack.enter_context(claimed(folder, seeds, resume, force))
        processes = min(workers, len(seeds))
        if processes > 1 and runs[0].problem.native and not cluster:
            from botschool.evolution.side_by_side import Task, evolve_all

            share = workers // processes
            task = Task(
                kind, experiment, folder, share, steps, resume, generations, keep_every, terminal
            )
            return evolve_all(task, seeds, processes, stopping)
        finished = True
        for seed in seeds:
            run = runs.pop() if runs else kind(experiment, seed, workers, stopping, problem)
            with reporting(seed, terminal) as report:
                finished = evolve(run, folder, steps, resume, report, generations, keep_every)
            if text := run.ending(RunFiles(folder, seed), finished):
                print_lines([text])
            if not finished:
                break
        if problem and (lines := problem.report()):
            print_lines(lines)
    return finished


def _say(sentence: str) -> None:
    print_lines([sentence])
