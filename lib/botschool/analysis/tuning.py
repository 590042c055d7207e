"""Tune the hyperparameters of an experiment: many short evolutions, whose values Optuna chooses.

FOLDER/hopper/
  study.log     Optuna's journal of the trials, from which the same command continues
  best.ini      the experiment with the best values
  tuning.png    what each trial reached, and how much each hyperparameter matters

Trial 0 is the file as it is. docs/specification.md, "Tuning an evolution", has the rules.
"""

from __future__ import annotations

import json
import re
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from botschool.analysis.figure import COLOURS, new_figure
from botschool.config import Experiment, from_dict, to_dict
from botschool.errors import BotschoolError
from botschool.evolution.evaluate import mean
from botschool.evolution.progress import lasting
from botschool.evolution.run import Run
from botschool.inifile import nearest, shown
from botschool.output import save_bytes
from botschool.problems import Episodes, Interrupted
from botschool.rl.study import Log, complete, ended, run_trials
from botschool.terminal import readable, stoppable

if TYPE_CHECKING:
    from optuna import Study, Trial
    from optuna.trial import TrialState

SPACE = {
    "stepsize": Log(0.001, 0.1),
    "noiseStdDev": Log(0.005, 0.2),
    "mutrate": Log(0.005, 0.3),
    "sigma": Log(0.02, 1.0),
    "samplesize": (10, 20, 40),
    "wdecay": (0, 1),
}
"""Hyperparameters to tune where a file marks none: those of them that its algorithm has."""
REPORTS = 8
"""How often a run is measured, so that a trial without prospects ends early."""
EPISODES, FRESH = 20, 400_000
"""Episodes that measure a run's best robot, and what is added to the run's seed for them."""
IMPOSSIBLE = -1e9
"""Value of a trial whose values do not go together, or whose numbers grow without bound."""


@dataclass(frozen=True)
class Plan:
    """A tuning; only `trials` and `workers` may change when it continues."""

    experiment: Experiment
    folder: Path
    trials: int
    steps: int
    """Steps of each run."""
    seed: int
    seeds: int
    """Runs of each trial, with `seed` and the seeds after it; the trial's value is their mean."""
    workers: int

    @property
    def path(self) -> Path:
        """Return the folder of the tuning."""
        path = self.experiment.path
        return self.folder / (path.stem if path else "experiment")


def space_of(experiment: Experiment) -> dict[str, Any]:
    """Return hyperparameter -> values, from section [TUNE] or else SPACE. Raises BotschoolError."""
    known = {f.name.lower(): f.name for part in _tunable(experiment) for f in fields(part)}
    own = {f.name for f in fields(experiment.algo)}
    space: dict[str, Any] = {name: each for name, each in SPACE.items() if name in own}
    if experiment.tune:
        space = {}
    whole = _whole(experiment)
    for key, entry in experiment.tune.items():
        place = f"{experiment.path}, line {entry.line}"
        if key not in known:
            hint = nearest(entry.key, known.values())
            raise BotschoolError(f"{place}: {shown(entry.key)} is no hyperparameter; {hint}.")
        space[known[key]] = _values(str(entry.value), place)
        for value in _ends(space[known[key]]):
            number = round(value) if known[key] in whole and isinstance(value, float) else value
            changed(experiment, {known[key]: number}, place)
    if not space:
        raise BotschoolError(
            f"Nothing to tune for {experiment.exp.algo}: mark hyperparameters in a section [TUNE], "
            "as in nhiddens = 8, 16, 32 or stepsize = 0.001 .. 0.1 log."
        )
    return space


def _tunable(experiment: Experiment) -> tuple[Any, Any]:
    return experiment.algo, experiment.policy


def _whole(experiment: Experiment) -> set[str]:
    """Return the hyperparameters that are whole numbers."""
    parts = _tunable(experiment)
    return {f.name for part in parts for f in fields(part) if type(f.default) is int}


