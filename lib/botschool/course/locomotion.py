"""Give exercise 9 runners to evolve, recorded episodes, and pictures of gaits."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from botschool import _core, problems
from botschool.config import Exp, Experiment, OpenAIESConfig, PolicyConfig
from botschool.policies.policy import Policy
from botschool.problems.transition import Transition

POLICY = {
    "episodes": 1,
    "pepisodes": 3,
    "maxsteps": 1000,
    "nhiddens": 50,
    "bias": 1,
    "afunction": 2,
    "out_type": 3,
    "winit": 1,
    "action_noise": 1,
    "normalize": 1,
    "clip": 1,
}
ALGO: dict[str, Any] = {"samplesize": 20, "stepsize": 0.01, "noiseStdDev": 0.02, "wdecay": 1}
"""The settings of data/experiments/planarhopper.ini, with fewer post-evaluations."""
TARGET = 1000.0
"""The runners' target, in metres ahead."""
FILM_STEPS = 4
"""Steps of a hopper between two pictures of a film, which shows 31 pictures a second."""


class Runner:
    """A planar runner with its network, for example Runner("PlanarHopper-v5").

    Its genotypes hold `size` numbers: the parameters, then means and standard deviations of the
    observations, as `botschool es` saves them with planarhopper.ini's settings.
    """

    def __init__(self, environment: str, policy: PolicyConfig | None = None) -> None:
        """Make the runner.

        environment: PlanarHopper, PlanarWalker2D or PlanarHalfCheetah, with -v0 or -v5.
        policy: its settings; None: planarhopper.ini's.
        """
        self.environment = environment
        self.robot = environment.partition("-")[0]
        self._problem: Any = problems.make(environment)
        self.policy = Policy(environment, self._problem.interface, policy or PolicyConfig(**POLICY))
        self.size = self.policy.genotype_size + 2 * self.policy.spec.inputs
        self.duration = 1 / self._problem.fps
        """Seconds of a step."""
        table = _core.PlanarBody(self.robot.removeprefix("Planar").lower()).table
        segments = [contact[0] for contact in table["contacts"]]
        self._contacts = len(segments)
        self._feet = [
            [i for i, segment in enumerate(segments) if segment == foot]
            for foot, each in enumerate(table["segments"])
            if each["name"].endswith("foot")
        ]

    def evolve(self, steps: int, seed: int) -> np.ndarray:
        """Evolve by OpenAI-ES until `steps`; return the best post-evaluated genotype."""
        from botschool.evolution.limit import Limit
        from botschool.evolution.run import Run

        experiment = Experiment(Exp(self.environment), self.policy.config, OpenAIESConfig(**ALGO))
        run = Run(experiment, seed)
        run.limit = Limit(steps=steps)
        while not run.limit.reached(run):
            run.advance()
        return np.array(run.record.bestg)

    def record(self, genotype: np.ndarray, seed: int, maxsteps: int = 1000) -> dict:
        """Play one episode of T steps and return its record, a dict of plain data.

        "robot": its name; "duration": seconds of a step; "distance" (T + 1,): metres to the target
        at the start and after each step; "height" (m) and "pitch" (rad), each (T,): after each
        step; "actions" (T, joints); "feet" (T, feet): 1 if a foot has touched the ground in the
        step, else 0.
        """
        parameters, normalisation = self.policy.split(genotype)
        tape = self._problem.engine(self.policy).record(
            parameters[None], normalisation, seed, 0, self._problem.steps(maxsteps)
        )
        states = tape["states"]
        loads = states[1:, -self._contacts :]
        feet = [(loads[:, contacts] > 0).any(axis=1) for contacts in self._feet]
        return {
            "robot": self.robot,
            "duration": self.duration,
            "distance": TARGET - states[:, 0],
            "height": states[1:, 1],
            "pitch": states[1:, 2],
            "actions": np.clip(tape["actions"], -1, 1),
            "feet": np.stack(feet, axis=1).astype(float),
        }

    def play(self, genotype: np.ndarray, seed: int, maxsteps: int = 1000) -> Iterator[Transition]:
        """Yield the steps of the episode that `record` records."""
        robot = self.policy.split(genotype)
        return self._problem.play(self.policy, *robot, seed, 0, maxsteps)

    def film(self, file: str | Path, genotype: np.ndarray, seed: int, maxsteps: int = 1000) -> None:
        """Film one episode in real time."""
        from botschool.render.panel import lively
        from botschool.render.video import write_video

        scene = self._scene()
        seen = islice(self.play(genotype, seed, maxsteps), 0, None, FILM_STEPS)
        pictures = ((scene.draw_transition(step), 1, step) for step in seen)
        fps = scene.fps / FILM_STEPS
        write_video(Path(file), lively(pictures, fps), fps)
        print(f"film: {file}")

    def replay(
        self, file: str | Path, genotype: np.ndarray, seed: int, about: str, maxsteps: int = 1000
    ) -> None:
        """Write a page that plays one episode in a browser; about: a line about the robot."""
        from botschool.render.replay import write_replay

        neurons = self.policy.spec.inputs, self.policy.spec.outputs
        play, scene = self.play(genotype, seed, maxsteps), self._scene()
        write_replay(Path(file), self.environment, about, [play], scene.fps, neurons, scene)
        print(f"replay: {file}")

    def strip(
        self, genotype: np.ndarray, seed: int, steps: int = 320, pictures: int = 8
    ) -> np.ndarray:
        """Return pictures of an episode's first steps side by side, evenly spaced in time.

        Pictures after the end of the episode are white.
        """
        scene, found = self._scene(), []
        wanted = set(np.linspace(1, steps, pictures).astype(int).tolist())
        for step in self.play(genotype, seed, steps):
            if step.step in wanted:
                frame = scene.draw_transition(step)
                margin = (frame.shape[1] - round(0.6 * frame.shape[0])) // 2
                found.append(frame[:, margin : frame.shape[1] - margin])
        white = np.full_like(found[0], 255)
        return np.hstack(found + [white] * (pictures - len(found)))

    def _scene(self):
        from botschool.render.canvas import draw_offscreen
        from botschool.render.scenes import make_scene

        draw_offscreen()
        return make_scene(self.environment)


