"""The kinds of files that the command reads: valid ones, and what reads them.

Each kind is a class with `valid()`, the bytes of some good files, and `read(path)`, which must
return or raise BotschoolError for any file. `folder` is empty at first and the kind's own.
"""

from __future__ import annotations

import contextlib
import json
from pathlib import Path

from botschool import config, problems
from botschool.errors import BotschoolError
from fuzz import classes, trainings
from fuzz.kind import Kind

ROOT = Path(__file__).parents[2]
EXPERIMENTS = ROOT / "data" / "experiments"
SMALL = """[EXP]
environment = CartPole-v1
algo = {algo}
[POLICY]
episodes = 1
pepisodes = 1
maxsteps = 20
nhiddens = 3
[ALGO]
maxmsteps = 0.001
saveeach = 60
"""
DUEL = """[EXP]
environment = ErPredprey
algo = coevo2
[POLICY]
nrobots = 2
heterogeneous = 1
episodes = 1
pepisodes = 1
maxsteps = 20
nhiddens = 3
[ALGO]
popsize = 4
selsize = 2
samplesize = 2
ngenerations = 2
saveeach = 1
"""


class Ini(Kind):
    """Experiment files, declared arenas among them."""

    suffix = ".ini"

    def valid(self) -> list[bytes]:
        return [file.read_bytes() for file in sorted(EXPERIMENTS.glob("*.ini"))]

    def read(self, path: Path) -> None:
        experiment = config.load(path)
        assert config.from_dict(config.to_dict(experiment)) == experiment
        if experiment.exp.environment in problems.names() and not experiment.exp.wrappers:
            problem = problems.of(experiment)
            if experiment.policy.nhiddens < 200 and experiment.policy.nlayers < 3:
                problem.policy(experiment.policy)


class Evolved(Kind):
    """What reads the files of a small run."""

    text = SMALL.format(algo="OpenAI-ES")

    def __init__(self, folder: Path) -> None:
        super().__init__(folder)
        self.ini = folder / "own.ini"
        self.ini.write_text(self.text)
        self.experiment = config.load(self.ini)

    def evolve(self, folder: Path, **options) -> None:
        from botschool.evolution.coevolution import Coevolution
        from botschool.evolution.run import Run, evolve

        folder.mkdir(exist_ok=True)
        kind = Coevolution if self.experiment.competitive else Run
        evolve(kind(self.experiment, 1), folder, **options)

    def files(self, pattern: str) -> list[bytes]:
        run = self.folder / "run"
        if not run.exists():
            self.evolve(run, generations=3)
        return [file.read_bytes() for file in sorted(run.glob(pattern))]


class Genotype(Evolved):
    """Saved robots (-p -g)."""

    suffix = ".npy"

    def valid(self) -> list[bytes]:
        return self.files("best*.npy")

    def read(self, path: Path) -> None:
        from botschool.cli.tournament import post_evaluate
        from botschool.render.watch import Watching

        watching = Watching(False, "none", None, None, 1)
        post_evaluate(self.experiment, 1, str(path), self.folder, 1, watching)


class Stat(Evolved):
    """Learning curves (plotstat)."""

    suffix = "S1.npy"

    def path(self) -> Path:
        return self.folder / "statS1.npy"

    def valid(self) -> list[bytes]:
        return self.files("stat*.npy")

    def read(self, path: Path) -> None:
        from botschool.analysis.plots import plot_ave, plot_stat

        plot_stat([path], self.folder / "curve.png")
        plot_ave([path.parent], self.folder / "average.png")


class Fit(Evolved):
    """.fit files (plotave)."""

    def path(self) -> Path:
        return self.folder / "S1.fit"

    def valid(self) -> list[bytes]:
        return self.files("*.fit")

    def read(self, path: Path) -> None:
        from botschool.analysis.plots import plot_ave

        plot_ave([path.parent], self.folder / "average.png")


class Checkpoint(Evolved):
    """Checkpoints of one population (--resume)."""

    def path(self) -> Path:
        (self.folder / "damaged").mkdir(exist_ok=True)
        return self.folder / "damaged" / "checkpointS1.npz"

    def valid(self) -> list[bytes]:
        return self.files("checkpoint*.npz")

    def read(self, path: Path) -> None:
        self.evolve(path.parent, resume=True, generations=5)


class CheckpointSSS(Checkpoint):
    """Of a steady-state algorithm."""

    text = SMALL.format(algo="SSS")


class CheckpointCMA(Checkpoint):
    """Of CMA-ES."""

    text = SMALL.format(algo="CMA-ES")


