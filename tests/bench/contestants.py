"""Four ways to play the same problems with the same networks: for comparison.py.

Each contestant plays `ENVIRONMENTS` environments of one problem, each with a network of its own
(observation -> 10 tanh neurons -> linear outputs, with biases), and counts the steps. `Weights` are
single precision, from a genotype of botschool, and shared by all. A new episode begins wherever
one has ended.
"""

from __future__ import annotations

import time
from dataclasses import dataclass, replace

import numpy as np

from botschool import config, problems
from botschool.policies.policy import Policy
from botschool.problems import Episodes

ENVIRONMENTS, STEPS, HIDDEN, SEED = 1024, 1000, 10, 1
PROBLEMS = {
    "CartPole-v1": "cartpole",
    "Pendulum-v1": "pendulum",
    "Acrobot-v1": "acrobot",
    "MountainCarContinuous-v0": "mountaincarcontinuous",
}
"""In common to all contestants -> experiment file."""


@dataclass
class Played:
    """What one call has done."""

    steps: int
    ended: float
    """Episodes that ended, per step."""
    reward: float
    """Mean reward of a step."""


@dataclass
class Weights:
    """The networks of all environments."""

    policy: Policy
    genotypes: np.ndarray
    """Shape (ENVIRONMENTS, genotype size)."""

    @classmethod
    def of(cls, problem: str, data) -> Weights:
        """Random ones (Xavier); `data` is the folder of the experiment files."""
        asked = replace(
            config.load(data / f"{PROBLEMS[problem]}.ini").policy,
            nhiddens=HIDDEN, nlayers=1, bias=1, architecture=0, afunction=2, out_type=3, winit=0,
            normalize=0, clip=0,
        )  # fmt: skip
        policy = Policy(problem, problems.make(problem).interface, asked)
        return cls(policy, np.array([policy.initial(SEED, i) for i in range(ENVIRONMENTS)]))

    def layers(self) -> tuple[np.ndarray, ...]:
        """Float32: hidden biases (n, h), output biases (n, o), weights (n, h, i) and (n, o, h)."""
        i, o = self.policy.interface.observations, self.policy.interface.outputs
        sizes = np.cumsum([HIDDEN, o, HIDDEN * i])
        b1, b2, w1, w2 = np.split(self.genotypes.astype(np.float32), sizes, axis=1)
        return b1, b2, w1.reshape(-1, HIDDEN, i), w2.reshape(-1, o, HIDDEN)

    def random_actions(self, steps: int) -> np.ndarray:
        """For playing without a network: shape (steps, ENVIRONMENTS) or (..., actuators)."""
        face, generator = self.policy.interface, np.random.default_rng(SEED)
        if face.discrete:
            return generator.integers(0, face.outputs, (steps, ENVIRONMENTS), dtype=np.int32)
        shape = (steps, ENVIRONMENTS, face.outputs)
        return generator.uniform(face.low, face.high, shape).astype(np.float32)


class Botschool:
    """Whole episodes in C++: as many of each network as make about STEPS steps."""

    precision = "single"

    def __init__(self, problem: str, weights: Weights, workers: int) -> None:
        self.problem, self.weights, self.workers = problems.make(problem), weights, workers
        first = self._evaluate(Episodes.of(np.arange(ENVIRONMENTS), 1))
        mean = first.steps.mean()
        self.episodes = Episodes.of(np.arange(ENVIRONMENTS), max(1, round(STEPS / mean)))

    def _evaluate(self, episodes: Episodes):
        return self.problem.evaluate(
            self.weights.policy, self.weights.genotypes, None, episodes, self.problem.limit,
            self.workers,
        )  # fmt: skip

    def play(self) -> Played:
        """One native call."""
        outcome = self._evaluate(self.episodes)
        steps = int(outcome.steps.sum())
        # as where every network plays the same number of steps: its share of ends, then the mean
        lengths = outcome.steps.reshape(ENVIRONMENTS, -1).mean(axis=1)
        rewards = outcome.fitness.reshape(ENVIRONMENTS, -1).mean(axis=1) / lengths
        return Played(steps, float((1 / lengths).mean()), float(rewards.mean()))


