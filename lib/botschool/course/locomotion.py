"""What exercise 9 is given ready-made: short evolutions, recorded episodes, and their picture."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from botschool import problems
from botschool.config import Exp, Experiment, OpenAIESConfig, PolicyConfig
from botschool.policy import Policy

SETTINGS = {
    "nhiddens": 10,
    "bias": 1,
    "afunction": 2,
    "out_type": 3,
    "winit": 1,
    "normalize": 1,
    "clip": 1,
}
"""Network of the exercise's robots: as in data/experiments/hopper.ini, but smaller."""


class Runner:
    """A locomotor with a network of 10 hidden neurons, for example Runner("HopperBulletEnv-v5").

    Its genotypes hold `size` numbers: the parameters, then means and standard deviations of the
    observations.
    """

    def __init__(self, environment: str) -> None:
        self.environment = environment
        self._problem = problems.make(environment)
        self.policy = Policy(environment, self._problem.interface, PolicyConfig(**SETTINGS))
        self.size = self.policy.genotype_size + 2 * self.policy.spec.inputs

    def evolve(self, steps: int, seed: int) -> np.ndarray:
        """OpenAI-ES until so many steps are done; the best post-evaluated genotype."""
        from botschool.evolution.run import Run

        policy = PolicyConfig(**SETTINGS, episodes=1, pepisodes=3)
        algo = OpenAIESConfig(samplesize=20, noiseStdDev=0.02, stepsize=0.01)
        run = Run(Experiment(Exp(self.environment), policy, algo), seed)
        while run.record.steps < steps:
            run.advance()
        return np.array(run.record.bestg)

    def record(self, genotype: np.ndarray, seed: int, maxsteps: int = 1000) -> dict:
        """Plays one episode and records it, as a dict of plain data for its T steps.

        "robot" is its name; "distance", shape (T + 1,), the metres to the target at the start and
        after each step; "height" (m), "pitch", "heading" (rad) and "touching", shape (T,), are
        those after each step; "actions", "speeds" and "positions" have the shape (T, joints).
        """
        env = self._problem._env
        body, joints = env.unwrapped, env.action_space.shape[0]
        observation, _ = env.reset(seed=seed)
        self.policy.load(*self.policy.split(genotype))
        self.policy.reset(seed, 0)
        rows = [{**body.measured()}]
        ended = False
        while not ended and len(rows) <= maxsteps:
            action = np.clip(self.policy.act(observation), -1, 1).astype(np.float32)
            observation, _, terminated, truncated, _ = env.step(action)
            rows.append({**body.measured(), "actions": action})
            rows[-1]["positions"] = observation[8 : 8 + 2 * joints : 2]
            rows[-1]["speeds"] = observation[9 : 9 + 2 * joints : 2]
            ended = terminated or truncated
        trajectory = {
            key: np.array([row[key] for row in rows[1:]], dtype=np.float64) for key in rows[-1]
        }
        trajectory["distance"] = np.array([row["distance"] for row in rows])
        trajectory["robot"] = self.environment.partition("BulletEnv")[0]
        return trajectory

    def film(self, file: str | Path, genotype: np.ndarray, seed: int, maxsteps: int = 1000) -> None:
        """A film of one episode."""
        from botschool.render.panel import with_caption
        from botschool.render.video import write_video

        robot = self.policy.split(genotype)
        play = self._problem.play(self.policy, *robot, seed, 0, maxsteps, render=True)
        write_video(Path(file), (with_caption(t.frame, 1, t) for t in play), self._problem.fps)
        print(f"film: {file}")


def draw_gaits(
    file: str | Path,
    components: dict[str, dict[str, float]],
    distances: dict[str, np.ndarray],
    frames: dict[str, np.ndarray],
) -> None:
    """A picture of several robots: what their reward is made of, and where they are over time.

    For every robot's label: the sum of each component of the reward of version 0, the metres
    covered after each step, and pictures in a row, (height, width, 3).
    """
    from matplotlib.figure import Figure

    colours = dict(zip(components, ("#d55e00", "#0072b2", "#009e73", "#cc79a7"), strict=False))
    figure = Figure(figsize=(10, 4.2 + 1.5 * len(frames)), layout="constrained")
    upper, lower = figure.subfigures(2, 1, height_ratios=(4.2, 1.5 * len(frames)))
    bars, lines = upper.subplots(1, 2, width_ratios=(3, 2))
    names = list(next(iter(components.values())))
    width = 0.8 / len(components)
    for i, (label, sums) in enumerate(components.items()):
        places = np.arange(len(names)) + (i - (len(components) - 1) / 2) * width
        bars.bar(places, [sums[name] for name in names], width, color=colours[label], label=label)
        lines.plot(distances[label], color=colours[label], label=label)
    bars.set_xticks(range(len(names)), [name.replace("_", " ") for name in names])
    bars.axhline(0, color="black", linewidth=0.8)
    bars.set_title("What each would earn in version 0, an episode", fontsize=10)
    bars.legend(frameon=False)
    lines.set(xlabel="step", ylabel="metres", title="Distance covered")
    for axes in (bars, lines):
        axes.spines[["top", "right"]].set_visible(False)
    rows = lower.subplots(len(frames), 1, squeeze=False)[:, 0]
    for axes, (label, strip) in zip(rows, frames.items(), strict=True):
        axes.imshow(strip)
        axes.set(xticks=[], yticks=[], ylabel=label)
    figure.savefig(file, dpi=100)
    print(f"picture: {file}")


def strip(environment: str, genotype: np.ndarray, seed: int, pictures: int = 7) -> np.ndarray:
    """Pictures of one episode side by side, equally far apart in time."""
    runner = Runner(environment)
    steps = len(runner.record(genotype, seed)["height"])
    wanted = set(np.linspace(1, steps, pictures).astype(int).tolist())
    problem, found = problems.make(environment), []
    play = problem.play(runner.policy, *runner.policy.split(genotype), seed, 0, 1000, render=True)
    for transition in play:
        if transition.step in wanted:
            found.append(transition.frame)
    return np.hstack(found)
