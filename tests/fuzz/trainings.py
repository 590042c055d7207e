"""Files in the folders of trainings."""

from __future__ import annotations

import io
import re
import zipfile
from pathlib import Path

from fuzz.kind import Kind, archive_of


class Training(Kind):
    """Files in the folder of a training (rl list, plotstat, rl enjoy)."""

    name = ""
    engine = "sb3"

    def __init__(self, folder: Path) -> None:
        super().__init__(folder)
        self.run = next((folder / "rl").glob("ppo/*"), None) or self._trained()
        kept = folder / "whole"  # the run's own file is damaged when a second turn begins
        if not kept.exists():
            kept.write_bytes((self.run / self.name).read_bytes())
        self.whole = kept.read_bytes()

    def _trained(self) -> Path:
        from botschool.rl.training import train

        return train(
            *("ppo", "CartPole-v1", self.folder / "rl"),
            steps=64,
            evaluations=2,
            episodes=1,
            params={"n_steps": 32, "batch_size": 32, "n_epochs": 1, "normalize": True},
            engine=self.engine,
        ).path

    def path(self) -> Path:
        return self.run / self.name

    def valid(self) -> list[bytes]:
        return [self.whole]

    def rezipped(self, data: bytes) -> bytes:
        """Return an archive without its times, so that a case is the same again."""
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            members = {name: archive.read(name) for name in archive.namelist()}
        started = re.compile(rb'"start_time": \d+')
        return archive_of({name: started.sub(b'"start_time": 0', m) for name, m in members.items()})

    def read(self, path: Path) -> None:
        from botschool.analysis.plots import plot_stat
        from botschool.rl.watch import list_command

        list_command(self.folder / "rl")
        plot_stat([self.run], self.folder / "curve.png")


class Config(Training):
    """config.yaml."""

    name = "config.yaml"

    def read(self, path: Path) -> None:
        from botschool.rl.agent import Agent
        from botschool.rl.folder import RunFolder
        from botschool.rl.watch import list_command

        list_command(self.folder / "rl")
        Agent.load(RunFolder(self.run).best)


class Evaluations(Training):
    """evaluations.npz."""

    name = "evaluations.npz"


class Progress(Training):
    """progress.csv."""

    name = "progress.csv"

    def valid(self) -> list[bytes]:
        table = "rollout/ep_rew_mean,time/fps,time/total_timesteps\n20.5,,32\n,700,64\n31,650,64\n"
        return [table.encode()]

    def read(self, path: Path) -> None:
        from botschool.rl.folder import RunFolder

        RunFolder(self.run).log()
        super().read(path)


class Model(Training):
    """Models of Stable-Baselines3."""

    name = "best_model.zip"

    def valid(self) -> list[bytes]:
        return [self.rezipped(self.whole)]

    def read(self, path: Path) -> None:
        from botschool.rl.agent import Agent, play

        agent = Agent.load(path)
        play(agent, [agent_env(self.run)], [1])


class Weights(Model):
    """Weights alone."""

    name = "weights.npz"

    def __init__(self, folder: Path) -> None:
        from botschool.rl.agent import save_weights

        run = next((folder / "rl").glob("ppo/*"), None) or self._trained_in(folder)
        save_weights(run / "best_model.zip", run / self.name)
        super().__init__(folder)

    def _trained_in(self, folder: Path) -> Path:
        self.folder = folder
        return self._trained()


class NativeConfig(Config):
    """config.yaml of a native training."""

    engine = "native"


class NativeModel(Model):
    """Models of the native engine."""

    name = "best_model.npz"
    engine = "native"

    def valid(self) -> list[bytes]:
        return [self.whole]


class NativeCheckpoint(Training):
    """What a native training goes on from (rl train --resume)."""

    name = "checkpoint.npz"
    engine = "native"

    def read(self, path: Path) -> None:
        from botschool.rl.folder import RunFolder
        from botschool.rl.native import training

        training.resume(RunFolder(self.run), lambda steps, found: None)


def agent_env(run: Path):
    """Return the environment of a training."""
    from botschool.rl.folder import RunFolder

    return RunFolder(run).make_env()