class Gymnax:
    """The whole rollout under jit, vmap and scan, single precision, on the processor.

    reset: a new episode begins where one has ended, as gymnax's `step` does; else the rollout goes
    on with `step_env`, which is as fast as gymnax can be. network: whether it plays, or random
    actions made before.
    """

    precision = "single"

    def __init__(
        self, problem: str, weights: Weights, workers: int, reset: bool = True, network: bool = True
    ) -> None:
        import gymnax
        import jax
        import jax.numpy as jnp

        env, parameters = gymnax.make(problem)
        discrete = weights.policy.interface.discrete

        def act(layers, observation):
            b1, b2, w1, w2 = layers
            output = w2 @ jnp.tanh(w1 @ observation + b1) + b2
            return jnp.argmax(output) if discrete else output

        def rollout(key, played):
            def step(carry, action):
                key, observation, state = carry
                if network:
                    action = act(played, observation)
                if reset:
                    key, now = jax.random.split(key)
                    observation, state, reward, done, _ = env.step(now, state, action, parameters)
                else:
                    observation, state, reward, done, _ = env.step_env(
                        key, state, action, parameters
                    )
                return (key, observation, state), (reward, done)

            now, key = jax.random.split(key)
            start = (key, *env.reset(now, parameters))
            actions = None if network else played
            _, (rewards, done) = jax.lax.scan(step, start, actions, STEPS)
            return rewards.mean(), done.mean()

        self._keys = jax.random.split(jax.random.key(SEED), ENVIRONMENTS)
        if network:
            self._played = tuple(jnp.asarray(layer) for layer in weights.layers())
        else:
            self._played = jnp.asarray(weights.random_actions(STEPS).swapaxes(0, 1))
        start = time.process_time()
        batch = jax.jit(jax.vmap(rollout))
        self._compiled = batch.lower(self._keys, self._played).compile()
        self.compiling = time.process_time() - start

    def play(self) -> Played:
        """One call of the compiled function."""
        rewards, done = self._compiled(self._keys, self._played)
        rewards.block_until_ready()
        return Played(ENVIRONMENTS * STEPS, float(done.mean()), float(rewards.mean()))


class EnvPool:
    """EnvPool's C++ environments, stepped together; the networks in numpy, single precision."""

    precision = "double, networks single"

    def __init__(self, problem: str, weights: Weights, workers: int, network: bool = True) -> None:
        import envpool

        self._envs = envpool.make(
            problem, env_type="gymnasium", num_envs=ENVIRONMENTS, num_threads=workers, seed=SEED
        )
        self._layers = weights.layers() if network else None
        self._discrete = weights.policy.interface.discrete
        self._random = None if network else weights.random_actions(STEPS)
        self._observations, _ = self._envs.reset()

    def _act(self) -> np.ndarray:
        b1, b2, w1, w2 = self._layers
        hidden = np.tanh(np.matmul(w1, self._observations[:, :, None])[..., 0] + b1)
        output = np.matmul(w2, hidden[:, :, None])[..., 0] + b2
        return output.argmax(axis=1).astype(np.int32) if self._discrete else output

    def play(self) -> Played:
        """STEPS steps of all environments."""
        ended, reward = 0, 0.0
        for t in range(STEPS):
            actions = self._act() if self._layers else self._random[t]
            self._observations, rewards, terminated, truncated, _ = self._envs.step(actions)
            reward += float(rewards.sum())
            ended += int((terminated | truncated).sum())
        steps = ENVIRONMENTS * STEPS - ended  # the call after an end only resets
        return Played(steps, ended / steps, reward / steps)


class Gymnasium:
    """The loop that everybody writes: env.step(policy(observation)), in Python, one core."""

    precision = "double"

    def __init__(self, problem: str, weights: Weights, workers: int, network: bool = True) -> None:
        import gymnasium

        # no wrappers but Gymnasium's own time limit and order check: its fastest form
        self._env = gymnasium.make(problem, disable_env_checker=True)
        self._weights, self._next = weights, 0
        self._random = None if network else list(weights.random_actions(STEPS)[:, 0])

    def play(self) -> Played:
        """STEPS steps of the next network."""
        policy, done, ended, reward = self._weights.policy, True, 0, 0.0
        policy.load(self._weights.genotypes[self._next], None)
        self._next = (self._next + 1) % ENVIRONMENTS
        for t in range(STEPS):
            if done:
                observation, _ = self._env.reset(seed=self._next)
                policy.reset(SEED, self._next)
            action = policy.act(observation) if self._random is None else self._random[t]
            observation, gained, terminated, truncated, _ = self._env.step(action)
            done = terminated or truncated
            ended += done
            reward += float(gained)
        return Played(STEPS, ended / STEPS, reward / STEPS)
