# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
#   kernelspec:
#     display_name: Python 3
#     language: python
#     name: python3
# ---

# %% [markdown]
# # Exercise 13. Inside PPO
#
# The text is `README.md`. Fill in the functions one after another. `botschool grade 13` grades
# them, `botschool grade 13.1` one task.
#
# Everything here is NumPy on plain arrays. A *rollout* is what the policy has lived through before
# an update: the same number of steps in each of several environments, one after another whatever
# ends meanwhile. Its arrays have the shape (steps, envs).

# %%
"""Exercise 13: what PPO computes between two rollouts, and what its network has learnt to see."""

import numpy as np

# %% [markdown]
# ## Task 13.1. Advantages
#
# $$\delta_t = r_t + \gamma\, n_t\, V_{t+1} - V_t, \qquad
# A_t = \delta_t + \gamma \lambda\, n_t\, A_{t+1}$$
#
# $n_t$ is 0 if step $t$ ended its episode, by a time-out too, and else 1. After the last step there
# are no more TD errors, so the $A$ behind it is 0.
#
# To the reward of a step at which time ran out, $\gamma$ times the critic's value of what was
# observed after it is added first (*bootstrapping*). An episode that really ended gets nothing.


# %%
def bootstrapped(
    rewards: np.ndarray,
    terminated: np.ndarray,
    truncated: np.ndarray,
    final_values: np.ndarray,
    gamma: float,
) -> np.ndarray:
    """The rewards, with what the critic expects after the steps at which time ran out.

    All arrays hold floats, have the shape (steps, envs), and stay as they are.

    - terminated, truncated: 1.0 or 0.0, as Gymnasium says after each step. If both are 1.0 (the
      pole falls in the last step that the time limit allows), the episode has ended by itself.
    - final_values: the critic's value of what was observed after each step, before any reset.
    """
    ### BEGIN SOLUTION task 13.1: bootstrap episodes that were cut
    out_of_time = np.asarray(truncated) * (1 - np.asarray(terminated))
    return rewards + gamma * out_of_time * final_values
    ### END SOLUTION


# %%
def advantages(
    rewards: np.ndarray,
    values: np.ndarray,
    episode_starts: np.ndarray,
    last_values: np.ndarray,
    dones: np.ndarray,
    gamma: float,
    gae_lambda: float,
) -> np.ndarray:
    """A of each step, by the formulas above; shape (steps, envs). All arrays hold floats.

    - rewards, values: shape (steps, envs); the critic's value V of what was observed before a step.
    - episode_starts: shape (steps, envs); 1.0 where a step is the first of an episode, else 0.0.
      So step t ended its episode if step t + 1 starts one.
    - last_values, dones: shape (envs,); the value of what was observed after the last step, and
      whether that step ended its episode (1.0 or 0.0), which no later step can tell.
    """
    ### BEGIN SOLUTION task 13.1: estimate the advantages
    steps = len(rewards)
    result, following = np.zeros(np.shape(rewards)), np.zeros(np.shape(last_values))
    for t in reversed(range(steps)):
        last = t == steps - 1
        goes_on = 1 - (dones if last else episode_starts[t + 1])
        next_values = last_values if last else values[t + 1]
        error = rewards[t] + gamma * goes_on * next_values - values[t]
        following = error + gamma * gae_lambda * goes_on * following
        result[t] = following
    return result
    ### END SOLUTION


# %% [markdown]
# ## Task 13.2. The clipped surrogate
#
# $$\rho_t = \frac{p_{\mathrm{now}}(a_t)}{p_{\mathrm{old}}(a_t)}
# = e^{\ln p_{\mathrm{now}}(a_t) - \ln p_{\mathrm{old}}(a_t)}, \qquad
# L = -\frac{1}{N} \sum_t \min\left( \rho_t A_t,\;
# \mathrm{clip}(\rho_t, 1 - \epsilon, 1 + \epsilon)\, A_t \right)$$
#
# Before, the advantages of the batch are normalised: minus their mean, divided by (their standard
# deviation + 1e-8). The deviation is that of a sample, which divides by N - 1.


