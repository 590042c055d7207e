"""Play and film episodes of a trained agent on new seeds."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import gymnasium
import numpy as np

from botschool.errors import BotschoolError
from botschool.problems.pictures import picture, rate
from botschool.problems.transition import Transition
from botschool.rl.agent import Agent, play, stacked
from botschool.rl.environments import make
from botschool.rl.folder import RunFolder
from botschool.seeds import NEW_EPISODES_SEED, seed_libraries
from botschool.terminal import readable

BATCH = 16
"""Episodes that are played in parallel if no picture is shown."""


class Player:
    """Plays episodes of the agent in a model file on new seeds; policy: the user's own class."""

    def __init__(
        self, model: Path, seed: int = 1, env: str | None = None, policy: str | None = None
    ) -> None:
        self.settings = RunFolder(model.parent).settings()
        self.env = env or self.settings.env
        self.agent = Agent.load(model, env, policy)
        self.seed = seed
        self.name = f"trained ({self.settings.algo}) {model.parent.name}"
        self.returns: list[float] = []
        self.lengths: list[int] = []

    named = False
    """Whether lines of text begin with the name: where two are shown."""

    def play(self, episodes: int) -> None:
        """Play the first episodes, BATCH of them in lockstep, and print their returns."""
        envs = [self._make() for _ in range(min(BATCH, episodes))]
        try:
            for first in range(0, episodes, BATCH):
                batch = envs[: episodes - first]
                seeds = range(self._seed(first), self._seed(first) + len(batch))
                for result in zip(*play(self.agent, batch, seeds), strict=True):
                    self._keep(*result)
        finally:
            for env in envs:
                env.close()

    def transitions(self, number: int) -> Iterator[Transition]:
        """Play episode `number` (from 0) and yield each step with its picture."""
        try:
            env = self._make(render_mode="rgb_array")
        except BotschoolError as error:  # a constructor that does not know the option
            raise _unseen(self.env) if "argument 'render_mode'" in str(error) else error from None
        try:
            observation, _ = env.reset(seed=seed_libraries(self._seed(number)))
            state, total, step, ended = None, 0.0, 0, False
            while not ended:
                seen, starts = observation, np.array([step == 0])
                actions, state = self.agent.act(stacked([seen]), state, starts)
                observation, reward, terminated, truncated, _ = env.step(actions[0])
                step, total, ended = step + 1, total + reward, terminated or truncated
                frame = picture(env.render(), self.env)
                yield Transition(step, reward, total, seen, actions[0], np.zeros(0), frame=frame)
        finally:
            env.close()
        self._keep(total, step)

    def _make(self, **options: object) -> gymnasium.Env:
        own = self.settings.own if self.env == self.settings.env else {}
        return make(self.env, self.settings.wrappers, **own, **options)

    def _seed(self, number: int) -> int:
        return self.seed + NEW_EPISODES_SEED + number

    def _keep(self, total: float, steps: int) -> None:
        self.returns.append(total)
        self.lengths.append(steps)
        episode = f"{self._begin}episode {len(self.returns)}"
        print(f"{episode}  return {readable(total)}  steps {steps}", flush=True)

    @property
    def _begin(self) -> str:
        return f"{self.name}  " if self.named else ""

    def frames(self, episodes: int) -> Iterator[np.ndarray]:
        """Yield pictures of the first episodes, with a caption."""
        from botschool.render.canvas import draw_offscreen
        from botschool.render.panel import with_caption

        draw_offscreen()
        for number in range(episodes):
            for transition in self.transitions(number):
                yield with_caption(transition.frame, number + 1, transition)

    @property
    def fps(self) -> float:
        """Return the frame rate of the environment's pictures."""
        env = self._make()
        env.close()
        return rate(env.metadata, self.env)

    def print_summary(self) -> None:
        """Print mean and standard deviation over the episodes played."""
        if self.returns:
            print(
                f"{self._begin}mean {readable(float(np.mean(self.returns)))}  "
                f"standard deviation {readable(float(np.std(self.returns)))}"
                f"  steps {np.mean(self.lengths):.1f}  episodes {len(self.returns)}"
            )


def _unseen(name: str) -> BotschoolError:
    return BotschoolError(
        f"{name} draws no pictures (render_mode rgb_array): use `botschool rl enjoy` with "
        "--render none."
    )
