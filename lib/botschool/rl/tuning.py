"""Tune hyperparameters: many short trainings with values that Optuna chooses (Akiba 2019).

FOLDER/tune/ppo/CartPole-v1/
  study.log     Optuna's journal of the trials, from which the same command continues
  best.yaml     the hyperparameters of the best trial, for `botschool rl train --settings`
  trials/       the trainings

Trial 0 is the starting point: the entry of defaults.yaml.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import yaml

from botschool.errors import BotschoolError
from botschool.output import save_bytes
from botschool.problems.native import gym_id
from botschool.rl.folder import Evaluations, name_of
from botschool.rl.model import choose
from botschool.rl.native.choosing import tell_engine
from botschool.rl.study import Log, complete, ended, run_trials
from botschool.rl.training import learn
from botschool.terminal import readable, stoppable

if TYPE_CHECKING:
    from optuna import Study, Trial
    from optuna.trial import TrialState

LEARNING = {
    "learning_rate": Log(1e-5, 1e-2),
    "gamma": (0.9, 0.95, 0.98, 0.99, 0.995, 0.999),
    "net_arch": ("[64, 64]", "[256, 256]"),
}
ON_POLICY = LEARNING | {
    "n_steps": (16, 32, 64, 128, 256, 512, 1024),
    "gae_lambda": (0.8, 0.9, 0.95, 0.98, 1.0),
}
GRADIENT = {"ent_coef": Log(1e-8, 0.1), "max_grad_norm": (0.3, 0.5, 1.0, 2.0, 5.0)}
BATCH = {"batch_size": (32, 64, 128, 256)}
OFF_POLICY = LEARNING | BATCH | {"tau": (0.001, 0.005, 0.01, 0.02), "train_freq": (1, 4, 8, 16)}
VALUES = LEARNING | BATCH | {
    "train_freq": (1, 4, 8, 16, 128),
    "target_update_interval": (10, 100, 1000, 5000),
    "exploration_fraction": (0.1, 0.2, 0.3, 0.5),
    "exploration_final_eps": (0.01, 0.04, 0.1),
}  # fmt: skip
SPACES: Mapping[str, Mapping[str, Any]] = {
    "ppo": ON_POLICY | GRADIENT | BATCH | {
        "n_epochs": (1, 4, 10, 20), "clip_range": (0.1, 0.2, 0.3, 0.4)},
    "a2c": ON_POLICY | GRADIENT,
    "trpo": ON_POLICY | BATCH | {"target_kl": (0.001, 0.01, 0.03), "n_critic_updates": (5, 10, 20)},
    **dict.fromkeys(("sac", "td3", "ddpg", "tqc"), OFF_POLICY),
    "her": {**LEARNING, **BATCH, "n_sampled_goal": (2, 4, 8)},
    **dict.fromkeys(("dqn", "qrdqn"), VALUES),
    "ars": {
        "learning_rate": Log(1e-3, 0.5), "delta_std": Log(0.005, 0.5), "n_delta": (2, 4, 8, 16)},
}  # fmt: skip
"""Search space of each algorithm: for each hyperparameter a list of values, or a range."""


@dataclass(frozen=True)
class Plan:
    """A tuning; only `trials` may change when it continues."""

    algo: str
    env: str
    folder: Path
    trials: int
    options: Mapping[str, Any]
    """steps, envs, seed, evaluations, episodes and wrappers of each training, as in `choose`."""
    seeds: int = 1
    """Trainings per trial, with `seed` and the seeds after it; the trial's value is their mean."""

    @property
    def path(self) -> Path:
        """Return the folder of the tuning."""
        return self.folder / "tune" / self.algo / name_of(gym_id(self.env))

    @property
    def best(self) -> Path:
        """Return the file with the best hyperparameters."""
        return self.path / "best.yaml"


def tune(
    plan: Plan,
    say: Callable[[str], None] = lambda line: None,
    stopping: Callable[[], bool] = lambda: False,
) -> bool:
    """Run trials up to the plan's number; return False if stopped. Raises BotschoolError."""
    choose(plan.algo, plan.env, **plan.options)  # refuse now what no trial could train

    def attempt(trial: Trial, given: dict[str, Any]) -> tuple[float, TrialState]:
        if "net_arch" in given:
            given["net_arch"] = yaml.safe_load(given["net_arch"])
        return _train(plan, trial, given, stopping)

    return run_trials(
        plan.path,
        plan.options["seed"],
        plan.trials,
        {**plan.options, "seeds": plan.seeds},
        SPACES[plan.algo],
        attempt,
        lambda study: _save_best(plan, study),
        say,
        stopping,
    )


def _train(plan: Plan, trial: Trial, given: dict[str, Any], stopping: Callable[[], bool]):
    """Return (mean return of the trainings' last post-evaluations, state of the trial)."""
    from optuna.trial import TrialState

    pruned, reports, ends = False, 0, []

    def reporter() -> Callable[[int, Evaluations], None]:
        seen = 0

        def report(steps: int, found: Evaluations) -> None:
            nonlocal pruned, reports, seen
            while seen < len(found.steps):
                known = [*ends, float(found.returns[seen].mean())]
                trial.report(sum(known) / len(known), reports)
                seen, reports = seen + 1, reports + 1
                pruned = pruned or trial.should_prune()

        return report

    for seed in range(plan.options["seed"], plan.options["seed"] + plan.seeds):
        settings = choose(plan.algo, plan.env, params=given, **{**plan.options, "seed": seed})
        report = reporter()
        try:
            _, found = learn(
                settings,
                plan.path / "trials",
                report,
                stopping=lambda: pruned or stopping(),
                hurrying=stopping,
            )
        except BotschoolError as error:
            if "broke down" not in str(error):
                raise
            return -1e9, TrialState.PRUNED  # its numbers have overflowed
        if found is None:
            return 0.0, TrialState.FAIL
        report(0, found)
        ends.append(found.last)
        if pruned or stopping():
            break
    state = TrialState.PRUNED if pruned else TrialState.COMPLETE
    return sum(ends) / len(ends), state


def _save_best(plan: Plan, study: Study) -> None:
    if not complete(study):
        return
    best = study.best_trial
    text = (
        f"# {plan.algo} on {plan.env}: the best of {len(ended(study))} trials, with "
        f"{readable(best.value)} in its last post-evaluation.\n"
        + (yaml.safe_dump(best.user_attrs["given"], sort_keys=False, default_flow_style=None))
    )
    save_bytes(plan.best, text.encode())


def tune_command(plan: Plan) -> bool:
    """Run `botschool rl tune`: print a line for each trial; return False if the user stopped it."""
    print(f"tuning {plan.algo} on {plan.env} in {plan.path}", flush=True)
    tell_engine(choose(plan.algo, plan.env, **plan.options))
    with stoppable() as stopping:
        done = tune(plan, lambda line: print(line, flush=True), stopping)
    if not done:
        print("stopped: the same command continues.", file=sys.stderr)
    elif plan.best.exists():
        print(
            f"best hyperparameters: {plan.best} (botschool rl train --algo {plan.algo} --env "
            f"{plan.env} --settings {plan.best})"
        )
    return done
