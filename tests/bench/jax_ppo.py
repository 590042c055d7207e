"""PPO for ppo_libraries.py: environments and learning are one compiled function, as in PureJaxRL.

As in PureJaxRL, the end of time counts as an end of the task: nothing is bootstrapped there.
"""

from __future__ import annotations

import time
from functools import partial
from itertools import pairwise
from typing import Any, NamedTuple

import gymnax
import jax
import jax.numpy as jnp
import numpy as np
import optax

from botschool.rl.parameters import linear


class Moments(NamedTuple):
    """Running mean and variance of columns."""

    mean: jax.Array
    variance: jax.Array
    count: jax.Array

    @classmethod
    def of(cls, columns: int) -> Moments:
        return cls(jnp.zeros(columns), jnp.ones(columns), jnp.asarray(1e-4))

    def merged(self, rows: jax.Array) -> Moments:
        n, away = len(rows), rows.mean(0) - self.mean
        count = self.count + n
        between = away**2 * self.count * n / count
        squares = self.variance * self.count + rows.var(0) * n + between
        return Moments(self.mean + away * n / count, squares / count, count)

    def scaled(self, rows: jax.Array) -> jax.Array:
        return jnp.clip((rows - self.mean) / jnp.sqrt(self.variance + 1e-8), -10, 10)


class State(NamedTuple):
    """All that the rest of a training depends on."""

    weights: dict[str, Any]
    adam: Any
    world: Any
    raw: jax.Array
    seen: Moments
    paid: Moments
    discounted: jax.Array
    key: jax.Array