COLOURS = ("#d55e00", "#0072b2", "#009e73", "#cc79a7")
GAIT_SECONDS = 3.0
"""Seconds of an episode in a gait diagram."""


def draw_gaits(
    file: str | Path,
    trajectories: dict[str, list[dict]],
    incomes: dict[str, dict[str, float]],
    examples: dict[str, dict],
    strips: dict[str, np.ndarray],
) -> None:
    """Draw how the robots of two or more rewards move, and what they earn.

    All dicts have the rewards' labels as keys. trajectories: an episode of each robot (distance
    over time). incomes: the components of an income. examples: the episode of one robot, for its
    height and the contacts of its feet. strips: pictures of it in a row, (height, width, 3).
    """
    from matplotlib.figure import Figure

    colours = dict(zip(trajectories, COLOURS, strict=False))
    high = sum(strip.shape[0] / strip.shape[1] * 9.6 for strip in strips.values()) + 0.2
    figure = Figure(figsize=(10, 6 + high), layout="constrained")
    upper, middle, lower = figure.subfigures(3, 1, height_ratios=(3.6, 2.4, high))
    ways, bars = upper.subplots(1, 2, width_ratios=(3, 2))
    for label, robots in trajectories.items():
        for i, one in enumerate(robots):
            way = one["distance"][0] - one["distance"]
            seconds = one["duration"] * np.arange(len(way))
            ways.plot(seconds, way, color=colours[label], lw=1.2, label="" if i else label)
            ways.plot(seconds[-1], way[-1], ".", color=colours[label], ms=7)
    ways.set(xlabel="seconds", ylabel="metres", title="Where each robot is, until its episode ends")
    ways.legend(frameon=False)
    names = list(next(iter(incomes.values())))
    width = 0.8 / len(incomes)
    for i, (label, parts) in enumerate(incomes.items()):
        places = np.arange(len(names)) + (i - (len(incomes) - 1) / 2) * width
        bars.bar(places, [parts[name] for name in names], width, color=colours[label])
    bars.set_xticks(range(len(names)), names)
    bars.axhline(0, color="black", lw=0.8)
    bars.set_title("Income in version 0, an episode")
    rows = middle.subplots(1, len(examples), sharey=True, squeeze=False)[0]
    for axes, (label, one) in zip(rows, examples.items(), strict=True):
        _draw_gait(axes, one, colours[label])
        axes.set_title(f"{label}: the robot in the middle")
    rows[0].set_ylabel("height (m)")
    for axes in (ways, bars, *rows):
        axes.spines[["top", "right"]].set_visible(False)
    pictures = lower.subplots(len(strips), 1, squeeze=False)[:, 0]
    for axes, (label, strip) in zip(pictures, strips.items(), strict=True):
        axes.imshow(strip)
        axes.set(xticks=[], yticks=[])
        axes.set_ylabel(label, fontsize=8)
    figure.savefig(file, dpi=100)
    print(f"picture: {file}")


def _draw_gait(axes, trajectory: dict, colour: str) -> None:
    """Draw the height of the torso, and below it a bar while a foot is on the ground."""
    steps = round(GAIT_SECONDS / trajectory["duration"])
    height, feet = trajectory["height"][:steps], trajectory["feet"][:steps]
    seconds = trajectory["duration"] * np.arange(1, len(height) + 1)
    axes.plot(seconds, height, color=colour)
    for i, foot in enumerate(feet.T):
        low, across = 0.12 * i, axes.get_xaxis_transform()
        axes.fill_between(
            seconds, low, low + 0.1, foot > 0, step="mid", color="black", transform=across, lw=0
        )
    axes.set(xlabel="seconds (black: the foot is on the ground)", xlim=(0, GAIT_SECONDS))
    axes.set_ylim(0.4, 1.7)