# %%
def policy_loss(
    log_prob: np.ndarray, old_log_prob: np.ndarray, advantages: np.ndarray, clip_range: float
) -> dict:
    """The loss of the policy for a batch of steps; all arrays have the shape (N,).

    clip_range is the epsilon of the formula. A batch of a single step is not normalised.

    Returns a dict with
    - "loss": L, a float;
    - "clip_fraction": the share of steps whose ratio is farther than clip_range from 1.
    """
    ### BEGIN SOLUTION task 13.2: clip the surrogate
    if len(advantages) > 1:
        advantages = (advantages - advantages.mean()) / (advantages.std(ddof=1) + 1e-8)
    ratio = np.exp(log_prob - old_log_prob)
    clipped = np.clip(ratio, 1 - clip_range, 1 + clip_range)
    return {
        "loss": float(-np.minimum(ratio * advantages, clipped * advantages).mean()),
        "clip_fraction": float(np.mean(np.abs(ratio - 1) > clip_range)),
    }
    ### END SOLUTION


# %% [markdown]
# ## Task 13.3. The loss of the critic
#
# The critic shall predict the *return* of each step, for which PPO takes $A_t + V_t$ with the
# values of the rollout. Its loss is the mean squared difference. Some people clip here too: a
# prediction then counts for at most `clip_range_vf` of movement away from the value in the rollout.


# %%
def value_loss(
    values: np.ndarray,
    old_values: np.ndarray,
    returns: np.ndarray,
    clip_range_vf: float | None = None,
) -> float:
    """Mean squared difference of predictions and returns; all arrays have the shape (N,).

    values are those of the critic now, old_values those in the rollout. Without clip_range_vf the
    predictions are `values`; with it, old_values + (values - old_values), where the difference in
    brackets is cut to -clip_range_vf ... clip_range_vf. A range of 0 is a range, too.
    """
    ### BEGIN SOLUTION task 13.3: compute the loss of the critic
    predictions = values
    if clip_range_vf is not None:
        predictions = old_values + np.clip(values - old_values, -clip_range_vf, clip_range_vf)
    return float(np.mean((returns - predictions) ** 2))
    ### END SOLUTION


# %% [markdown]
# ## Task 13.4. Entropy
#
# For discrete actions with probabilities $p_i$ (softmax of the scores, as in exercise 12) and for
# Gaussian ones with deviations $\sigma_i$:
#
# $$H = -\sum_i p_i \ln p_i \qquad \text{and} \qquad
# H = \sum_i \left( \tfrac{1}{2} + \tfrac{1}{2} \ln 2\pi + \ln \sigma_i \right)$$


# %%
def entropy_of_choices(scores: np.ndarray) -> np.ndarray:
    """The entropy of each step, shape (N,), from scores of shape (N, actions).

    Scores may be as large as 1000, and an action with the probability 0 adds nothing.
    """
    ### BEGIN SOLUTION task 13.4: compute the entropy of choices
    scores = np.asarray(scores, dtype=np.float64)
    shifted = scores - scores.max(axis=1, keepdims=True)
    logarithms = shifted - np.log(np.exp(shifted).sum(axis=1, keepdims=True))
    return -(np.exp(logarithms) * logarithms).sum(axis=1)
    ### END SOLUTION


def entropy_of_gaussians(log_deviation: np.ndarray) -> float:
    """The entropy of a Gaussian action with these ln sigma, shape (actuators,)."""
    ### BEGIN SOLUTION task 13.4: compute the entropy of Gaussians
    return float(np.sum(0.5 + 0.5 * np.log(2 * np.pi) + np.asarray(log_deviation)))
    ### END SOLUTION


# %% [markdown]
# ## Task 13.5. How far has the policy moved?
#
# The divergence of a batch is the mean of $(\rho_t - 1) - \ln \rho_t$. PPO goes through a rollout
# in several *epochs*, and in each of them batch by batch. As soon as the estimate of a batch is
# greater than 1.5 times `target_kl`, training on this rollout is over, and this batch makes no
# update.


# %%
def approx_kl(log_prob: np.ndarray, old_log_prob: np.ndarray) -> float:
    """The estimated divergence of a batch; both arrays have the shape (N,)."""
    ### BEGIN SOLUTION task 13.5: estimate the divergence
    log_ratio = log_prob - old_log_prob
    return float(np.mean(np.exp(log_ratio) - 1 - log_ratio))
    ### END SOLUTION


def updates_made(divergences: list[list[float]], target_kl: float | None) -> int:
    """How many updates PPO makes, given the divergences that it would find on its way.

    divergences: for each epoch the estimate of each batch. target_kl None: no early stop.
    """
    ### BEGIN SOLUTION task 13.5: stop early
    made = 0
    for epoch in divergences:
        for divergence in epoch:
            if target_kl is not None and divergence > 1.5 * target_kl:
                return made
            made += 1
    return made
    ### END SOLUTION