class Ppo:
    """A training; settings by the names of defaults.yaml. It learns in `parts` parts."""

    def __init__(self, env: str, seed: int, settings: dict[str, Any], parts: int) -> None:
        s = {"n_epochs": 10, "gamma": 0.99, "gae_lambda": 0.95, "learning_rate": 3e-4} | settings
        s = {"clip_range": 0.2, "net_arch": [64, 64], "normalize": False} | s
        self.s, self.length = s, s["steps"]
        self.env, self.world = gymnax.make(env)
        space = self.env.action_space(self.world)
        self.discrete = hasattr(space, "n")
        outputs = space.n if self.discrete else space.shape[0]
        self.inputs = self.env.observation_space(self.world).shape[0]
        self.samples = s["n_steps"] * s["envs"]
        self.updates = max(1, round(self.length / self.samples / parts))
        self.steps_of_a_part = self.updates * self.samples
        self.steps = 0
        minibatches = max(1, self.samples // s["batch_size"])
        updates = -(-self.length // self.samples)

        def schedule(name: str):
            top = linear(s[name])
            if top is None:
                return lambda count: s[name]
            each = minibatches * s["n_epochs"]
            return lambda count: top * (1 - jnp.minimum(1, count // each / updates))

        self.minibatches, self.clip = minibatches, schedule("clip_range")
        adam = optax.adam(schedule("learning_rate"), eps=1e-5)
        self.optimiser = optax.chain(optax.clip_by_global_norm(0.5), adam)
        self.state = self._start(seed, outputs)
        start = time.process_time()
        self._part = jax.jit(self._learn).lower(self.state).compile()
        self._act = jax.jit(self._modes)
        self._modes_now(np.zeros((20, self.inputs), np.float32))
        self.compiling = time.process_time() - start

    def learn(self) -> None:
        """The next part."""
        self.state = jax.block_until_ready(self._part(self.state))
        self.steps += self.steps_of_a_part

    def act(self, observations: np.ndarray) -> np.ndarray:
        """The most probable actions."""
        return self._modes_now(observations)

    def _modes_now(self, observations: np.ndarray) -> np.ndarray:
        return np.asarray(self._act(self.state, observations.astype(np.float32)))

    def _start(self, seed: int, outputs: int) -> State:
        keys = jax.random.split(jax.random.key(seed), 20)
        sizes = [self.inputs, *self.s["net_arch"]]

        def net(keys, out, gain):
            ends = [*pairwise(sizes), (sizes[-1], out)]
            gains = [2**0.5] * (len(ends) - 1) + [gain]
            return [
                (jax.nn.initializers.orthogonal(g)(k, shape), jnp.zeros(shape[1]))
                for k, g, shape in zip(keys, gains, ends, strict=False)
            ]

        weights = {"actor": net(keys[:8], outputs, 0.01), "critic": net(keys[8:16], 1, 1.0)}
        weights["log_std"] = jnp.zeros(outputs)
        starts = jax.random.split(keys[16], self.s["envs"])
        raw, world = jax.vmap(self.env.reset, (0, None))(starts, self.world)
        seen = Moments.of(self.inputs).merged(raw)
        adam = self.optimiser.init(weights)
        none = jnp.zeros(self.s["envs"])
        return State(weights, adam, world, raw, seen, Moments.of(1), none, keys[17])

    def _modes(self, state: State, raw: jax.Array) -> jax.Array:
        outputs = forward(state.weights["actor"], self._normal(state.seen, raw))
        return outputs.argmax(1) if self.discrete else jnp.clip(outputs, *self._range())

    def _range(self) -> tuple[Any, Any]:
        space = self.env.action_space(self.world)
        return space.low, space.high

    def _normal(self, seen: Moments, raw: jax.Array) -> jax.Array:
        return seen.scaled(raw) if self.s["normalize"] else raw

    def _log_probs(self, weights, observations, actions) -> tuple[jax.Array, jax.Array]:
        """Of actions, and the entropy."""
        outputs = forward(weights["actor"], observations)
        if self.discrete:
            log = jax.nn.log_softmax(outputs)
            chosen = jnp.take_along_axis(log, actions[..., None], -1)[..., 0]
            return chosen, -(jnp.exp(log) * log).sum(-1)
        log_std = weights["log_std"]
        z = (actions - outputs) / jnp.exp(log_std)
        constant = log_std + 0.5 * jnp.log(2 * jnp.pi)
        return -(0.5 * z**2 + constant).sum(-1), (constant + 0.5).sum()

    def _step(self, weights, carry, _):
        """One step of all environments."""
        world, raw, seen, paid, discounted, key = carry
        key, draw, going = jax.random.split(key, 3)
        observations = self._normal(seen, raw)
        outputs = forward(weights["actor"], observations)
        if self.discrete:
            actions = motors = jax.random.categorical(draw, outputs)
        else:
            noise = jax.random.normal(draw, outputs.shape)
            actions = outputs + jnp.exp(weights["log_std"]) * noise
            motors = jnp.clip(actions, *self._range())
        log_probs, _ = self._log_probs(weights, observations, actions)
        values = forward(weights["critic"], observations)[:, 0]
        keys = jax.random.split(going, self.s["envs"])
        step = jax.vmap(self.env.step, (0, 0, 0, None))
        raw, world, rewards, done, _ = step(keys, world, motors, self.world)
        if self.s["normalize"]:
            seen = seen.merged(raw)
            discounted = discounted * self.s["gamma"] + rewards
            paid = paid.merged(discounted[:, None])
            rewards = jnp.clip(rewards / jnp.sqrt(paid.variance[0] + 1e-8), -10, 10)
            discounted = discounted * (1 - done)
        kept = (observations, actions, log_probs, values, rewards, done.astype(jnp.float32))
        return (world, raw, seen, paid, discounted, key), kept

    def _loss(self, weights, batch, clip):
        observations, actions, old, advantages, returns = batch
        advantages = (advantages - advantages.mean()) / (advantages.std(ddof=1) + 1e-8)
        log_probs, entropy = self._log_probs(weights, observations, actions)
        ratio = jnp.exp(log_probs - old)
        clipped = jnp.clip(ratio, 1 - clip, 1 + clip)
        policy = -jnp.minimum(ratio * advantages, clipped * advantages).mean()
        value = ((forward(weights["critic"], observations)[:, 0] - returns) ** 2).mean()
        return policy + 0.5 * value - self.s.get("ent_coef", 0.0) * entropy.mean()

    def _update(self, state: State, _):
        """A rollout, its advantages, and all epochs."""
        w, s = state.weights, self.s
        begin = (state.world, state.raw, state.seen, state.paid, state.discounted, state.key)
        carry, kept = jax.lax.scan(partial(self._step, w), begin, None, s["n_steps"])
        world, raw, seen, paid, discounted, key = carry
        observations, actions, log_probs, values, rewards, done = kept
        last = forward(w["critic"], self._normal(seen, raw))[:, 0]

        def back(after, now):
            following, next_value = after
            value, reward, end = now
            delta = reward + s["gamma"] * next_value * (1 - end) - value
            following = delta + s["gamma"] * s["gae_lambda"] * (1 - end) * following
            return (following, value), following

        start = (jnp.zeros_like(last), last)
        _, advantages = jax.lax.scan(back, start, (values, rewards, done), reverse=True)
        columns = (observations, actions, log_probs, advantages, advantages + values)
        data = jax.tree.map(lambda x: x.reshape(-1, *x.shape[2:]), columns)

        def minibatch(carry, rows):
            w, adam = carry
            clip = self.clip(optax.tree.get(adam, "ScaleByAdamState").count)
            gradient = jax.grad(self._loss)(w, jax.tree.map(lambda x: x[rows], data), clip)
            change, adam = self.optimiser.update(gradient, adam)
            return (optax.apply_updates(w, change), adam), None

        key, mix = jax.random.split(key)
        orders = [
            jax.random.permutation(k, self.samples) for k in jax.random.split(mix, s["n_epochs"])
        ]
        rows = jnp.stack(orders).reshape(s["n_epochs"] * self.minibatches, -1)
        (w, adam), _ = jax.lax.scan(minibatch, (w, state.adam), rows)
        return State(w, adam, world, raw, seen, paid, discounted, key), None

    def _learn(self, state: State) -> State:
        return jax.lax.scan(self._update, state, None, self.updates)[0]


def forward(layers, x: jax.Array) -> jax.Array:
    """Outputs of a network with tanh neurons."""
    for w, b in layers[:-1]:
        x = jnp.tanh(x @ w + b)
    w, b = layers[-1]
    return x @ w + b
