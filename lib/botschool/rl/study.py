"""Let Optuna (Akiba 2019) choose the values of trials; a study in a folder continues.

A trial's choices depend only on the seed and on the trials before it, so an interrupted study ends
like an uninterrupted one. Trial 0 is the starting point.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from botschool.errors import BotschoolError
from botschool.inifile import shown
from botschool.lock import locked
from botschool.output import cannot_write
from botschool.rl.model import require
from botschool.terminal import readable

if TYPE_CHECKING:
    from optuna import Study, Trial
    from optuna.trial import TrialState

STARTUP = 5
"""Random trials at the start, which are never pruned."""


@dataclass(frozen=True)
class Log:
    """Any number between two limits, uniform on a logarithmic scale."""

    low: float
    high: float


Attempt = Callable[["Trial", dict[str, Any]], "tuple[float, TrialState]"]
"""Tries the chosen values; returns what they reach, and the state of the trial."""


def run_trials(
    folder: Path,
    seed: int,
    trials: int,
    options: Mapping[str, Any],
    space: Mapping[str, Any],
    attempt: Attempt,
    better: Callable[[Study], None],
    say: Callable[[str], None],
    stopping: Callable[[], bool],
) -> bool:
    """Run trials up to this number; return False if stopped. Raises BotschoolError.

    options: must be the same when the study continues. space: hyperparameter -> Log, (low, high) as
    a range, or a tuple of more values. better: called after each trial.
    """
    require("optuna")
    import optuna

    optuna.logging.set_verbosity(optuna.logging.ERROR)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise cannot_write(folder, error.strerror or str(error)) from error
    states = optuna.trial.TrialState
    with locked(folder, "the tuning"):
        study = open_study(folder, seed, 0)
        _check_same(study, options, folder)
        for trial in study.get_trials(states=[states.RUNNING]):
            study.tell(trial.number, state=states.FAIL)  # it was interrupted
        while (number := len(ended(study))) < trials:
            study = open_study(folder, seed, number)
            trial = study.ask()
            given = choices(space, trial) if number else {}
            value, state = attempt(trial, given)
            if stopping():
                study.tell(trial, state=states.FAIL)
                return False
            trial.set_user_attr("given", given)
            study.tell(trial, value if state == states.COMPLETE else None, state)
            how = "" if state == states.COMPLETE else ", broken off"
            told = " ".join(f"{name}={_short(each)}" for name, each in given.items())
            say(f"trial {number}: {readable(value)}{how}  ({told or 'the start'})")
            better(study)
    return True


def open_study(folder: Path, seed: int, number: int) -> Study:
    """Return the study, with a sampler for its trial `number`."""
    import optuna
    from optuna.storages.journal import JournalFileBackend

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", optuna.exceptions.ExperimentalWarning)
        journal = JournalFileBackend(str(folder / "study.log"), lock_obj=Unlocked())
        storage = optuna.storages.JournalStorage(journal)
        return optuna.create_study(
            study_name="tune",
            storage=storage,
            load_if_exists=True,
            direction="maximize",
            sampler=optuna.samplers.TPESampler(seed=1000 * seed + number, n_startup_trials=STARTUP),
            pruner=optuna.pruners.MedianPruner(n_startup_trials=STARTUP, n_warmup_steps=1),
        )


class Unlocked:
    """A lock of Optuna's journal that is always free: `locked(folder)` keeps others away, and a
    lock of Optuna's own would outlive a killed process.
    """

    def acquire(self) -> bool:
        """Take it."""
        return True

    def release(self) -> None:
        """Give it back."""


def ended(study: Study) -> list:
    """Return the trials that have a result."""
    from optuna.trial import TrialState

    return study.get_trials(states=[TrialState.COMPLETE, TrialState.PRUNED])


def complete(study: Study) -> list:
    """Return the trials that were not broken off."""
    from optuna.trial import TrialState

    return study.get_trials(states=[TrialState.COMPLETE])


def choices(space: Mapping[str, Any], trial: Trial) -> dict[str, Any]:
    """Return a value for each hyperparameter of a search space."""
    given = {}
    for name, values in space.items():
        if isinstance(values, Log):
            given[name] = trial.suggest_float(name, values.low, values.high, log=True)
        elif isinstance(values, range):
            given[name] = trial.suggest_int(name, values[0], values[-1])
        elif isinstance(values, list):
            given[name] = trial.suggest_float(name, *values)
        else:
            given[name] = trial.suggest_categorical(name, values)
    return given


def _check_same(study: Study, options: Mapping[str, Any], folder: Path) -> None:
    before = {"seeds": 1, **study.user_attrs.get("options", options)}
    for name, value in options.items():
        if before.get(name) != value:
            raise BotschoolError(
                f"{folder} is a tuning with {name} = {shown(before.get(name))}, not "
                f"{shown(value)}: change it back to continue, or choose another folder (-o)."
            )
    study.set_user_attr("options", dict(options))


def _short(value: Any) -> str:
    return f"{value:.3g}" if isinstance(value, float) else str(value).replace(" ", "")
