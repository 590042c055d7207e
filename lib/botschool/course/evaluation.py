"""Give exercises robots to evaluate: a network in an environment, and saved robots."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from botschool import problems
from botschool.config import PolicyConfig
from botschool.config import load as load_experiment
from botschool.policies.policy import Policy
from botschool.problems import Episodes
from botschool.problems.python import PythonProblem


class Robot:
    """A network with tanh hidden neurons in an environment, ready to be evaluated.

    The parameters are first the biases, then the weights (docs/specification.md, "Policy network").
    """

    def __init__(self, environment: str, nhiddens: int = 10, out_type: int = 3) -> None:
        """Make the robot; out_type: activation of the outputs, 2 tanh, 3 linear."""
        self.environment = environment
        self._problem = problems.make(environment)
        if isinstance(self._problem, PythonProblem):
            self._problem.fresh = False  # no trial before: the first episodes are the student's
        config = PolicyConfig(nhiddens=nhiddens, bias=1, out_type=out_type)
        self.policy = Policy(environment, self._problem.interface, config)
        self.nbiases = nhiddens + self.policy.spec.outputs
        self.nweights = self.policy.genotype_size - self.nbiases

    def evaluate(
        self, population: np.ndarray, seed: int, episodes: int = 5, maxsteps: int = 1000
    ) -> np.ndarray:
        """Return each row's mean return over the same `episodes` episodes, (individuals,)."""
        population = np.ascontiguousarray(population, dtype=np.float64)
        if population.ndim != 2 or population.shape[1] != self.policy.genotype_size:
            raise ValueError(
                f"population has shape {population.shape}, but must have (individuals, "
                f"{self.policy.genotype_size})."
            )
        batch = Episodes.of(np.full(len(population), seed, dtype=np.uint64), episodes)
        outcome = self._problem.evaluate(self.policy, population, None, batch, maxsteps)
        return outcome.fitness.reshape(-1, episodes).mean(axis=1)

    def play(self, parameters: np.ndarray, seed: int, maxsteps: int = 1000):
        """Play one episode and yield its steps as Transition objects."""
        parameters = np.ascontiguousarray(parameters, dtype=np.float64)
        return self._problem.play(self.policy, parameters, None, seed, 0, maxsteps)


class SavedRobot:
    """A robot that `botschool es` has evolved and saved, ready to be evaluated."""

    def __init__(self, experiment_file: str | Path, genotype: np.ndarray) -> None:
        """Make the robot; genotype: content of bestS<seed>.npy or bestgS<seed>.npy."""
        experiment = load_experiment(experiment_file)
        self.environment = experiment.exp.environment
        self._problem = problems.make(self.environment)
        self._policy = Policy(self.environment, self._problem.interface, experiment.policy)
        self._genotype, self._normalisation = self._policy.split(genotype)

    def evaluate(self, seed: int, episodes: int) -> np.ndarray:
        """Return the return of each episode, (episodes,); the seed determines them."""
        batch = Episodes.of(np.array([seed], dtype=np.uint64), episodes)
        maxsteps = self._policy.config.maxsteps
        return self._problem.evaluate(
            self._policy, self._genotype[None], self._normalisation, batch, maxsteps
        ).fitness

    def film(self, file: str | Path, seed: int = 1, episodes: int = 1) -> None:
        """Film some episodes; where we draw the environment, write their replay beside the film."""
        from botschool.render.canvas import draw_offscreen
        from botschool.render.panel import lively
        from botschool.render.replay import write_replay
        from botschool.render.scenes import scene_of
        from botschool.render.video import write_video

        draw_offscreen()
        scene = scene_of(self._problem)
        fps = scene.fps if scene else self._problem.fps
        write_video(Path(file), lively(self._seen(scene, seed, episodes), fps), fps)
        print(f"film: {file}")
        if scene:
            page, spec = Path(file).with_suffix(".html"), self._policy.spec
            plays = [self._play(seed, episode) for episode in range(episodes)]
            neurons = spec.inputs, spec.outputs * spec.nbins
            about = "your robot, with its neurons"
            write_replay(page, self.environment, about, plays, fps, neurons, scene)
            print(f"replay: {page}")

    def _play(self, seed: int, episode: int, render: bool = False):
        robot, maxsteps = (self._genotype, self._normalisation), self._policy.config.maxsteps
        return self._problem.play(self._policy, *robot, seed, episode, maxsteps, render=render)

    def _seen(self, scene, seed: int, episodes: int):
        from botschool.render.scenes import with_frames

        for episode in range(episodes):
            play = self._play(seed, episode, render=scene is None)
            for transition in with_frames(self._problem, play):
                frame = scene.draw_transition(transition) if scene else transition.frame
                yield frame, episode + 1, transition


def controller_of(robot: Robot, parameters: np.ndarray):
    """Return the controller with these parameters: a function from an observation to the action."""
    policy = Policy(robot.environment, robot.policy.interface, robot.policy.config)
    policy.load(np.asarray(parameters, dtype=np.float64), None)
    policy.reset(0, 0)
    return policy.act