def _values(text: str, place: str) -> Any:
    number = r"([-+]?[0-9.]+(?:e[-+]?[0-9]+)?)"
    if found := re.fullmatch(rf"{number} *\.\. *{number}( +log)?", text.strip(), re.IGNORECASE):
        low, high = float(found[1]), float(found[2])
        if low < high and (low > 0 or not found[3]):
            return Log(low, high) if found[3] else [low, high]
    elif "," in text and (words := [word.strip() for word in text.split(",")]) and all(words):
        return tuple(words)
    raise BotschoolError(
        f"{place}: {shown(text)} is no choice of values: write 0.001 .. 0.1 log (any number "
        "between, on a logarithmic scale), 1 .. 5, or 8, 16, 32."
    )


def _ends(values: Any) -> tuple:
    return (values.low, values.high) if isinstance(values, Log) else tuple(values)


def changed(experiment: Experiment, given: dict[str, Any], place: str = "the trial") -> Experiment:
    """Return the experiment with other values of hyperparameters. Raises BotschoolError."""
    data = to_dict(experiment)
    for name, value in given.items():
        part = "algo" if name in data["algo"] else "policy"
        data[part][name] = value
    return from_dict(data, place)


def tune(
    plan: Plan,
    say: Callable[[str], None] = lambda line: None,
    stopping: Callable[[], bool] = lambda: False,
) -> bool:
    """Run trials up to the plan's number; return False if stopped. Raises BotschoolError."""
    experiment, space = plan.experiment, space_of(plan.experiment)
    if experiment.competitive:
        raise BotschoolError(
            f"{experiment.exp.algo} cannot be tuned: where two sides compete, fitness says little."
        )
    say(_expected(plan, space))
    options: dict[str, Any] = {"seed": plan.seed, "seeds": plan.seeds, "steps": plan.steps}
    options |= {"experiment": json.dumps(to_dict(experiment)), "space": str(space)}
    return run_trials(
        plan.path,
        plan.seed,
        plan.trials,
        options,
        space,
        lambda trial, given: _attempt(plan, trial, given, stopping),
        lambda study: _save(plan, study),
        say,
        stopping,
    )


def _expected(plan: Plan, space: dict[str, Any]) -> str:
    """Return a sentence about the tuning, with its time by the speed of a first generation."""
    run = Run(plan.experiment, plan.seed, plan.workers)
    try:
        run.advance()  # without it, the first steps of a process would count
        began, before = time.monotonic(), run.record.steps
        run.advance()
        seconds = (time.monotonic() - began) / (run.record.steps - before)
    finally:
        run.problem.close()
    whole = seconds * plan.steps * plan.seeds
    return (
        f"tuning {', '.join(space)} in {plan.path}: about {lasting(whole)} for each trial, at most "
        f"{lasting(whole * plan.trials)} in all"
    )


def _attempt(
    plan: Plan, trial: Trial, given: dict[str, Any], stopping: Callable[[], bool]
) -> tuple[float, TrialState]:
    """Return (mean return of the runs' best robots in fresh episodes, state of the trial)."""
    from optuna.trial import TrialState

    ends: list[float] = []
    whole = _whole(plan.experiment)
    for name in whole & given.keys():
        given[name] = round(float(given[name]))
    try:
        experiment = changed(plan.experiment, given)
    except BotschoolError:  # values that do not go together
        return IMPOSSIBLE, TrialState.PRUNED
    try:
        for seed in range(plan.seed, plan.seed + plan.seeds):
            run = Run(experiment, seed, plan.workers, stopping)
            value = 0.0
            for part in range(1, REPORTS + 1):
                value = _measured(run, part * plan.steps / REPORTS)
                trial.report(mean(np.array([*ends, value])), REPORTS * len(ends) + part)
                if trial.should_prune():
                    return mean(np.array([*ends, value])), TrialState.PRUNED
            ends.append(value)
    except Interrupted:
        return 0.0, TrialState.FAIL
    except BotschoolError as error:
        if "fitness cannot be measured" not in str(error):
            raise
        return IMPOSSIBLE, TrialState.PRUNED
    return mean(np.array(ends)), TrialState.COMPLETE