# %% [markdown]
# ## Task 13.6. All together
#
# One loss for everything: the policy's, plus `vf_coef` times the critic's, minus `ent_coef` times
# the mean entropy.
#
# The *explained variance* compares what the critic leaves unexplained with how much the returns
# vary: 1 is perfect, 0 no better than always saying the mean, negative is worse.
#
# $$1 - \frac{\mathrm{var}(R - V)}{\mathrm{var}(R)}$$


# %%
def total_loss(
    policy_loss: float, value_loss: float, entropies: np.ndarray, ent_coef: float, vf_coef: float
) -> float:
    """The loss that the optimiser gets; entropies, shape (N,), are those of the batch's steps."""
    ### BEGIN SOLUTION task 13.6: add up the losses
    return float(policy_loss + vf_coef * value_loss - ent_coef * np.mean(entropies))
    ### END SOLUTION


def explained_variance(values: np.ndarray, returns: np.ndarray) -> float:
    """By the formula above; both arrays have the same shape, and the returns are not all equal."""
    ### BEGIN SOLUTION task 13.6: compute the explained variance
    return float(1 - np.var(returns - values) / np.var(returns))
    ### END SOLUTION


# %% [markdown]
# ## Task 13.7. What the hidden neurons respond to
#
# Each hidden layer computes $\tanh(W x + b)$ of what comes before it, the first one of the
# observation. How closely does a neuron follow a number that is observed? Their correlation over a
# recording is
#
# $$c = \frac{\sum_t (h_t - \bar h)(x_t - \bar x)}
# {\sqrt{\sum_t (h_t - \bar h)^2 \; \sum_t (x_t - \bar x)^2}}$$


# %%
def hidden_activations(
    layers: list[tuple[np.ndarray, np.ndarray]], observations: np.ndarray
) -> list[np.ndarray]:
    """The activations of each hidden layer, shape (N, neurons), from the first to the last.

    layers: for each hidden layer its weights W, shape (neurons, neurons of the layer before), and
    its biases b, shape (neurons,). observations: shape (N, numbers observed).
    """
    ### BEGIN SOLUTION task 13.7: compute the hidden neurons
    activations = []
    for weights, biases in layers:
        observations = np.tanh(observations @ np.asarray(weights).T + biases)
        activations.append(observations)
    return activations
    ### END SOLUTION


def responses(activations: np.ndarray, observations: np.ndarray) -> np.ndarray:
    """The correlation of each neuron with each observed number; shape (neurons, numbers observed).

    activations: shape (N, neurons); observations: shape (N, numbers observed). Where one of the two
    never changes, there is nothing to follow, and the correlation is 0. The mean of equal numbers
    may differ from them by rounding, so compare the numbers themselves.
    """
    ### BEGIN SOLUTION task 13.7: correlate neurons and observations
    h, x = activations - activations.mean(axis=0), observations - observations.mean(axis=0)
    h[:, np.ptp(activations, axis=0) == 0] = 0
    x[:, np.ptp(observations, axis=0) == 0] = 0
    sizes = np.sqrt(np.outer((h**2).sum(axis=0), (x**2).sum(axis=0)))
    return np.divide(h.T @ x, sizes, out=np.zeros_like(sizes), where=sizes > 0)
    ### END SOLUTION


# %% [markdown]
# ## Task 13.8. Your own loop
#
# `ppo` is a `botschool.rl.native.PPO`: it acts, keeps the networks, and computes the loss of 13.6
# with its gradient. You decide what is learned from what.
#
# - `ppo.collect()` acts for a rollout and returns it. Its arrays `rewards` (bootstrapped as in
#   13.1), `values` and `ended` have the shape (steps, envs), `last_values` the shape (envs,).
#   `ended` says of each step what `advantages` is told in two pieces: 0 if its episode goes on, 1
#   if it ended with this step, 2 if time ran out. So `episode_starts` of step t + 1 and, after the
#   last step, `dones` are 1 where `ended` is not 0.
# - `rollout.advantages` and `rollout.returns` are arrays of the same shape, and hold zeros. Write
#   your numbers into them: the critic learns the returns, which are the advantages plus the values.
# - `ppo.minibatch(rows)` returns the steps with these numbers, from 0 to steps times envs - 1;
#   `batch.log_probs` are the log-probabilities of the rollout.
# - `ppo.loss(batch)` returns `log_probs`, those of the present policy, and `gradient`.
# - `ppo.step(gradient)` makes one update against a gradient.
#
# `ppo.hyperparameters` has `n_epochs`, `batch_size`, `gamma`, `gae_lambda` and `target_kl`, and
# `ppo.steps` counts the steps of all environments so far. `ppo.update` and `ppo.learn` are refused.


