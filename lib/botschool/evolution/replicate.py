"""Several runs of one experiment, with consecutive seeds."""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path

from botschool.config import Experiment
from botschool.errors import BotschoolError
from botschool.evolution.coevolution import Coevolution
from botschool.evolution.progress import print_lines, reporting
from botschool.evolution.record import RunFiles, claimed
from botschool.evolution.run import Options, Run
from botschool.terminal import stoppable


def replicate(experiment: Experiment, seeds: list[int], folder: Path, options: Options) -> bool:
    """Run every seed and print where the results are; return False when the user stopped it.

    Several runs of a native problem share the workers: they run side by side, each on as many
    workers as there are for it. Everything else runs one after another, each on all workers; so
    do all runs on a cluster.
    """
    kind = Coevolution if experiment.competitive else Run
    if options.keep_every and kind is Coevolution:
        raise BotschoolError(
            "--keep-every is for one population: the files of a co-evolution keep populations "
            "every saveeach generations, so set that."
        )
    with stoppable() as stopping, ExitStack() as stack:
        problem = None
        if options.cluster:
            problem = stack.enter_context(options.cluster(_say)).problem(experiment)
        runs = [kind(experiment, seed, options.workers, stopping, problem) for seed in seeds[:1]]
        stack.enter_context(claimed(folder, seeds, options.resume, options.force))
        processes = min(options.workers, len(seeds))
        if processes > 1 and runs[0].problem.native and not problem:
            from botschool.evolution.side_by_side import Task, evolve_all

            share = replace(options, workers=options.workers // processes)
            return evolve_all(Task(kind, experiment, folder, share), seeds, processes, stopping)
        finished = True
        for seed in seeds:
            run = runs.pop() if runs else kind(experiment, seed, options.workers, stopping, problem)
            with reporting(seed, options.terminal) as report:
                finished = options.evolve(run, folder, report)
            if text := run.ending(RunFiles(folder, seed), finished):
                print_lines([text])
            if not finished:
                break
        if problem and (lines := problem.report()):
            print_lines(lines)
    return finished


def _say(sentence: str) -> None:
    print_lines([sentence])
