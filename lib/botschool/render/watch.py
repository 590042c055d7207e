"""Watch one robot: post-evaluation with numbers, window, video, replay and activations."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from botschool import problems
from botschool.config import Experiment
from botschool.errors import BotschoolError
from botschool.npy import NotNumbers, read_numbers
from botschool.problems.base import say_unrepeatable
from botschool.problems.transition import Transition
from botschool.seeds import POST_EVALUATION_SEED
from botschool.terminal import has_display, readable

VIDEO_EPISODES = 3
REPLAY_EPISODES = 5
"""Default number of episodes in a video and in a replay."""


def read_genotype(path: Path) -> np.ndarray:
    """Return a saved genotype; raises BotschoolError."""
    if not path.exists():
        raise BotschoolError(
            f"There is no genotype file {path}: a run with seed 11 saves bestgS11.npy, so give "
            "the path to such a file."
        )
    try:
        return read_numbers(path)
    except OSError as error:
        raise BotschoolError(
            f"{path} is not a genotype: it cannot be read ({error.strerror or error})."
        ) from error
    except NotNumbers as error:
        raise BotschoolError(f"{path} is not a genotype: {error}.") from None


class PostEvaluation:
    """Episodes of one robot, on the seeds of its run's post-evaluations.

    Without a saved genotype the robot is the random one that evolution starts from.
    """

    occasion = "post-evaluated with seed"
    """Words for the episodes, before the seed of the run."""

    def __init__(
        self,
        experiment: Experiment,
        seed: int,
        saved: np.ndarray | None = None,
        name: str = "random robot",
    ) -> None:
        self.name = name
        self.problem = problems.of(experiment)
        self.policy = self.problem.policy(experiment.policy)
        self.seed = seed
        self.episodes_seed = seed + POST_EVALUATION_SEED
        """The seed of the episodes."""
        self.maxsteps = experiment.policy.post_steps
        self.fitness: list[float] = []
        self.others: list[float] = []
        """Fitness values of the second side, if it has its own."""
        self.steps: list[int] = []
        if saved is None:
            self._robot: tuple[np.ndarray, np.ndarray | None] = (self.policy.initial(seed), None)
        else:
            self._robot = self.policy.split(saved)

    @property
    def available(self) -> int:
        """Return the number of episodes of a whole post-evaluation."""
        return self.policy.config.pepisodes

    def cast(self, episode: int) -> tuple[np.ndarray, np.ndarray | None, int]:
        """Return genotype, normalisation and number of an episode."""
        return *self._robot, episode

    def label(self, episode: int) -> str:
        """Return the text that distinguishes this episode from the others, beside its number."""
        return ""

    def play(self, episode: int, render: bool = False) -> Iterator[Transition]:
        """Play one episode, record its fitness and steps, and print them."""
        genotype, normalisation, number = self.cast(episode)
        transition = None
        steps = self.problem.play(
            self.policy, genotype, normalisation, self.episodes_seed, number, self.maxsteps, render
        )
        if render:
            from botschool.render.scenes import with_frames

            steps = with_frames(self.problem, steps)
        for transition in steps:
            yield transition
        if transition is not None:
            self.fitness.append(transition.total)
            self.steps.append(transition.step)
            self.others.extend(transition.totals[1:])
            name = "  ".join(filter(None, [f"episode {episode + 1}", self.label(episode)]))
            fitness = readable(transition.total)
            if transition.totals:
                returns = zip(self.problem.sides, transition.totals, strict=True)
                fitness = ", ".join(f"{readable(total)} of {side}" for side, total in returns)
            print(f"{name}  fitness {fitness}  steps {transition.step}")

    def frames(self, episodes: int, activations: bool) -> Iterator[np.ndarray]:
        """Yield pictures of the first episodes with a caption, and with the neurons on request."""
        from botschool.render.canvas import draw_offscreen
        from botschool.render.panel import with_activations, with_caption
        from botschool.render.scenes import scene_of

        draw_offscreen()
        scene = scene_of(self.problem)
        robots = self._robots(scene)
        for episode in range(episodes):
            for transition in self.play(episode, render=True):
                frame = scene.draw_transition(transition) if scene else transition.frame
                frame = with_caption(frame, episode + 1, transition)
                if activations:
                    frame = with_activations(frame, transition.activations, *self.neurons, robots)
                yield frame

    @property
    def neurons(self) -> tuple[int, int]:
        """Return inputs (or features of images) and outputs of one or each robot's network."""
        return self.policy.neurons

    def _robots(self, scene) -> tuple[str, ...]:
        """Return names beside the neurons of each robot; "" for a single one."""
        if scene:
            return scene.robots
        return self.problem.sides if self.problem.interface.robots > 1 else ("",)

    def write_replay(self, path: Path, episodes: int) -> None:
        """Write a page that plays the first episodes; see botschool.render.replay."""
        from botschool.render.canvas import draw_offscreen
        from botschool.render.replay import write_replay
        from botschool.render.scenes import scene_of

        draw_offscreen()
        scene = scene_of(self.problem)
        write_replay(
            path,
            self.problem.name,
            f"{self.name}, {self.occasion} {self.seed}",
            (self.play(episode, render=True) for episode in range(episodes)),
            self.problem.fps,
            self.neurons,
            scene,
            [self.label(episode) for episode in range(episodes)],
            self._robots(scene),
        )

    def check(self) -> None:
        """Say so if the first episode does not repeat; native problems always do."""
        if self.fitness and not self.problem.native:
            genotype, normalisation, number = self.cast(0)
            robot = self.policy, genotype, normalisation
            *_, again = self.problem.play(*robot, self.episodes_seed, number, self.maxsteps)
            if again.total != self.fitness[0]:
                say_unrepeatable(self.problem.name)

    def print_summary(self) -> None:
        """Print mean and standard deviation, of each side if it has a fitness of its own."""
        names = [f"{side}: " for side in self.problem.sides] if self.others else [""]
        for name, fitness in zip(names, (self.fitness, self.others), strict=False):
            if fitness:
                print(
                    f"{name}mean {readable(float(np.mean(fitness)))}  "
                    f"standard deviation {readable(float(np.std(fitness)))}"
                    f"  steps {np.mean(self.steps):.1f}  episodes {len(fitness)}"
                )


