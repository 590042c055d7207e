"""Show an evolved robot beside a trained agent: same environment, same starts, one picture."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import zip_longest
from pathlib import Path

import numpy as np

from botschool import config
from botschool.errors import BotschoolError
from botschool.paths import own_file
from botschool.problems.gym import GymProblem
from botschool.problems.native import gym_id
from botschool.problems.transition import Transition
from botschool.render.watch import read_genotype
from botschool.rl.player import Player

GAP = 8
"""White pixels between the two pictures."""

FADED = 0.6
"""How much white lies over the last picture of an episode that has ended."""


class Evolved(Player):
    """Episodes of an evolved robot in the environment of a trained agent, from the same seeds."""

    def __init__(self, file: Path, genotype: Path, trained: Player) -> None:
        """Load the robot; file: the experiment that evolved it. Raises BotschoolError."""
        experiment = config.load(own_file(file, "experiments"))
        evolved_on = experiment.exp.environment
        if gym_id(trained.env) not in (gym_id(evolved_on), f"botschool/{evolved_on}"):
            raise BotschoolError(
                f"{file} evolves robots on {evolved_on}, but the agent was trained on "
                f"{trained.env}: show two that were made for the same environment."
            )
        self.env, self.seed, self.settings = trained.env, trained.seed, trained.settings
        self.returns, self.lengths = [], []
        path = own_file(genotype, "genotypes")
        self.name = f"evolved ({experiment.exp.algo}) {path.name}"
        self._problem = GymProblem(self.env, self.settings.wrappers)
        self._most = experiment.policy.post_steps
        self._policy = self._problem.policy(experiment.policy)
        self._robot = self._policy.split(read_genotype(path))

    def play(self, episodes: int) -> None:
        """Play the first episodes and print their returns."""
        for number in range(episodes):
            for _ in self._steps(number, pictures=False):
                pass

    def transitions(self, number: int) -> Iterator[Transition]:
        """Play episode `number`, yielding each step with its picture."""
        yield from self._steps(number, pictures=True)

    def _steps(self, number: int, pictures: bool) -> Iterator[Transition]:
        last, seed = None, self._seed(number)
        genotype, normalisation = self._robot
        steps = self._problem.play(
            self._policy, genotype, normalisation, seed, 0, self._most, pictures
        )
        for last in steps:
            yield last
        if last is not None:
            self._keep(last.total, last.step)


class Beside:
    """A trained agent at the left, an evolved robot at the right."""

    def __init__(self, trained: Player, evolved: Evolved) -> None:
        self.trained, self.evolved = trained, evolved
        self.env, self.fps = trained.env, trained.fps
        trained.named = evolved.named = True

    def play(self, episodes: int) -> None:
        """Play the first episodes of both and print their returns."""
        self.trained.play(episodes)
        self.evolved.play(episodes)

    def frames(self, episodes: int) -> Iterator[np.ndarray]:
        """Yield pictures of the first episodes of both, each with its name and a caption."""
        from botschool.render.canvas import draw_offscreen
        from botschool.render.panel import with_caption, with_title

        draw_offscreen()
        for number in range(episodes):
            halves: list[np.ndarray] = [np.zeros(0)] * 2
            names = self.trained.name, self.evolved.name
            both = self.trained.transitions(number), self.evolved.transitions(number)
            for steps in zip_longest(*both):
                for side, transition in enumerate(steps):
                    if transition is not None:
                        frame = with_caption(transition.frame, number + 1, transition)
                        halves[side] = with_title(frame, names[side])
                yield _joined(*(_faded(h, s is None) for h, s in zip(halves, steps, strict=True)))

    def print_summary(self) -> None:
        """Print mean and standard deviation of both."""
        self.trained.print_summary()
        self.evolved.print_summary()


def _faded(frame: np.ndarray, over: bool) -> np.ndarray:
    return (255 - (255 - frame) * (1 - FADED)).astype(np.uint8) if over else frame


def _joined(left: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Return two pictures on one white ground."""
    height = max(len(left), len(right))
    halves = [
        np.pad(half, [(0, height - len(half)), (0, gap), (0, 0)], constant_values=255)
        for half, gap in ((left, GAP), (right, 0))
    ]
    return np.hstack(halves)