# %%
def learn(ppo, steps: int, seed: int) -> None:
    """Train until `ppo.steps` is at least `steps`, rollout after rollout.

    Each rollout is gone through n_epochs times. In each epoch every step is in exactly one batch of
    batch_size steps, in a new random order that `seed` decides; batch_size divides the number of
    steps. Training on a rollout ends as in 13.5: before the update of the first batch whose
    divergence is greater than 1.5 times target_kl. target_kl None: no early stop.
    """
    ### BEGIN SOLUTION task 13.8: write the loop
    h, rng = ppo.hyperparameters, np.random.default_rng(seed)
    while ppo.steps < steps:
        rollout = ppo.collect()
        ended = (rollout.ended > 0).astype(float)
        starts = np.vstack([np.ones_like(ended[:1]), ended[:-1]])
        found = advantages(
            rollout.rewards, rollout.values, starts, rollout.last_values, ended[-1],
            h.gamma, h.gae_lambda,
        )  # fmt: skip
        rollout.advantages[:], rollout.returns[:] = found, found + rollout.values
        orders = [rng.permutation(ended.size) for _ in range(h.n_epochs)]
        for rows in np.concatenate(orders).reshape(-1, h.batch_size):
            batch = ppo.minibatch(rows)
            loss = ppo.loss(batch)
            divergence = approx_kl(loss.log_probs, batch.log_probs)
            if h.target_kl is not None and divergence > 1.5 * h.target_kl:
                break
            ppo.step(loss.gradient)
    ### END SOLUTION


# %% [markdown]
# ## Your numbers beside those of Stable-Baselines3
#
# `botschool show 13` runs this part.

# %%
if __name__ == "__main__":
    from botschool.course import film_agent
    from botschool.course.ppo import draw_own_training, train_own
    from botschool.course.rl import draw_hidden_layer
    from botschool.rl.reference import Rollout, make_ppo, policy_layers

    names = ["cart's position", "cart's speed", "pole's angle", "pole's angular speed"]
    model = make_ppo("CartPole-v1", seed=1, n_steps=256, n_envs=4, batch_size=128, n_epochs=6)
    stages = {}
    for stage, steps in (("before training", 0), ("after 40 000 steps", 40_000)):
        if steps:
            model.learn(steps)
        rollout = Rollout(model)
        seen = rollout.observations.reshape(-1, 4)
        layers = policy_layers(model)
        activations = hidden_activations(layers, seen)[-1]
        stages[stage] = (layers, seen, activations, responses(activations, seen))

    rollout.train(3)
    given, logged = rollout.losses(clip_range=0.05, clip_range_vf=0.5, ent_coef=0.01)
    mine = policy_loss(given["log_prob"], given["old_log_prob"], given["advantages"], 0.05)
    critic = value_loss(given["values"], given["old_values"], given["returns"], 0.5)
    estimated = advantages(
        rollout.rewards, rollout.values, rollout.episode_starts, rollout.last_values, rollout.dones,
        rollout.gamma, rollout.gae_lambda,
    )  # fmt: skip
    table = {
        "mean advantage": (estimated.mean(), rollout.advantages.mean()),
        "policy loss": (mine["loss"], logged["policy_gradient_loss"]),
        "clip fraction": (mine["clip_fraction"], logged["clip_fraction"]),
        "value loss": (critic, logged["value_loss"]),
        "approximate KL": (
            approx_kl(given["log_prob"], given["old_log_prob"]), logged["approx_kl"]
        ),
        "loss": (total_loss(mine["loss"], critic, given["entropy"], 0.01, 0.5), logged["loss"]),
        "explained variance": (
            explained_variance(rollout.values, rollout.returns), logged["explained_variance"]
        ),
    }  # fmt: skip
    print(f"{'':20}{'yours':>14}{'theirs':>14}{'difference':>12}")
    for name, (yours, theirs) in table.items():
        print(f"{name:20}{yours:14.8f}{theirs:14.8f}{yours - theirs:12.1e}")
    draw_hidden_layer("hidden_layer.png", stages, names, axes=(2, 3), hidden=hidden_activations)

    runs, reference = [[train_own(way, seed) for seed in range(1, 11)] for way in (learn, None)]
    for name, trained in (("your loop", runs), ("the engine's own loop", reference)):
        lasts = [f"{np.mean(run['returns'][-20:]):.0f}" for run in trained]
        print(f"{name}, seeds 1 to 10, last 20 episodes: {', '.join(lasts)} of 500")
    draw_own_training("own_training.png", runs, reference)
    film_agent("cartpole.mp4", "CartPole-v1", runs[0]["act"], maxsteps=500)