class CheckpointDuel(Checkpoint):
    """Of two sides."""

    text = DUEL

    def read(self, path: Path) -> None:
        self.evolve(path.parent, resume=True, generations=2)


class Archive(CheckpointDuel):
    """Of two sides with archives."""

    text = DUEL.replace("coevo2", "archive").replace("popsize = 4\nselsize = 2\n", "")


class Populations(Evolved):
    """Populations of a co-evolution (tournament)."""

    text = DUEL

    def path(self) -> Path:
        (self.folder / "damaged").mkdir(exist_ok=True)
        return self.folder / "damaged" / "S1G1.npy"

    def valid(self) -> list[bytes]:
        return self.files("S1G*.npy")

    def read(self, path: Path) -> None:
        from botschool.analysis import coevolution

        valid = self.valid()
        (path.parent / "S1G2.npy").write_bytes(valid[-1])
        output = self.folder / "t.png"
        coevolution.tournament(
            self.experiment, path.parent, 1, None, None, 2, 1, output, False, None
        )


class Sample(Kind):
    """Measured infrared tables."""

    suffix = ".sample"

    def valid(self) -> list[bytes]:
        lines = ["8 4 2 5 2"]
        for turn in range(2):
            lines += [f"TURN {turn}", *["0.91 0.4 0 0 0.25 1 0.1 0.3"] * 4]
        return ["\n".join([*lines, "END", ""]).encode()]

    def read(self, path: Path) -> None:
        from botschool.arenas.samples import load

        load(path).core()


class Urdf(Kind):
    """Robots (showrobot)."""

    suffix = ".urdf"

    def valid(self) -> list[bytes]:
        import pybullet_data

        arm = (ROOT / "data" / "robots" / "balance_bot.urdf").read_bytes()
        pole = Path(pybullet_data.getDataPath(), "cartpole.urdf").read_bytes()
        return [arm, pole]

    def read(self, path: Path) -> None:
        from botschool.envs.showrobot import Model

        Model(str(path)).close()


class Notebook(Kind):
    """Submitted notebooks."""

    suffix = ".ipynb"

    def valid(self) -> list[bytes]:
        cells = [
            {"cell_type": "code", "source": ["import numpy as np\n", "%time x = 1"]},
            {"cell_type": "markdown", "source": "text"},
            {"cell_type": "code", "source": "def f(x):\n    return x\n!ls\n"},
        ]
        return [json.dumps({"cells": cells, "nbformat": 4, "metadata": {}}).encode()]

    def read(self, path: Path) -> None:
        from botschool.grading.notebook import code_cells
        from botschool.grading.run.cells import definitions, whole

        sources = code_cells(path)
        with contextlib.suppress(SyntaxError, ValueError, RecursionError, MemoryError):
            whole(sources), definitions(sources)  # in a process of their own otherwise


class Submission(Kind):
    """Submitted scripts."""

    suffix = ".py"

    def valid(self) -> list[bytes]:
        return [f.read_bytes() for f in sorted(ROOT.glob("solutions/ex0[1-4]*/*.py"))]

    def read(self, path: Path) -> None:
        from botschool.grading.judge.submission import Submission as Read
        from botschool.grading.run.cells import definitions, whole

        submission = Read(path, None)
        try:
            whole(submission._cells()), definitions(submission._cells())
        except (SyntaxError, ValueError, RecursionError, MemoryError):
            pass
        finally:
            submission.__exit__()  # its folder


KINDS = {
    "ini": Ini,
    "genotype": Genotype,
    "stat": Stat,
    "fit": Fit,
    "checkpoint": Checkpoint,
    "checkpoint-sss": CheckpointSSS,
    "checkpoint-cmaes": CheckpointCMA,
    "checkpoint-duel": CheckpointDuel,
    "archive": Archive,
    "populations": Populations,
    "sample": Sample,
    "urdf": Urdf,
    "config": trainings.Config,
    "evaluations": trainings.Evaluations,
    "progress": trainings.Progress,
    "model": trainings.Model,
    "weights": trainings.Weights,
    "native-config": trainings.NativeConfig,
    "native-model": trainings.NativeModel,
    "native-checkpoint": trainings.NativeCheckpoint,
    "notebook": Notebook,
    "submission": Submission,
    "class": classes.ClassSettings,
    "roster": classes.ClassList,
    "export": classes.Download,
    "sheet": classes.LabSheet,
}

__all__ = ["KINDS", "BotschoolError", "Kind"]