class PairEpisodes(PostEvaluation):
    """Episodes of pairs: the first predator with every prey, then the second, and so on.

    predators, prey: networks, each (individuals, nparameters). Every pair has `pepisodes`
    episodes, the same that a tournament counts; an episode's fitness is the predator's.
    """

    def __init__(
        self, experiment: Experiment, seed: int, predators: np.ndarray, prey: np.ndarray, name: str
    ) -> None:
        super().__init__(experiment, seed)
        self.name = f"{name} (fitness is the {self.problem.sides[0]}'s)"
        self._predators, self._prey = predators, prey
        self._repeats = experiment.policy.pepisodes

    @property
    def available(self) -> int:
        """Return the number of episodes of all pairs."""
        return len(self._predators) * len(self._prey) * self._repeats

    def cast(self, episode: int) -> tuple[np.ndarray, np.ndarray | None, int]:
        """Return the pair's networks as rows, and the number of the pair's episode."""
        predator, prey, number = self._pair(episode)
        networks = np.stack([self._predators[predator], self._prey[prey]])
        return networks, None, number

    def label(self, episode: int) -> str:
        """Return which individuals meet."""
        predator, prey, _ = self._pair(episode)
        numbers = zip(self.problem.sides, (predator, prey), strict=True)
        return ", ".join(f"{side} {number + 1}" for side, number in numbers)

    def _pair(self, episode: int) -> tuple[int, int, int]:
        again, place = divmod(episode, self.available)
        pair, number = divmod(place, self._repeats)
        return *divmod(pair, len(self._prey)), again * self._repeats + number


@dataclass(frozen=True)
class Watching:
    """The options of `botschool es -p`: how to watch a robot.

    Raises BotschoolError for options that exclude each other.
    """

    neurons: bool = False
    render: str | None = None
    """human (a window), none, or None: a window if there is a display."""
    video: Path | None = None
    replay: Path | None = None
    episodes: int | None = None

    def __post_init__(self) -> None:
        if self.render not in (None, "human", "none"):
            raise BotschoolError(f"--render is '{self.render}', but must be human or none.")
        if self.video and self.replay:
            raise BotschoolError("--video makes a film and --replay a page: give one of them.")

    @property
    def asked(self) -> bool:
        """Return whether the options ask to show something."""
        return bool(self.neurons or self.video or self.replay or self.render == "human")

    def show(self, robot: PostEvaluation) -> None:
        """Play and print the episodes, in a window or into a video file or a page."""
        film = self.video or self.replay
        window = self.render == "human" or (self.render is None and not film and has_display())
        most = VIDEO_EPISODES if self.video else REPLAY_EPISODES if self.replay else sys.maxsize
        episodes = self.episodes or min(robot.available, most)
        watch(robot, episodes, window, self.video, self.neurons, self.replay)


def watch(
    robot: PostEvaluation,
    episodes: int,
    window: bool,
    video: Path | None,
    activations: bool,
    replay: Path | None = None,
) -> None:
    """Play and print `episodes` episodes, in a window or into a video file or a page."""
    title = f"botschool: {robot.problem.name}"
    if video is not None:
        from botschool.render.video import write_video

        write_video(video, robot.frames(episodes, activations), robot.problem.fps)
        print(f"video: {video}")
    elif replay is not None:
        robot.write_replay(replay, episodes)
        print(f"replay: {replay} (open it in a browser)")
    elif window:
        from botschool.render.window import show

        show(robot.frames(episodes, activations), robot.problem.fps, title)
    else:
        for episode in range(episodes):
            for transition in robot.play(episode):
                if activations:
                    values = " ".join(f"{value:.3f}" for value in transition.activations)
                    step = f"step {transition.step}  reward {readable(transition.reward)}"
                    print(f"{step}  activations {values}")
    robot.print_summary()
    robot.check()
    robot.problem.close()
