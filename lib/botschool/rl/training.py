"""Train agents: one call turns settings into a folder with models and logs."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from botschool.errors import BotschoolError
from botschool.output import cannot_write
from botschool.rl.folder import Evaluations, RunFolder, next_folder
from botschool.rl.model import build, choose
from botschool.rl.native import training as native
from botschool.rl.native.choosing import tell_engine
from botschool.rl.parameters import parse, read_settings
from botschool.rl.policies import WITH_IMAGES
from botschool.rl.settings import Settings
from botschool.terminal import progress_bar, readable, stoppable

if TYPE_CHECKING:
    import gymnasium
    from stable_baselines3.common.base_class import BaseAlgorithm
    from stable_baselines3.common.vec_env import VecEnv

    from botschool.rl.callbacks import PostEvaluation

_NOT_FINITE = (
    "the network's outputs are no longer usable numbers, so lower learning_rate or max_grad_norm"
)
BREAKDOWNS = {
    "Expected parameter": _NOT_FINITE,  # torch, about the action's distribution
    "histogram is empty": _NOT_FINITE,  # TensorBoard, about advantages or actions
    "Unable to sample before the end": "no episode fits into the replay buffer, so give a larger "
    "buffer_size",
}
"""Messages of libraries when a training breaks down, and what to do."""


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
    wrappers: str = "",
    vec_env: str = "dummy",
    engine: str = "auto",
    report: Callable[[int, Evaluations], None] = lambda steps, evaluations: None,
) -> RunFolder:
    """Train an agent in folder/algo/env_N and return that folder.

    algo: one of botschool.rl.settings.ALGORITHMS. env: a Gymnasium id. params: hyperparameters by
    name. policy: mlp, lstm, cnn, cnnlstm or module:Class. wrappers: around the environment
    (botschool.wrappers). vec_env: subproc gives each environment a process (a script must then call
    this under `if __name__ == "__main__":`). engine: native, sb3, or auto, which is native for ppo
    on a native problem (botschool.rl.native). defaults.yaml replaces each None. The policy is
    post-evaluated `evaluations` times, each time on the same `episodes` fresh seeds; `report` is
    called with the steps and the post-evaluations so far. The same arguments give the same results
    on the same machine. Raises BotschoolError.
    """
    settings = choose(
        algo,
        env,
        policy,
        params,
        envs,
        steps,
        seed,
        evaluations,
        episodes,
        wrappers,
        vec_env,
        engine,
    )
    run, _ = learn(settings, Path(folder), report)
    return run


def learn(
    settings: Settings,
    folder: Path,
    report: Callable[[int, Evaluations], None],
    started: Callable[[RunFolder], None] = lambda run: None,
    stopping: Callable[[], bool] = lambda: False,
    events: Path | None = None,
    threads: int = 1,
    hurrying: Callable[[], bool] | None = None,
) -> tuple[RunFolder, Evaluations | None]:
    """Train with these settings in a new folder, and call `started` with it as soon as it exists.

    Saves everything and ends early when `stopping()` is true. Writes curves for TensorBoard to the
    folder, and to `events` if given. threads: for the native engine. hurrying: whether a user waits
    for the end, so that a long post-evaluation is left out; None: as `stopping`. Return no
    post-evaluations if the first one was left out. Raises BotschoolError.
    """
    if settings.engine == "native":
        return native.learn(settings, folder, report, started, stopping, events, threads)
    from botschool.rl.callbacks import PostEvaluation

    with _one_thread(settings), _training_env(settings) as env:
        model = build(settings, env)
        run = next_folder(folder, settings.algo, settings.env)
        settings.save(run.config)
        started(run)
        watching = PostEvaluation(run, settings, report, stopping, hurrying or stopping)
        try:
            _learn(model, watching, events)
        except BotschoolError:
            if watching.found is not None:
                with suppress(BotschoolError):
                    watching.save()
            raise
        finally:
            watching.close()
    return run, watching.found


def _learn(model: BaseAlgorithm, watching: PostEvaluation, events: Path | None) -> None:
    from stable_baselines3.common.logger import TensorBoardOutputFormat, configure

    from botschool.rl.callbacks import Indicators, Patience, Stopped

    folder, algo = watching.run.path, watching.settings.algo
    # ars reports whole episodes only
    steps = [] if algo == "ars" else [Indicators()]
    steps += [Patience()] if algo == "her" else []
    try:
        model.set_logger(configure(str(folder), ["csv", "tensorboard"]))
        if events is not None:
            model.logger.output_formats.append(TensorBoardOutputFormat(str(events / folder.name)))
        try:
            model.learn(watching.settings.steps, callback=[*steps, watching])
        except Stopped:
            watching.on_training_end()
        model.logger.close()
    except OSError as error:
        raise cannot_write(folder, error.strerror or str(error)) from error
    except (ValueError, RuntimeError) as error:
        for message, remedy in BREAKDOWNS.items():
            if message in str(error):
                raise BotschoolError(
                    f"The training in {folder} broke down after {model.num_timesteps} steps: "
                    f"{remedy}."
                ) from error
        raise


@contextmanager
def _training_env(settings: Settings) -> Iterator[VecEnv]:
    """Yield `envs` seeded environments whose returns are recorded."""
    from stable_baselines3.common.vec_env import DummyVecEnv, VecNormalize

    from botschool.rl.processes import ProcessVecEnv

    kind = DummyVecEnv if settings.vec_env == "dummy" else ProcessVecEnv
    names = (settings.env, settings.wrappers, settings.training_wrappers)
    env = kind([partial(_monitored, *names, **settings.own)] * settings.envs)
    env.seed(settings.seed)
    if settings.normalize:
        env = VecNormalize(env, gamma=settings.parameters.get("gamma", 0.99))
    try:
        yield env
    finally:
        env.close()


def _monitored(name: str, wrappers: str, training_wrappers: str, **own: str) -> gymnasium.Env:
    from stable_baselines3.common.monitor import Monitor

    from botschool.rl.environments import Brief, make
    from botschool.wrappers import parse

    env = Monitor(Brief(make(name, wrappers, **own)))
    for wrapper in parse(training_wrappers):
        env = wrapper.around(env, name)
    return env


@contextmanager
def _one_thread(settings: Settings) -> Iterator[None]:
    """Use one torch thread: it is fastest for small networks. Images use more threads."""
    import torch

    before = torch.get_num_threads()
    if settings.policy not in WITH_IMAGES:
        torch.set_num_threads(1)
    try:
        yield
    finally:
        torch.set_num_threads(before)


@contextmanager
def reporting(
    budget: int, seed: int, terminal: bool
) -> Iterator[Callable[[int, Evaluations], None]]:
    """Yield a function to call with the steps and the post-evaluations so far."""
    if terminal:
        with progress_bar(seed) as show:
            yield lambda steps, evaluations: show(steps / budget, steps, 3, reached(evaluations))
        return
    printed = 0

    def line(steps: int, evaluations: Evaluations) -> None:
        nonlocal printed
        if len(evaluations.steps) > printed:
            printed = len(evaluations.steps)
            percent = min(100.0, 100 * steps / budget)
            print(
                f"seed {seed}  steps {steps} ({percent:.0f}%)  {reached(evaluations)}", flush=True
            )

    yield line


def reached(evaluations: Evaluations) -> str:
    sd = evaluations.returns[-1].std()
    return (
        f"post-evaluated {readable(evaluations.last)} \u00b1 {readable(sd)}  "
        f"best so far {readable(evaluations.best)}"
    )


def train_command(
    algo: str,
    env: str,
    params: list[str],
    folder: Path,
    terminal: bool,
    events: Path | None = None,
    file: Path | None = None,
    replications: int = 1,
    workers: int = 1,
    **options: Any,
) -> bool:
    """Run `botschool rl train`: print progress and result; return False if the user stopped it."""
    chosen = (read_settings(file) if file else {}) | parse(params)
    settings = choose(algo, env, params=chosen, **options)
    if options.get("engine") != "sb3":
        tell_engine(settings)
    if workers > 1 and settings.engine != "native":
        raise BotschoolError(
            "-w is for the native engine; with Stable-Baselines3, use --vec-env subproc."
        )
    several = [replace(settings, seed=settings.seed + i) for i in range(replications)]
    together = min(workers, replications)

    def one(settings: Settings, stopping: Callable[[], bool]) -> None:
        if stopping():
            return

        def started(run: RunFolder) -> None:
            print(f"training {settings.algo} on {settings.env} in {run.path}", flush=True)

        with reporting(settings.steps, settings.seed, terminal and together == 1) as report:
            threads = max(1, workers // together)
            run, found = learn(settings, folder, report, started, stopping, events, threads)
        _print_result(run, found, settings)

    with stoppable() as stopping:
        if together == 1:
            for each in several:
                one(each, stopping)
        else:
            with ThreadPoolExecutor(together) as pool:
                list(pool.map(lambda each: one(each, stopping), several))
        return not stopping()


def resume_command(folder: Path, workers: int, terminal: bool) -> bool:
    """Run `botschool rl train --resume`: continue a native training."""
    run = RunFolder(folder)
    settings = run.settings()
    if settings.engine != "native":
        raise BotschoolError(
            f"{folder} was trained by Stable-Baselines3, whose trainings cannot continue: "
            "train again."
        )
    with stoppable() as stopping:
        with reporting(settings.steps, settings.seed, terminal) as report:
            found = native.resume(run, report, stopping, workers)
        _print_result(run, found, settings)
        return not stopping()


def _print_result(run: RunFolder, found: Evaluations | None, settings: Settings) -> None:
    if found is None:
        print(f"stopped during the first post-evaluation; last model: {run.last}", flush=True)
        return
    stopped = found.steps[-1] < settings.steps
    again = f"; to continue: botschool rl train --resume {run.path}"
    print(
        f"{'stopped' if stopped else 'finished'} after {found.steps[-1]} steps: best "
        f"post-evaluated {readable(found.best)}, last {readable(found.last)}; best model: "
        f"{run.best}" + (again if stopped and settings.engine == "native" else ""),
        flush=True,
    )
