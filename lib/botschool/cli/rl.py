"""Define `botschool rl`: one short function per subcommand."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated, Any

import typer

UsageError: Any = typer.BadParameter.__base__  # from Typer's own click or the installed one
app = typer.Typer(
    no_args_is_help=True,
    rich_markup_mode="markdown",
)


def _explain(wanted: bool) -> None:
    if not wanted:
        return
    from rich.markup import escape
    from rich.table import Table

    from botschool.console import Console
    from botschool.rl.explained import EXPLAINED, OF

    console = Console()
    for group, algorithms in OF.items():
        table = Table("Hyperparameter", "Default", "What it does", "Where it matters")
        table.title = f"Of {algorithms}"
        for of, *row in EXPLAINED:
            if of == group:
                table.add_row(*map(escape, row))
        console.print(table)
    console.print(
        "Many problems have defaults of their own: lib/botschool/rl/defaults.yaml. To change some: "
        "botschool rl train --algo ppo --env CartPole-v1 --params gamma=0.9 n_epochs=5",
        markup=False,
    )
    raise typer.Exit


@app.callback(epilog="Example: botschool rl --explain")
def rl(
    explain: Annotated[
        bool,
        typer.Option(
            "--explain", callback=_explain, is_eager=True, help="Explain each hyperparameter."
        ),
    ] = False,
) -> None:
    """Train agents by reinforcement learning (Stable-Baselines3), and watch them."""


RlFolder = Annotated[
    Path, typer.Option("-o", "--output", help="Folder of the trainings.", metavar="FOLDER")
]
RlFolderF = Annotated[
    Path,
    typer.Option("-o", "--output", "-f", help="Folder of the trainings.", metavar="FOLDER"),
]
RlAlgo = Annotated[
    str | None,
    typer.Option(help="With --env: choose the training of this algorithm on it.", metavar="NAME"),
]
RlNumber = Annotated[
    int,
    typer.Option("--exp-id", min=0, help="With --algo: the training's number; 0 is the newest."),
]
RlBest = Annotated[
    bool, typer.Option("--load-best", help="Use the best model, as by default.", hidden=True)
]
RlRun = Annotated[
    Path | None,
    typer.Argument(
        help="Folder of a training, or a model in it (.zip); default: the newest.",
        show_default=False,
        metavar="RUN",
    ),
]
RlEnv = Annotated[str | None, typer.Option(help="Play in another environment.", metavar="ID")]
RlEpisodes = Annotated[int, typer.Option(min=1, max=1_000_000, help="Episodes to play.")]
RlSeed = Annotated[int, typer.Option("-s", "--seed", min=0, max=2**31, help="Seed.")]
RlLast = Annotated[bool, typer.Option("--last", help="Use the last model instead of the best one.")]

RlPolicy = Annotated[
    str | None,
    typer.Option(
        help="The agent's policy, if it is a class of your own; the command runs its code.",
        metavar="MODULE:CLASS",
    ),
]

RlBeside = Annotated[
    Path | None,
    typer.Option(help="Show an evolved robot of this experiment beside it.", metavar="FILE.ini"),
]
RlGenotype = Annotated[
    Path | None,
    typer.Option("-g", "--genotype", help="With --beside: the robot.", metavar="FILE.npy"),
]


@app.command(
    "train",
    epilog="Example: botschool rl train --algo ppo --env CartPole-v1 --params gamma=0.9 n_epochs=5",
)
def rl_train(
    algo: Annotated[
        str | None,
        typer.Option(
            help="ppo, a2c, trpo, ars, sac, td3, ddpg, tqc, her, dqn or qrdqn.", metavar="NAME"
        ),
    ] = None,
    env: Annotated[str | None, typer.Option(help="A Gymnasium id.", metavar="ID")] = None,
    params: Annotated[
        list[str] | None,
        typer.Option(
            "--params",
            "-params",
            "--hyperparameters",
            "--hyperparams",
            help="Hyperparameters; several may follow.",
            metavar="KEY=VALUE ...",
        ),
    ] = None,
    more: Annotated[list[str] | None, typer.Argument(hidden=True, metavar="")] = None,
    policy: Annotated[
        str | None,
        typer.Option(
            help="mlp, lstm, cnn, cnnlstm, or module:Class of your own.",
            metavar="NAME",
            show_default="cnn for images",
        ),
    ] = None,
    envs: Annotated[
        int | None, typer.Option(min=1, max=1024, help="Environments side by side.")
    ] = None,
    steps: Annotated[
        int | None,
        typer.Option("--steps", "-n", "--n-timesteps", min=1, max=10**12, help="Steps to train."),
    ] = None,
    wrapper: Annotated[
        list[str] | None,
        typer.Option(
            help="A wrapper around the environment, such as FlattenObservation or module:Class; "
            "repeat the option for several (none: without the default wrappers of Atari "
            "games).",
            metavar="NAME",
        ),
    ] = None,
    vec_env: Annotated[
        str,
        typer.Option(
            help="Where the environments run: dummy (all in one process) or subproc (one process "
            "each).",
            metavar="KIND",
        ),
    ] = "dummy",
    seed: RlSeed = 1,
    evaluations: Annotated[
        int, typer.Option(min=1, max=100_000, help="Post-evaluations during the training.")
    ] = 20,
    episodes: Annotated[
        int, typer.Option(min=1, max=10_000, help="Episodes of each post-evaluation.")
    ] = 20,
    output: RlFolderF = Path("results/rl"),
    events: Annotated[
        Path | None,
        typer.Option(
            "-tb",
            "--tensorboard-log",
            help="Also write the curves for TensorBoard to this folder.",
            metavar="FOLDER",
        ),
    ] = None,
    settings: Annotated[
        Path | None,
        typer.Option(help="A file of hyperparameters that `rl tune` has written.", metavar="FILE"),
    ] = None,
    engine: Annotated[
        str,
        typer.Option(
            help="native (C++, for ppo on native problems), sb3 (Stable-Baselines3), or auto: "
            "native where possible.",
            metavar="NAME",
        ),
    ] = "auto",
    replications: Annotated[
        int,
        typer.Option(
            "-r",
            "--replications",
            min=1,
            max=1000,
            help="Number of trainings, with consecutive seeds.",
        ),
    ] = 1,
    workers: Annotated[
        int,
        typer.Option("-w", "--workers", min=1, max=1024, help="Threads of the native engine."),
    ] = 1,
    resume: Annotated[
        Path | None,
        typer.Option(help="Continue a training of the native engine.", metavar="FOLDER"),
    ] = None,
    reward: Annotated[
        str, typer.Option(help="Instead of a native problem's reward.", metavar="EXPRESSION")
    ] = "",
    ends: Annotated[
        str, typer.Option(help="Instead of its end of an episode.", metavar="EXPRESSION")
    ] = "",
    physics: Annotated[
        str, typer.Option(help="Of a runner's world: gravity=3.7, ...", metavar="NUMBERS")
    ] = "",
) -> None:
    """Train an agent in a new folder; defaults depend on algorithm and environment."""
    from botschool.rl.training import resume_command, train_command

    if resume is not None:
        if not resume_command(resume, workers, sys.stdout.isatty()):
            raise typer.Exit(130)
        return
    for name, value in (("--algo", algo), ("--env", env)):
        if value is None:
            raise UsageError(f"Missing option '{name}'.")
    items = [*(params or []), *(more or [])]
    options: dict[str, Any] = {"policy": policy, "envs": envs, "steps": steps, "seed": seed}
    options |= {"evaluations": evaluations, "episodes": episodes}
    options |= {"wrappers": ", ".join(wrapper or []), "vec_env": vec_env, "engine": engine}
    options |= {"replications": replications, "workers": workers}
    options |= {"own": {"reward": reward, "ends": ends, "physics": physics}}
    terminal = sys.stdout.isatty()
    if not train_command(algo, env, items, output, terminal, events, settings, **options):
        raise typer.Exit(130)


@app.command(
    "tune", epilog="Example: botschool rl tune --algo ppo --env CartPole-v1 --trials 30 -n 20000"
)
def rl_tune(
    algo: Annotated[str, typer.Option(help="As in `rl train`.", metavar="NAME")],
    env: Annotated[str, typer.Option(help="A Gymnasium id.", metavar="ID")],
    trials: Annotated[int, typer.Option(min=1, max=100_000, help="Trainings to try.")] = 20,
    steps: Annotated[
        int | None,
        typer.Option("--steps", "-n", "--n-timesteps", min=1, help="Steps of each training."),
    ] = None,
    envs: Annotated[
        int | None, typer.Option(min=1, max=1024, help="Environments side by side.")
    ] = None,
    wrapper: Annotated[
        list[str] | None, typer.Option(help="As in `rl train`.", metavar="NAME")
    ] = None,
    seed: RlSeed = 1,
    seeds: Annotated[
        int,
        typer.Option(
            min=1,
            max=1000,
            help="Trainings per trial, with seeds from --seed on; their mean counts.",
        ),
    ] = 1,
    evaluations: Annotated[
        int, typer.Option(min=1, max=1000, help="Post-evaluations of each training.")
    ] = 8,
    episodes: Annotated[
        int, typer.Option(min=1, max=10_000, help="Episodes of each post-evaluation.")
    ] = 20,
    output: RlFolderF = Path("results/rl"),
) -> None:
    """Search for better hyperparameters by many trainings (Optuna); repeat the command to
    continue.
    """
    from botschool.rl.settings import check_algorithm
    from botschool.rl.tuning import Plan, tune_command

    options = {"steps": steps, "envs": envs, "seed": seed, "wrappers": ", ".join(wrapper or [])}
    options |= {"evaluations": evaluations, "episodes": episodes}
    if not tune_command(Plan(check_algorithm(algo), env, output, trials, options, seeds)):
        raise typer.Exit(130)


@app.command("enjoy", epilog="Example: botschool rl enjoy results/rl/ppo/CartPole-v1_1")
def rl_enjoy(
    run: RlRun = None,
    env: RlEnv = None,
    episodes: RlEpisodes = 10,
    seed: RlSeed = 1,
    render: Annotated[
        str | None, typer.Option(help="human (a window) or none.", metavar="MODE")
    ] = None,
    last: RlLast = False,
    output: RlFolderF = Path("results/rl"),
    algo: RlAlgo = None,
    exp_id: RlNumber = 0,
    load_best: RlBest = False,
    policy: RlPolicy = None,
    beside: RlBeside = None,
    genotype: RlGenotype = None,
) -> None:
    """Play new episodes with a trained agent: returns, mean and standard deviation.

    With --algo and --env, the command plays your newest such agent, or else one of botschool's own.
    """
    from botschool.rl.watch import Asked, enjoy_command

    last = last and not load_best
    asked = Asked(run, output, env, algo, exp_id, last, policy, beside, genotype)
    enjoy_command(asked, episodes, seed, render)


@app.command("video", epilog="Example: botschool rl video results/rl/ppo/CartPole-v1_1 -f pole.mp4")
def rl_video(
    run: RlRun = None,
    file: Annotated[
        Path,
        typer.Option("-f", "--file", help="Film to write (.mp4, .webm, .gif).", metavar="FILE"),
    ] = Path("agent.mp4"),
    env: RlEnv = None,
    episodes: RlEpisodes = 3,
    seed: RlSeed = 1,
    last: RlLast = False,
    output: RlFolder = Path("results/rl"),
    algo: RlAlgo = None,
    exp_id: RlNumber = 0,
    load_best: RlBest = False,
    steps: Annotated[
        int | None, typer.Option("--steps", "-n", min=1, help="Film at most this many steps.")
    ] = None,
    policy: RlPolicy = None,
    beside: RlBeside = None,
    genotype: RlGenotype = None,
) -> None:
    """Film new episodes of a trained agent."""
    from botschool.rl.watch import Asked, video_command

    if algo is not None and file.is_dir():  # the chapter's spelling: -f logs
        output, file = file, Path("agent.mp4")
    last = last and not load_best
    asked = Asked(run, output, env, algo, exp_id, last, policy, beside, genotype)
    video_command(asked, episodes, seed, file, steps)


@app.command("list", epilog="Example: botschool rl list results/rl")
def rl_list(
    folder: Annotated[Path, typer.Argument(metavar="FOLDER")] = Path("results/rl"),
    ours: Annotated[
        bool, typer.Option("--ours", help="List the trained agents of botschool.")
    ] = False,
) -> None:
    """Show the trainings in a folder and what they reached."""
    from botschool.rl.watch import list_command, list_ours

    if ours:
        list_ours()
    else:
        list_command(folder)
