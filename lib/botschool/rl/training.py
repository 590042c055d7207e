"""Training: one call from settings to a folder with models and logs."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from botschool.errors import BotschoolError
from botschool.output import cannot_write
from botschool.rl.folder import Evaluations, RunFolder, next_folder
from botschool.rl.model import build, choose
from botschool.rl.parameters import parse
from botschool.rl.progress import reporting
from botschool.rl.settings import Settings
from botschool.terminal import stoppable

if TYPE_CHECKING:
    from stable_baselines3.common.base_class import BaseAlgorithm
    from stable_baselines3.common.vec_env import VecEnv

    from botschool.rl.callbacks import PostEvaluation


def train(
    algo: str,
    env: str,
    folder: Path | str = "results/rl",
    *,
    params: dict[str, Any] | None = None,
    policy: str | None = None,
    envs: int | None = None,
    steps: int | None = None,
    seed: int = 1,
    evaluations: int = 20,
    episodes: int = 20,
    report: Callable[[int, Evaluations], None] = lambda steps, evaluations: None,
) -> RunFolder:
    """Trains an agent in folder/algo/env_N and gives that folder.

    algo: ppo, a2c, sac, td3 or dqn; env: a Gymnasium id; params: hyperparameters by name. What is
    None comes from defaults.yaml. The policy is post-evaluated `evaluations` times, each time on
    the same `episodes` fresh seeds; `report` is called with the steps and the post-evaluations so
    far. The same arguments give the same results on the same machine. Raises BotschoolError.
    """
    settings = choose(algo, env, policy, params, envs, steps, seed, evaluations, episodes)
    run, _ = learn(settings, Path(folder), report)
    return run


def learn(
    settings: Settings,
    folder: Path,
    report: Callable[[int, Evaluations], None],
    started: Callable[[RunFolder], None] = lambda run: None,
    stopping: Callable[[], bool] = lambda: False,
) -> tuple[RunFolder, Evaluations]:
    """Trains with these settings in a new folder; `started` is told which as soon as it exists.

    Ends early, all saved, when `stopping()` is true. Raises BotschoolError.
    """
    from botschool.rl.callbacks import PostEvaluation

    with _one_thread(settings), _training_env(settings) as env:
        model = build(settings, env)
        run = next_folder(folder, settings.algo, settings.env)
        settings.save(run.config)
        started(run)
        watching = PostEvaluation(run, settings, report, stopping)
        try:
            _learn(model, watching)
        except BotschoolError:
            if watching.found is not None:
                with suppress(BotschoolError):
                    watching.save()
            raise
        finally:
            watching.close()
    return run, watching.found


def _learn(model: BaseAlgorithm, watching: PostEvaluation) -> None:
    from stable_baselines3.common.logger import configure

    from botschool.rl.callbacks import Indicators

    folder = watching.run.path
    try:
        model.set_logger(configure(str(folder), ["csv", "tensorboard"]))
        model.learn(watching.settings.steps, callback=[Indicators(), watching])
        model.logger.close()
    except OSError as error:
        raise cannot_write(folder, error.strerror or str(error)) from error
    except ValueError as error:
        if "Expected parameter" not in str(error):  # of the action's distribution, by torch
            raise
        raise BotschoolError(
            f"The training in {folder} broke down after {model.num_timesteps} steps: the network's "
            "outputs are no longer usable numbers, so lower learning_rate or max_grad_norm."
        ) from error


@contextmanager
def _training_env(settings: Settings) -> Iterator[VecEnv]:
    """`envs` environments in this process, seeded, with their returns monitored."""
    from stable_baselines3.common.monitor import Monitor
    from stable_baselines3.common.vec_env import DummyVecEnv, VecNormalize

    from botschool.rl.environments import make

    env = DummyVecEnv([lambda: Monitor(make(settings.env))] * settings.envs)
    env.seed(settings.seed)
    if settings.normalize:
        env = VecNormalize(env, gamma=settings.parameters.get("gamma", 0.99))
    try:
        yield env
    finally:
        env.close()


@contextmanager
def _one_thread(settings: Settings) -> Iterator[None]:
    """Networks this small are trained fastest by one thread; images deserve more."""
    import torch

    before = torch.get_num_threads()
    if settings.policy != "cnn":
        torch.set_num_threads(1)
    try:
        yield
    finally:
        torch.set_num_threads(before)


def train_command(
    algo: str,
    env: str,
    params: list[str],
    folder: Path,
    terminal: bool,
    **options: Any,
) -> bool:
    """`botschool rl train`: prints progress and result; False when the user stopped it."""
    settings = choose(algo, env, params=parse(params), **options)

    def started(run: RunFolder) -> None:
        print(f"training {settings.algo} on {settings.env} in {run.path}", flush=True)

    with stoppable() as stopping:
        with reporting(settings.steps, settings.seed, terminal) as report:
            run, found = learn(settings, folder, report, started, stopping)
        stopped = stopping()
    print(
        f"{'stopped' if stopped else 'finished'} after {found.steps[-1]} steps: best "
        f"post-evaluated {found.best:.2f}, last {found.last:.2f}; best model: {run.best}"
    )
    return not stopped