def _measured(run: Run, steps: float) -> float:
    """Evolve until this many steps; return the mean return of the best robot in fresh episodes."""
    try:
        while run.record.steps < steps or not run.record.generation:
            if run.stopping():
                raise Interrupted
            run.advance()
        genotype, normalisation = run.policy.split(run.record.bestg)
        asked = Episodes.of([run.seed + FRESH], EPISODES)
        found = run.problem.evaluate(
            run.policy, genotype[None], normalisation, asked, run.policy.config.post_steps,
            run.workers, run.stopping,
        )  # fmt: skip
        return mean(found.fitness)
    finally:
        run.problem.close()


def _save(plan: Plan, study: Study) -> None:
    """Write the best experiment and the picture."""
    done = complete(study)
    if not done:
        return
    best = study.best_trial
    comment = (
        f"# The best of {len(ended(study))} trials of botschool tune: mean return "
        f"{readable(best.value)} in {EPISODES} fresh episodes after {plan.steps} steps.\n"
        "# The best of many was lucky, too: compare it with the file on other seeds.\n"
    )
    text = comment + ini_text(changed(plan.experiment, best.user_attrs["given"]))
    save_bytes(plan.path / "best.ini", text.encode())
    with new_figure(plan.path / "tuning.png", height=3.8, width=10) as figure:
        left, right = figure.subplots(1, 2)
        _draw_trials(left, study)
        _draw_importance(right, study)
        figure.suptitle(f"{plan.experiment.exp.environment}, {plan.experiment.exp.algo}")


def ini_text(experiment: Experiment) -> str:
    """Return an experiment file with all values that are not the default."""
    lines = []
    for part in experiment.parts:
        config = getattr(experiment, part)
        lines.append(f"\n[{part.upper()}]")
        for f in fields(config):
            value = getattr(config, f.name)
            if value != f.default and value not in ("", None, ()):
                lines.append(f"{f.name} = {value}")
    return "\n".join(lines).lstrip("\n") + "\n"


def _draw_trials(axes: Any, study: Study) -> None:
    done = complete(study)
    numbers, values = [t.number for t in done], np.array([t.value for t in done])
    axes.plot(numbers, values, "o", color=COLOURS[0], mec="white", label="trial (0: the file)")
    best = np.maximum.accumulate(values)
    axes.plot(numbers, best, color=COLOURS[1], drawstyle="steps-post", label="best so far")
    axes.set(xlabel="trial", ylabel="mean return in fresh episodes")
    axes.xaxis.get_major_locator().set_params(integer=True)
    axes.grid(color="#DDDDDD", lw=0.6)
    axes.legend(frameon=False)


def _draw_importance(axes: Any, study: Study) -> None:
    importance = importances(study)
    names = list(importance)[::-1]
    axes.barh(names, [importance[name] for name in names], color=COLOURS[2], alpha=0.7)
    axes.set(xlabel="importance (PED-ANOVA)", xlim=(0, 1))
    if not names:
        axes.text(0.5, 0.5, "too few trials", ha="center", va="center", transform=axes.transAxes)
        axes.set_yticks([])


def importances(study: Study) -> dict[str, float]:
    """Return hyperparameter -> share of the differences that it explains; {} for too few trials."""
    import warnings

    from optuna.importance import PedAnovaImportanceEvaluator, get_param_importances

    if len(complete(study)) < 8:
        return {}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            return get_param_importances(study, evaluator=PedAnovaImportanceEvaluator())
        except (ValueError, RuntimeError, ZeroDivisionError):  # all trials are equal
            return {}


def tune_command(plan: Plan) -> bool:
    """Run `botschool tune`: print a line for each trial; return False if the user stopped it."""
    with stoppable() as stopping:
        done = tune(plan, lambda line: print(line, flush=True), stopping)
    best = plan.path / "best.ini"
    if not done:
        print("stopped: the same command continues.", file=sys.stderr)
    elif best.exists():
        print(f"best experiment: {best}   picture: {plan.path / 'tuning.png'}")
    return done
