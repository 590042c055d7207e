"""Wrong solutions of exercise 13; building.py describes how a case is written."""

# %% end_of_the_wrong_step loses 13.1
# Takes the first step of an episode for its last one.
_advantages = advantages


def advantages(rewards, values, episode_starts, last_values, dones, gamma, gae_lambda):
    shifted = np.concatenate([episode_starts[:1], episode_starts[:-1]])
    return _advantages(rewards, values, shifted, last_values, dones, gamma, gae_lambda)


# %% ends_ignored loses 13.1
# Lets the TD errors after an end count for the actions before it.
# says: Ends of episodes on the way .* are left out
_advantages = advantages


def advantages(rewards, values, episode_starts, last_values, dones, gamma, gae_lambda):
    none = np.zeros_like(episode_starts)
    return _advantages(rewards, values, none, last_values, 0 * dones, gamma, gae_lambda)


# %% lambda_forgotten loses 13.1
# Later TD errors count less by gamma alone.
# says: gae_lambda is left out
_advantages = advantages


def advantages(rewards, values, episode_starts, last_values, dones, gamma, gae_lambda):
    return _advantages(rewards, values, episode_starts, last_values, dones, gamma, 1.0)


# %% last_end_ignored loses 13.1
# Does not look whether the last step ended its episode.
_advantages = advantages


def advantages(rewards, values, episode_starts, last_values, dones, gamma, gae_lambda):
    return _advantages(rewards, values, episode_starts, last_values, 0 * dones, gamma, gae_lambda)


# %% last_value_forgotten loses 13.1
# Takes the rollout for over: nothing comes after its last step.
# says: \(last_values\) is left out
_advantages = advantages


def advantages(rewards, values, episode_starts, last_values, dones, gamma, gae_lambda):
    return _advantages(rewards, values, episode_starts, 0 * last_values, dones, gamma, gae_lambda)


# %% one_step_only loses 13.1
# Stops at the first TD error.
_advantages = advantages


def advantages(rewards, values, episode_starts, last_values, dones, gamma, gae_lambda):
    return _advantages(rewards, values, episode_starts, last_values, dones, gamma, 0.0)


# %% errors_leak loses 13.1
# The TD errors of another episode count for the actions before its start.
# says: TD errors leak over ends
# -         following = error + gamma * gae_lambda * goes_on * following
# +         following = error + gamma * gae_lambda * following


# %% values_leak loses 13.1
# Takes the value of another episode's start for what comes after an end.
# says: Values leak over ends
# -         error = rewards[t] + gamma * goes_on * next_values - values[t]
# +         error = rewards[t] + gamma * next_values - values[t]


# %% ends_bootstrapped loses 13.1
# Adds the critic's value after ends, where no reward comes any more.
# says: Ends are bootstrapped as well
def bootstrapped(rewards, terminated, truncated, final_values, gamma):
    return rewards + gamma * np.maximum(terminated, truncated) * final_values


# %% both_bootstrapped loses 13.1
# Adds the critic's value though the episode ended in the very step at which time ran out.
# says: both terminated and truncated
def bootstrapped(rewards, terminated, truncated, final_values, gamma):
    return rewards + gamma * truncated * final_values


# %% undiscounted_bootstrap loses 13.1
# Adds the critic's value without the discount of one step.
# says: gamma is left out
def bootstrapped(rewards, terminated, truncated, final_values, gamma):
    return rewards + truncated * (1 - terminated) * final_values


# %% never_bootstrapped loses 13.1
# Takes the time limit for an end.
# says: Nothing is added
def bootstrapped(rewards, terminated, truncated, final_values, gamma):
    return np.array(rewards)


# %% bootstrapped_in_place loses 13.1
# Changes the rewards of the rollout itself.
# says: has changed the rewards
def bootstrapped(rewards, terminated, truncated, final_values, gamma):
    rewards += gamma * truncated * (1 - terminated) * final_values
    return rewards


# %% asks_stable_baselines loses 13.1, 13.4, 13.6
# Hands in what Stable-Baselines3 and torch compute.
import torch
from gymnasium import spaces
from stable_baselines3.common.buffers import RolloutBuffer
from stable_baselines3.common.distributions import CategoricalDistribution
from stable_baselines3.common.utils import explained_variance as theirs


def advantages(rewards, values, episode_starts, last_values, dones, gamma, gae_lambda):
    steps, envs = np.shape(rewards)
    box = spaces.Box(-1, 1, (1,))
    buffer = RolloutBuffer(steps, box, box, "cpu", gae_lambda, gamma, envs)
    buffer.rewards, buffer.values, buffer.episode_starts = rewards, values, episode_starts
    buffer.advantages = np.zeros((steps, envs))
    buffer.compute_returns_and_advantage(torch.from_numpy(last_values), dones)
    return buffer.advantages


def entropy_of_choices(scores):
    distribution = CategoricalDistribution(scores.shape[1])
    distribution.proba_distribution(torch.from_numpy(scores))
    return distribution.entropy().numpy()


def explained_variance(values, returns):
    return float(theirs(np.ravel(values), np.ravel(returns)))


# %% always_clipped loses 13.2
# Takes the clipped product always, instead of the smaller one of the two.
_policy_loss = policy_loss


def policy_loss(log_prob, old_log_prob, advantages, clip_range):
    ratio = np.exp(log_prob - old_log_prob)
    cut = np.log(np.clip(ratio, 1 - clip_range, 1 + clip_range))
    loss = _policy_loss(cut, 0 * cut, advantages, clip_range)["loss"]
    return {"loss": loss, "clip_fraction": float((abs(ratio - 1) > clip_range).mean())}


# %% clips_the_logarithm loses 13.2
# Counts as clipped what is far from 0 in the logarithm.
_policy_loss = policy_loss


def policy_loss(log_prob, old_log_prob, advantages, clip_range):
    found = _policy_loss(log_prob, old_log_prob, advantages, clip_range)
    return {**found, "clip_fraction": float((abs(log_prob - old_log_prob) > clip_range).mean())}


# %% not_normalised loses 13.2
# Takes the advantages as they are.
# says: not normalised
def policy_loss(log_prob, old_log_prob, advantages, clip_range):
    ratio = np.exp(log_prob - old_log_prob)
    clipped = np.clip(ratio, 1 - clip_range, 1 + clip_range)
    loss = -np.minimum(ratio * advantages, clipped * advantages).mean()
    return {"loss": float(loss), "clip_fraction": float((abs(ratio - 1) > clip_range).mean())}


# %% population_deviation loses 13.2
# The deviation divides by N.
_policy_loss = policy_loss


def policy_loss(log_prob, old_log_prob, advantages, clip_range):
    n = len(advantages)
    found = _policy_loss(log_prob, old_log_prob, advantages, clip_range)
    return {**found, "loss": found["loss"] * np.sqrt(n / max(1, n - 1))}


# %% sign_of_the_loss loses 13.2
# Makes the surrogate small instead of large.
# says: Only the sign
_policy_loss = policy_loss


def policy_loss(log_prob, old_log_prob, advantages, clip_range):
    found = _policy_loss(log_prob, old_log_prob, advantages, clip_range)
    return {**found, "loss": -found["loss"]}


# %% single_step_normalised loses 13.2
# Normalises a batch of a single step, which leaves nothing of it.
_policy_loss = policy_loss


def policy_loss(log_prob, old_log_prob, advantages, clip_range):
    found = _policy_loss(log_prob, old_log_prob, advantages, clip_range)
    return {**found, "loss": 0.0} if len(advantages) == 1 else found


# %% limit_counts_as_clipped loses 13.2
# Counts a ratio as clipped that is exactly at the limit.
# says: not farther than it
# -         "clip_fraction": float(np.mean(np.abs(ratio - 1) > clip_range)),
# +         "clip_fraction": float(np.mean(np.abs(ratio - 1) >= clip_range)),


# %% zero_clips_nothing loses 13.3
# Takes a clip range of 0 for none.
# says: allows no movement
# -     if clip_range_vf is not None:
# +     if clip_range_vf:


# %% half_the_square loses 13.3
# Halves the squared difference, as some do.
# says: half of what was expected
_value_loss = value_loss


def value_loss(values, old_values, returns, clip_range_vf=None):
    return _value_loss(values, old_values, returns, clip_range_vf) / 2


# %% value_clipped_around_the_return loses 13.3
# Clips the error instead of the movement.
_value_loss = value_loss


def value_loss(values, old_values, returns, clip_range_vf=None):
    if clip_range_vf is None:
        return _value_loss(values, old_values, returns)
    return float(np.mean(np.clip(returns - values, -clip_range_vf, clip_range_vf) ** 2))


# %% value_never_clipped loses 13.3
# Ignores the clipping.
# says: is not clipped
_value_loss = value_loss


def value_loss(values, old_values, returns, clip_range_vf=None):
    return _value_loss(values, old_values, returns)


# %% entropy_in_bits loses 13.4
# Takes the logarithm to the base 2.
# says: in bits
_entropy_of_choices = entropy_of_choices


def entropy_of_choices(scores):
    return _entropy_of_choices(scores) / np.log(2)


# %% entropy_of_nothing loses 13.4
# An action of probability 0 makes the entropy no number.
def entropy_of_choices(scores):
    with np.errstate(all="ignore"):
        powers = np.exp(scores - scores.max(axis=1, keepdims=True))
        shares = powers / powers.sum(axis=1, keepdims=True)
        return -(shares * np.log(shares)).sum(axis=1)


# %% entropy_of_one_actuator loses 13.4
# The mean over the actuators instead of the sum.
_entropy_of_gaussians = entropy_of_gaussians


def entropy_of_gaussians(log_deviation):
    return _entropy_of_gaussians(log_deviation) / len(log_deviation)


# %% asks_later loses 13.4, 13.5, 13.6
# Hands in what Stable-Baselines3 and torch compute.
def entropy_of_gaussians(log_deviation):
    import torch

    normal = torch.distributions.Normal(0.0, torch.tensor(log_deviation).exp())
    return float(normal.entropy().sum())


def updates_made(divergences, target_kl):
    from botschool.rl.reference import updates_made

    return updates_made([[(2 * each) ** 0.5 for each in some] for some in divergences], target_kl)


def explained_variance(values, returns):
    from stable_baselines3.common.utils import explained_variance

    return float(explained_variance(np.ravel(values), np.ravel(returns)))


# %% simple_estimate loses 13.5
# The mean of minus the logarithm, which is right only on average.
def approx_kl(log_prob, old_log_prob):
    return float(np.mean(old_log_prob - log_prob))


# %% stops_after_the_update loses 13.5
# Makes one more update with the batch that was too far.
# says: one more than expected
_updates_made = updates_made


def updates_made(divergences, target_kl):
    total = sum(map(len, divergences))
    return min(total, _updates_made(divergences, target_kl) + 1)


# %% stops_at_the_target loses 13.5
# Stops at the target itself instead of one and a half times as much.
_updates_made = updates_made


def updates_made(divergences, target_kl):
    return _updates_made(divergences, None if target_kl is None else target_kl / 1.5)


# %% stops_the_epoch_only loses 13.5
# Ends the epoch, and begins the next one.
_updates_made = updates_made


def updates_made(divergences, target_kl):
    return sum(_updates_made([epoch], target_kl) for epoch in divergences)


# %% stops_when_equal loses 13.5
# Stops at a divergence that equals the limit.
# -             if target_kl is not None and divergence > 1.5 * target_kl:
# +             if target_kl is not None and divergence >= 1.5 * target_kl:


# %% zero_target_never_stops loses 13.5
# Takes a target of 0 for none.
# -             if target_kl is not None and divergence > 1.5 * target_kl:
# +             if target_kl and divergence > 1.5 * target_kl:


# %% entropy_is_punished loses 13.6
# Adds the entropy to the loss instead of subtracting it.
# says: The entropy is added
_total_loss = total_loss


def total_loss(policy_loss, value_loss, entropies, ent_coef, vf_coef):
    return _total_loss(policy_loss, value_loss, entropies, -ent_coef, vf_coef)


# %% squared_correlation loses 13.6
# Takes the squared correlation for the explained variance.
def explained_variance(values, returns):
    return float(np.corrcoef(values.ravel(), returns.ravel())[0, 1] ** 2)


# %% covariance loses 13.7
# The covariance, which depends on the units.
def responses(activations, observations):
    h, x = activations - activations.mean(axis=0), observations - observations.mean(axis=0)
    return h.T @ x / len(h)


# %% linear_layers loses 13.7
# Forgets tanh between the layers.
# -         observations = np.tanh(observations @ np.asarray(weights).T + biases)
# -         activations.append(observations)
# +         observations = observations @ np.asarray(weights).T + biases
# +         activations.append(np.tanh(observations))


# %% nothing_to_follow loses 13.7
# Divides by 0 where something never changes.
def responses(activations, observations):
    h, x = activations - activations.mean(axis=0), observations - observations.mean(axis=0)
    with np.errstate(all="ignore"):
        return (h / np.sqrt((h**2).sum(0))).T @ (x / np.sqrt((x**2).sum(0)))


# %% returns_for_advantages loses 13.1
# The values are added again: it gives the returns that the critic learns, not the advantages.
# says: this
# -         result[t] = following
# -     return result
# +         result[t] = following
# +     return result + values


# %% no_discount loses 13.1
# gamma is left out of the TD error.
# says: this
# -         error = rewards[t] + gamma * goes_on * next_values - values[t]
# +         error = rewards[t] + goes_on * next_values - values[t]


# %% standardised_over_the_rollout loses 13.1
# The advantages are normalised already here.
# says: this
# -         result[t] = following
# -     return result
# +         result[t] = following
# +     return (result - result.mean()) / (result.std() + 1e-8)


# %% ratio_upside_down loses 13.2
# The ratio is that of the old probability to the new one.
# says: this
# -     ratio = np.exp(log_prob - old_log_prob)
# +     ratio = np.exp(old_log_prob - log_prob)


# %% clips_the_product loses 13.2
# The product of ratio and advantage is clipped, not the ratio.
# says: this
# -     clipped = np.clip(ratio, 1 - clip_range, 1 + clip_range)
# -     return {
# -         "loss": float(-np.minimum(ratio * advantages, clipped * advantages).mean()),
# +     clipped = np.clip(ratio * advantages, 1 - clip_range, 1 + clip_range)
# +     return {
# +         "loss": float(-np.minimum(ratio * advantages, clipped).mean()),


# %% sum_over_the_batch loses 13.2
# The loss is the sum over the batch, not the mean.
# says: this
# -         "loss": float(-np.minimum(ratio * advantages, clipped * advantages).mean()),
# +         "loss": float(-np.minimum(ratio * advantages, clipped * advantages).sum()),


# %% clipped_upwards_only loses 13.2
# Only ratios above 1 + clip_range count as clipped.
# says: this
# -         "clip_fraction": float(np.mean(np.abs(ratio - 1) > clip_range)),
# +         "clip_fraction": float(np.mean(ratio - 1 > clip_range)),


# %% larger_of_two_value_losses loses 13.3
# Takes the larger one of the clipped and the unclipped loss, as some libraries do.
# says: this
# -     return float(np.mean((returns - predictions) ** 2))
# +     both = (returns - predictions) ** 2, (returns - values) ** 2
# +     return float(np.mean(np.maximum(*both)))


# %% movement_cut_to_one_side loses 13.3
# The values may fall as far as they like: only rises are cut.
# says: this
# -         predictions = old_values + np.clip(values - old_values, -clip_range_vf, clip_range_vf)
# +         predictions = old_values + np.minimum(values - old_values, clip_range_vf)


# %% mean_entropy_of_the_batch loses 13.4
# The entropy is the mean of the batch, not one number for each step.
# -     return -(np.exp(logarithms) * logarithms).sum(axis=1)
# +     return np.full(len(scores), -(np.exp(logarithms) * logarithms).sum(axis=1).mean())


# %% deviation_for_its_logarithm loses 13.4
# Takes the argument for the deviation itself.
# says: this
# -     return float(np.sum(0.5 + 0.5 * np.log(2 * np.pi) + np.asarray(log_deviation)))
# +     return float(np.sum(0.5 + 0.5 * np.log(2 * np.pi) + np.log(np.abs(log_deviation))))


# %% divergence_the_other_way_round loses 13.5
# The ratio is turned around: it is the divergence of the new policy from the old one's steps.
# says: this
# -     log_ratio = log_prob - old_log_prob
# +     log_ratio = old_log_prob - log_prob


# %% half_the_squared_difference loses 13.5
# Half the mean squared difference of the logarithms, which is close for small ones only.
# says: this
# -     return float(np.mean(np.exp(log_ratio) - 1 - log_ratio))
# +     return float(np.mean(log_ratio**2) / 2)


# %% stops_when_the_mean_is_too_far loses 13.5
# Looks at the mean divergence of an epoch, not at each batch.
# says: this
# -     for epoch in divergences:
# -         for divergence in epoch:
# -             if target_kl is not None and divergence > 1.5 * target_kl:
# -                 return made
# -             made += 1
# +     for epoch in divergences:
# +         if target_kl is not None and np.mean(epoch) > 1.5 * target_kl:
# +             return made
# +         made += len(epoch)


# %% sum_of_the_entropies loses 13.6
# The entropies of the batch are added up, not averaged.
# says: this
# -     return float(policy_loss + vf_coef * value_loss - ent_coef * np.mean(entropies))
# +     return float(policy_loss + vf_coef * value_loss - ent_coef * np.sum(entropies))


# %% coefficients_exchanged loses 13.6
# The coefficients of entropy and value loss are exchanged.
# says: this
# -     return float(policy_loss + vf_coef * value_loss - ent_coef * np.mean(entropies))
# +     return float(policy_loss + ent_coef * value_loss - vf_coef * np.mean(entropies))


# %% squared_error_for_variance loses 13.6
# The mean squared error takes the place of the variance of the error: a constant error counts.
# says: this
# -     return float(1 - np.var(returns - values) / np.var(returns))
# +     return float(1 - np.mean((returns - values) ** 2) / np.var(returns))


# %% never_below_zero loses 13.6
# The explained variance is never negative.
# says: this
# -     return float(1 - np.var(returns - values) / np.var(returns))
# +     return max(0.0, float(1 - np.var(returns - values) / np.var(returns)))


# %% without_biases loses 13.7
# The biases are left out.
# says: this
# -         observations = np.tanh(observations @ np.asarray(weights).T + biases)
# +         observations = np.tanh(observations @ np.asarray(weights).T)


# %% last_layer_only loses 13.7
# Returns the last hidden layer alone.
# -         activations.append(observations)
# +         activations = [observations]


# %% loop_without_returns loses 13.8
# The returns are not written into the rollout: the critic learns zeros.
# says: this
# -         rollout.advantages[:], rollout.returns[:] = found, found + rollout.values
# +         rollout.advantages[:] = found


# %% loop_against_the_gradient loses 13.8
# Follows the gradient uphill.
# -             ppo.step(loss.gradient)
# +             ppo.step(-loss.gradient)


# %% loop_with_one_order loses 13.8
# The steps are never shuffled.
# -         orders = [rng.permutation(ended.size) for _ in range(h.n_epochs)]
# +         orders = [np.arange(ended.size) for _ in range(h.n_epochs)]


# %% loop_with_one_epoch loses 13.8
# Goes through each rollout once.
# -         orders = [rng.permutation(ended.size) for _ in range(h.n_epochs)]
# +         orders = [rng.permutation(ended.size)]


# %% loop_without_early_stop loses 13.8
# The divergence is never looked at.
# -             if h.target_kl is not None and divergence > 1.5 * h.target_kl:
# +             if divergence > 100:


# %% loop_stops_late loses 13.8
# The batch that is too far still makes its update.
# -             if h.target_kl is not None and divergence > 1.5 * h.target_kl:
# -                 break
# -             ppo.step(loss.gradient)
# +             ppo.step(loss.gradient)
# +             if h.target_kl is not None and divergence > 1.5 * h.target_kl:
# +                 break


# %% loop_forgets_ends loses 13.8
# Episodes do not end in the advantages.
# -         ended = (rollout.ended > 0).astype(float)
# +         ended = np.zeros_like(rollout.ended)


# %% loop_with_the_same_order_in_each_epoch loses 13.8
# One order is drawn for all epochs of a rollout.
# -         orders = [rng.permutation(ended.size) for _ in range(h.n_epochs)]
# +         orders = [rng.permutation(ended.size)] * h.n_epochs
# %% final_values_of_the_next_step loses 13.1
# Takes the value one step too late: that of the observation after the next step.
# -     return rewards + gamma * out_of_time * final_values
# +     return rewards + gamma * out_of_time * np.roll(final_values, -1, axis=0)
# %% value_for_the_reward loses 13.1
# The critic's value replaces the reward of the step at which time ran out, instead of being added.
# -     return rewards + gamma * out_of_time * final_values
# +     return np.where(out_of_time > 0, gamma * final_values, rewards)
# %% value_of_the_same_step loses 13.1
# Takes the values of the same step for what comes after it.
# -         next_values = last_values if last else values[t + 1]
# +         next_values = last_values if last else values[t]
# %% environments_mixed loses 13.1
# The sum of later errors is one number for all environments.
# -         result[t] = following
# +         following = np.full(np.shape(following), following.mean())
# +         result[t] = following
# %% normalised_by_the_range loses 13.2
# The advantages are divided by their range instead of their standard deviation.
# -         advantages = (advantages - advantages.mean()) / (advantages.std(ddof=1) + 1e-8)
# +         advantages = (advantages - advantages.mean()) / (np.ptp(advantages) + 1e-8)
# %% mean_not_subtracted loses 13.2
# The advantages are divided by their deviation, but their mean stays.
# -         advantages = (advantages - advantages.mean()) / (advantages.std(ddof=1) + 1e-8)
# +         advantages = advantages / (advantages.std(ddof=1) + 1e-8)
# %% larger_product loses 13.2
# Takes the larger of the two products instead of the smaller one.
# -         "loss": float(-np.minimum(ratio * advantages, clipped * advantages).mean()),
# +         "loss": float(-np.maximum(ratio * advantages, clipped * advantages).mean()),
# %% movement_from_the_new_value loses 13.3
# The cut movement is added to the new values instead of the old ones.
# -         predictions = old_values + np.clip(values - old_values, -clip_range_vf, clip_range_vf)
# +         predictions = values + np.clip(values - old_values, -clip_range_vf, clip_range_vf)
# %% absolute_error loses 13.3
# The mean absolute difference takes the place of the mean square.
# -     return float(np.mean((returns - predictions) ** 2))
# +     return float(np.mean(np.abs(returns - predictions)))
# %% half_missing_in_the_entropy loses 13.4
# The constant lacks its one half: the entropy of a Gaussian is too small.
# -     return float(np.sum(0.5 + 0.5 * np.log(2 * np.pi) + np.asarray(log_deviation)))
# +     return float(np.sum(0.5 * np.log(2 * np.pi) + np.asarray(log_deviation)))
# %% entropy_along_the_batch loses 13.4
# The probabilities of each action over the steps add up to 1, instead of those of each step.
# -     logarithms = shifted - np.log(np.exp(shifted).sum(axis=1, keepdims=True))
# +     logarithms = shifted - np.log(np.exp(shifted).sum(axis=0, keepdims=True))
# %% counts_epochs loses 13.5
# Counts epochs that were completed, not updates.
# -             made += 1
# +             pass
# +         made += 1
# %% variance_of_the_values loses 13.6
# Divides by the variance of the predictions instead of that of the returns.
# -     return float(1 - np.var(returns - values) / np.var(returns))
# +     return float(1 - np.var(returns - values) / np.var(values))
# %% value_loss_halved loses 13.6
# The value loss is halved before it is added.
# -     return float(policy_loss + vf_coef * value_loss - ent_coef * np.mean(entropies))
# +     return float(policy_loss + 0.5 * vf_coef * value_loss - ent_coef * np.mean(entropies))
# %% all_layers_see_the_first loses 13.7
# Every later layer sees the activations of the first one, not those of the layer before.
# -         observations = np.tanh(observations @ np.asarray(weights).T + biases)
# -         activations.append(observations)
# +         seen = observations if not activations else activations[0]
# +         activations.append(np.tanh(seen @ np.asarray(weights).T + biases))
# %% observations_not_centred loses 13.7
# The mean of the observations is not subtracted before they are correlated.
# -     h, x = activations - activations.mean(axis=0), observations - observations.mean(axis=0)
# +     h, x = activations - activations.mean(axis=0), observations.copy()
# %% loop_with_values_as_returns loses 13.8
# The returns are the advantages alone; the values are not added.
# -         rollout.advantages[:], rollout.returns[:] = found, found + rollout.values
# +         rollout.advantages[:], rollout.returns[:] = found, found
# %% loop_with_lambda_one loses 13.8
# The advantages are computed with lambda 1, whatever the hyperparameters say.
# -             h.gamma, h.gae_lambda,
# +             h.gamma, 1.0,


# %% stop_ends_the_epoch loses 13.8
# The early stop ends one epoch only.
# says: ends all epochs of a rollout
# -         orders = [rng.permutation(ended.size) for _ in range(h.n_epochs)]
# -         for rows in np.concatenate(orders).reshape(-1, h.batch_size):
# -             batch = ppo.minibatch(rows)
# -             loss = ppo.loss(batch)
# -             divergence = approx_kl(loss.log_probs, batch.log_probs)
# -             if h.target_kl is not None and divergence > 1.5 * h.target_kl:
# -                 break
# -             ppo.step(loss.gradient)
# +         for _ in range(h.n_epochs):
# +             for rows in rng.permutation(ended.size).reshape(-1, h.batch_size):
# +                 batch = ppo.minibatch(rows)
# +                 loss = ppo.loss(batch)
# +                 divergence = approx_kl(loss.log_probs, batch.log_probs)
# +                 if h.target_kl is not None and divergence > 1.5 * h.target_kl:
# +                     break
# +                 ppo.step(loss.gradient)


# %% time_runs_on loses 13.8
# An episode that time has ended runs on into the next one.
# says: both episodes of the rollout end because time runs out
# -         ended = (rollout.ended > 0).astype(float)
# +         ended = (rollout.ended == 1).astype(float)


# %% share_that_lost loses 13.2
# Counts the steps in which the clipped product is the smaller one, not all ratios that are far.
# says: this
# -         "clip_fraction": float(np.mean(np.abs(ratio - 1) > clip_range)),
# +         "clip_fraction": float(np.mean(clipped * advantages < ratio * advantages)),


# %% ratio_of_the_logarithms loses 13.2
# Divides the logarithms of the probabilities instead of taking the exponential of their difference.
# says: this
# -     ratio = np.exp(log_prob - old_log_prob)
# +     ratio = log_prob / old_log_prob


# %% constant_of_one_actuator loses 13.4
# The constant counts once, but it counts for each actuator.
# says: this
# -     return float(np.sum(0.5 + 0.5 * np.log(2 * np.pi) + np.asarray(log_deviation)))
# +     return float(0.5 + 0.5 * np.log(2 * np.pi) + np.sum(log_deviation))


# %% exponential_of_the_logarithm loses 13.4
# Adds sigma where ln sigma belongs.
# says: this
# -     return float(np.sum(0.5 + 0.5 * np.log(2 * np.pi) + np.asarray(log_deviation)))
# +     return float(np.sum(0.5 + 0.5 * np.log(2 * np.pi) + np.exp(log_deviation)))


# %% variance_of_the_predictions loses 13.6
# Compares the variance of the predictions with that of the returns, not that of their difference.
# says: this
# -     return float(1 - np.var(returns - values) / np.var(returns))
# +     return float(np.var(values) / np.var(returns))


# %% rectified loses 13.7
# The hidden neurons are cut off at 0 (ReLU) where tanh is asked for.
# says: this
# -         observations = np.tanh(observations @ np.asarray(weights).T + biases)
# +         observations = np.maximum(0, observations @ np.asarray(weights).T + biases)


# %% means_stay loses 13.7
# The means are not subtracted before neurons and observations are multiplied.
# says: this
# -     h, x = activations - activations.mean(axis=0), observations - observations.mean(axis=0)
# +     h, x = np.array(activations), np.array(observations)


# %% lost_arrays loses 13.8
# The advantages and returns are not written into the arrays of the rollout.
# says: this
# -         rollout.advantages[:], rollout.returns[:] = found, found + rollout.values
# +         own = found, found + rollout.values
# +         assert len(own) == 2


# %% first_step_for_the_last loses 13.8
# Whether the first step ended its episode is taken for whether the last one did.
# says: both episodes of the rollout end because time runs out
# -             rollout.rewards, rollout.values, starts, rollout.last_values, ended[-1],
# +             rollout.rewards, rollout.values, starts, rollout.last_values, ended[0],


# %% clips_the_values loses 13.3
# Clips the predictions themselves instead of their movement.
# says: this
# -         predictions = old_values + np.clip(values - old_values, -clip_range_vf, clip_range_vf)
# +         predictions = np.clip(values, -clip_range_vf, clip_range_vf)


# %% shares_of_the_scores loses 13.4
# Takes shares of the scores for probabilities: softmax is missing.
# says: this
def entropy_of_choices(scores):
    shares = np.abs(scores) / np.abs(scores).sum(axis=1, keepdims=True)
    return -(shares * np.log(shares)).sum(axis=1)


# %% all_layers_after_the_first loses 13.7
# Each layer gets the activations of the first one instead of those of the layer before.
# says: Layer 3 gets the activations of layer 1
# -         observations = np.tanh(observations @ np.asarray(weights).T + biases)
# -         activations.append(observations)
# +         before = activations[0] if activations else observations
# +         activations.append(np.tanh(before @ np.asarray(weights).T + biases))


# %% a_single_rollout loses 13.8
# Collects one rollout, however many steps are asked for.
# says: this
# -     while ppo.steps < steps:
# +     if ppo.steps < steps:


# %% divergences_add_up loses 13.5
# Adds up the divergences of all batches so far, where each batch is to be judged alone.
# says: this
# -             if target_kl is not None and divergence > 1.5 * target_kl:
# -                 return made
# -             made += 1
# +             total = divergence + (total if made else 0.0)
# +             if target_kl is not None and total > 1.5 * target_kl:
# +                 return made
# +             made += 1


# %% logarithm_clipped loses 13.2
# The logarithm of the ratio is clipped to -clip_range ... clip_range, not the ratio around 1.
# says: this
# -     clipped = np.clip(ratio, 1 - clip_range, 1 + clip_range)
# +     clipped = np.exp(np.clip(log_prob - old_log_prob, -clip_range, clip_range))


# %% returns_of_one_step loses 13.8
# The critic learns the reward plus the discounted next value, not advantages plus values.
# says: as returns reward plus gamma times the next value
# -         rollout.advantages[:], rollout.returns[:] = found, found + rollout.values
# +         following = np.vstack([rollout.values[1:], rollout.last_values[None]])
# +         rollout.advantages[:] = found
# +         rollout.returns[:] = rollout.rewards + h.gamma * (1 - ended) * following


# %% whole_epoch_left_out loses 13.5
# An epoch with a batch that is too far makes no update at all, not even those before that batch.
# says: this
# -     for epoch in divergences:
# -         for divergence in epoch:
# -             if target_kl is not None and divergence > 1.5 * target_kl:
# -                 return made
# -             made += 1
# +     for epoch in divergences:
# +         if target_kl is not None and max(epoch) > 1.5 * target_kl:
# +             return made
# +         made += len(epoch)


# %% ends_of_the_step_after loses 13.1
# The recursion looks at the end of the step after, so that later errors leak over an end.
# says: this
# -         following = error + gamma * gae_lambda * goes_on * following
# -         result[t] = following
# -     return result
# +         result[t] = error
# +     ends = np.concatenate([episode_starts[1:], np.reshape(dones, (1, *np.shape(last_values)))])
# +     for t in range(steps - 2, -1, -1):
# +         result[t] += gamma * gae_lambda * (1 - ends[t + 1]) * result[t + 1]
# +     return result


# %% ratios_divided_by_their_mean loses 13.2
# The ratios are divided by their mean in the batch.
# says: this
# -     ratio = np.exp(log_prob - old_log_prob)
# +     ratio = np.exp(log_prob - old_log_prob)
# +     ratio = ratio / ratio.mean()


# %% mean_divergence_so_far loses 13.5
# Looks at the mean divergence of the epoch so far, not at that of the batch.
# says: this
# -         for divergence in epoch:
# -             if target_kl is not None and divergence > 1.5 * target_kl:
# +         for k in range(len(epoch)):
# +             if target_kl is not None and np.mean(epoch[: k + 1]) > 1.5 * target_kl:


# %% variances_of_the_columns loses 13.6
# Takes the variances of each column by itself, then their means.
# says: this
# -     return float(1 - np.var(returns - values) / np.var(returns))
# +     left, whole = np.var(returns - values, axis=0), np.var(returns, axis=0)
# +     return float(1 - left.mean() / whole.mean())


# %% any_end_ends_all loses 13.1
# Where the episode of one environment ends, those of all environments are taken for ended.
# says: this
# -         goes_on = 1 - (dones if last else episode_starts[t + 1])
# +         goes_on = 1 - np.max(dones if last else episode_starts[t + 1])


# %% last_value_of_the_first_environment loses 13.1
# The value of the first environment's last observation is taken for all environments.
# says: this
# -         next_values = last_values if last else values[t + 1]
# +         next_values = last_values[0] if last else values[t + 1]


# %% bootstrapped_by_reward loses 13.1
# The reward is discounted, too, where time ran out: only the value behind it is.
# says: this
# -     return rewards + gamma * out_of_time * final_values
# +     return np.where(out_of_time > 0, gamma * (rewards + final_values), rewards)


# %% first_environment_alone loses 13.1
# The ends of the first environment are taken for those of all.
# says: this
# -         goes_on = 1 - (dones if last else episode_starts[t + 1])
# +         goes_on = 1 - (dones if last else episode_starts[t + 1])[0]


# %% minimum_of_means loses 13.2
# The smaller of the two means is taken, not the mean of the smaller products.
# says: this
# -         "loss": float(-np.minimum(ratio * advantages, clipped * advantages).mean()),
# +         "loss": float(-min((ratio * advantages).mean(), (clipped * advantages).mean())),


# %% fraction_of_low_ratios loses 13.2
# Only ratios below 1 - clip_range count as clipped.
# says: this
# -         "clip_fraction": float(np.mean(np.abs(ratio - 1) > clip_range)),
# +         "clip_fraction": float(np.mean(1 - ratio > clip_range)),


# %% ratio_of_values loses 13.3
# The ratio of the new values to the old ones is clipped, not their difference.
# says: this
# -         predictions = old_values + np.clip(values - old_values, -clip_range_vf, clip_range_vf)
# +         ratio = np.clip(values / old_values, 1 - clip_range_vf, 1 + clip_range_vf)
# +         predictions = old_values * ratio


# %% smaller_of_two_value_losses loses 13.3
# Takes the smaller one of the clipped and the unclipped loss in each step.
# says: this
# -     return float(np.mean((returns - predictions) ** 2))
# +     return float(np.mean(np.minimum((returns - predictions) ** 2, (returns - values) ** 2)))


# %% surprise_of_all_actions loses 13.4
# The logarithms are not weighted by the probabilities: their mean is taken.
# says: this
# -     return -(np.exp(logarithms) * logarithms).sum(axis=1)
# +     return -logarithms.mean(axis=1)


# %% entropy_divided_by_its_largest loses 13.4
# The entropy is divided by the logarithm of the number of actions, the largest that it can be.
# says: this
# -     return -(np.exp(logarithms) * logarithms).sum(axis=1)
# +     return -(np.exp(logarithms) * logarithms).sum(axis=1) / np.log(logarithms.shape[1])


# %% variance_for_the_deviation loses 13.4
# ln sigma is taken for the logarithm of the variance: it counts half.
# says: this
# -     return float(np.sum(0.5 + 0.5 * np.log(2 * np.pi) + np.asarray(log_deviation)))
# +     return float(np.sum(0.5 + 0.5 * np.log(2 * np.pi) + 0.5 * np.asarray(log_deviation)))


# %% counts_within_the_epoch loses 13.5
# The count begins anew in each epoch: these are the updates of the last one.
# says: this
# -         for divergence in epoch:
# +         made = 0
# +         for divergence in epoch:


# %% skips_the_far_batch loses 13.5
# A batch that is too far is left out, and the next ones go on.
# says: this
# -                 return made
# +                 continue


# %% last_entropy loses 13.6
# The entropy of the last step is taken, not the mean.
# says: this
# -     return float(policy_loss + vf_coef * value_loss - ent_coef * np.mean(entropies))
# +     return float(policy_loss + vf_coef * value_loss - ent_coef * entropies[-1])


# %% policy_loss_subtracted loses 13.6
# The policy's loss is subtracted, not added.
# says: this
# -     return float(policy_loss + vf_coef * value_loss - ent_coef * np.mean(entropies))
# +     return float(-policy_loss + vf_coef * value_loss - ent_coef * np.mean(entropies))


# %% amounts_of_responses loses 13.7
# The correlations have no sign: their amounts are taken.
# says: this
# -     return np.divide(h.T @ x, sizes, out=np.zeros_like(sizes), where=sizes > 0)
# +     return abs(np.divide(h.T @ x, sizes, out=np.zeros_like(sizes), where=sizes > 0))


# %% running_sum_not_reset loses 13.1
# The advantage of one environment runs on into the next one: it begins with 0 in each.
# says: this
def advantages(rewards, values, episode_starts, last_values, dones, gamma, gae_lambda):
    n_steps, n_envs = rewards.shape
    adv = np.zeros((n_steps, n_envs))
    gae = 0.0
    for e in range(n_envs):
        for t in range(n_steps - 1, -1, -1):
            if t == n_steps - 1:
                alive, nxt = 1.0 - dones[e], last_values[e]
            else:
                alive, nxt = 1.0 - episode_starts[t + 1, e], values[t + 1, e]
            delta = rewards[t, e] + gamma * nxt * alive - values[t, e]
            gae = delta + gamma * gae_lambda * alive * gae
            adv[t, e] = gae
    return adv


# %% mean_ratio_first loses 13.5
# The ratios are averaged before the formula, but the mean is that of the formula's values.
# says: this
# -     log_ratio = log_prob - old_log_prob
# -     return float(np.mean(np.exp(log_ratio) - 1 - log_ratio))
# +     ratio = np.mean(np.exp(log_prob - old_log_prob))
# +     return float((ratio - 1) - np.log(ratio))


# %% last_error_left_out loses 13.1
# The TD error of the step that ends an episode counts for none of the steps before it.
# says: this
import numpy as np


def td_errors(rewards, values, ended, last_values, gamma):
    next_values = np.concatenate([values[1:], np.reshape(last_values, (1, -1))])
    return rewards + gamma * (1 - ended) * next_values - values


def advantages(rewards, values, episode_starts, last_values, dones, gamma, gae_lambda):
    ended = np.concatenate([episode_starts[1:], np.reshape(dones, (1, -1))])
    delta = td_errors(rewards, values, ended, last_values, gamma)
    T, n_envs = np.shape(rewards)
    adv = np.zeros((T, n_envs))
    for e in range(n_envs):
        for t in range(T):
            weight = 1.0
            adv[t, e] = delta[t, e]
            if ended[t, e]:
                continue
            for k in range(t + 1, T):
                if ended[k, e]:
                    break
                weight *= gamma * gae_lambda
                adv[t, e] += weight * delta[k, e]
    return adv


# %% nothing_clipped_in_one_step loses 13.2
# A batch of one step is not clipped: only the normalisation is left out there.
# says: this
import numpy as np


def policy_loss(log_prob, old_log_prob, advantages, clip_range):
    r = np.exp(np.asarray(log_prob) - np.asarray(old_log_prob))
    outside = (r < 1 - clip_range) | (r > 1 + clip_range)
    fraction = float(outside.sum() / len(r))
    if len(r) == 1:
        return {"loss": float(-r[0] * advantages[0]), "clip_fraction": fraction}
    a = np.asarray(advantages, dtype=float)
    a = (a - np.mean(a)) / (np.std(a, ddof=1) + 1e-8)
    total = 0.0
    for ratio, adv in zip(r, a, strict=True):
        limited = min(max(ratio, 1 - clip_range), 1 + clip_range)
        total += min(ratio * adv, limited * adv)
    return {"loss": float(-total / len(r)), "clip_fraction": fraction}


# %% back_to_the_old_value loses 13.3
# A prediction that has moved too far is put back to the old one, not to the limit around it.
# says: this
# -         predictions = old_values + np.clip(values - old_values, -clip_range_vf, clip_range_vf)
# +         predictions = np.where(
# +             np.abs(values - old_values) <= clip_range_vf, values, old_values
# +         )


# %% scores_cut_at_50 loses 13.4
# Scores are cut to between -50 and 50 against overflow.
# says: this
import numpy as np


def softmax(s):
    e = np.exp(np.clip(s, -50.0, 50.0))  # no overflow
    return e / np.sum(e)


def entropy_of_choices(scores):
    out = []
    for row in np.asarray(scores, dtype=float):
        h = 0.0
        for p in softmax(row):
            if p > 0:
                h -= p * np.log(p)
        out.append(h)
    return np.array(out)


# %% first_batch_for_none loses 13.5
# A first batch beyond the limit is taken for none beyond it: no update is made then.
# says: this
import numpy as np


def updates_made(divergences, target_kl):
    found = [d for epoch in divergences for d in epoch]
    if target_kl is None or not found:
        return len(found)
    stop = int(np.argmax(np.array(found) > 1.5 * target_kl))
    if stop == 0:  # argmax gives 0 if there is no True
        return len(found)
    return stop


# %% ends_at_a_constant loses 13.7
# What never changes ends the loop, so that all after it keep 0.
# says: this
import numpy as np


def pearson(a, b):
    da, db = a - np.mean(a), b - np.mean(b)
    return np.sum(da * db) / np.sqrt(np.sum(da**2) * np.sum(db**2))


def responses(activations, observations):
    neurons, inputs = activations.shape[1], observations.shape[1]
    c = np.zeros((neurons, inputs))
    for i in range(neurons):
        h = activations[:, i]
        if np.all(h == h[0]):
            continue
        for j in range(inputs):
            x = observations[:, j]
            if np.all(x == x[0]):
                break
            c[i, j] = pearson(h, x)
    return c


# %% return_behind_the_last_step_is_zero loses 13.1, 13.8
# Takes 0 for the return behind the last step, but it is last_values where the episode goes on.
# says: this
import numpy as np


def advantages(rewards, values, episode_starts, last_values, dones, gamma, gae_lambda):
    alive = 1 - np.vstack([episode_starts[1:], dones])
    v_next = np.vstack([values[1:], last_values])
    G = np.zeros(len(last_values))
    targets = []
    for r, v, n in zip(rewards[::-1], v_next[::-1], alive[::-1], strict=True):
        G = r + gamma * n * ((1 - gae_lambda) * v + gae_lambda * G)
        targets.append(G)
    return np.array(targets[::-1]) - values


# %% sides_before_normalising loses 13.2
# Decides which side is clipped by the advantage before it is normalised.
# says: this
import numpy as np


def policy_loss(log_prob, old_log_prob, advantages, clip_range):
    A = np.array(advantages, dtype=float)
    good = A > 0
    limit = np.full(len(A), 1 - clip_range)
    limit[good] = 1 + clip_range
    if A.size > 1:
        A -= np.mean(A)
        A /= np.std(advantages, ddof=1) + 1e-8
    rho = np.exp(np.subtract(log_prob, old_log_prob))
    gains = [min(r * a, c * a) for r, a, c in zip(rho, A, limit, strict=True)]
    outside = np.logical_or(rho > 1 + clip_range, rho < 1 - clip_range)
    return {"loss": -float(np.mean(gains)), "clip_fraction": float(outside.mean())}


# %% log_sum_without_the_largest loses 13.4
# Subtracts the largest score for ln Z and does not add it back.
# says: this
import numpy as np


def log_sum(row):
    return np.log(np.sum(np.exp(row - np.max(row))))


def entropy_of_choices(scores):
    H = []
    for row in np.asarray(scores, dtype=float):
        p = np.exp(row - np.max(row))
        p = p / p.sum()
        H.append(log_sum(row) - np.dot(p, row))
    return np.array(H)


# %% constant_by_allclose loses 13.7
# Asks np.allclose whether a number changes: one that changes by little counts as constant.
# says: all equal never do
import numpy as np


def constant(column):
    return np.allclose(column, column[0])


def responses(activations, observations):
    table = []
    for h in activations.T:
        row = []
        for x in observations.T:
            if constant(h) or constant(x):
                row.append(0.0)
            else:
                row.append(np.corrcoef(h, x)[0, 1])
        table.append(row)
    return np.array(table)


# %% returns_of_normalised_advantages loses 13.8
# Normalises the advantages before the returns are made of them.
# says: this
# -         rollout.advantages[:], rollout.returns[:] = found, found + rollout.values
# +         found = (found - found.mean()) / (found.std() + 1e-8)
# +         rollout.advantages[:], rollout.returns[:] = found, found + rollout.values


# %% ended_as_a_factor loses 13.8
# Uses 1 - ended as a factor, but ended is 2 where time ran out.
# says: this
import numpy as np


def gae_of(rollout, hp):
    ended = rollout.ended.astype(np.float64)
    starts = np.ones(ended.shape)
    starts[1:] = ended[:-1]
    return advantages(
        rollout.rewards,
        rollout.values,
        starts,
        rollout.last_values,
        ended[-1],
        hp.gamma,
        hp.gae_lambda,
    )


def train_on(ppo, rollout, hp, rng):
    n = rollout.rewards.size
    for _ in range(hp.n_epochs):
        order = np.arange(n)
        rng.shuffle(order)
        for i in range(0, n, hp.batch_size):
            batch = ppo.minibatch(order[i : i + hp.batch_size])
            loss = ppo.loss(batch)
            kl = approx_kl(loss.log_probs, batch.log_probs)
            if hp.target_kl is not None and kl > 1.5 * hp.target_kl:
                return
            ppo.step(loss.gradient)


def learn(ppo, steps, seed):
    rng = np.random.default_rng(seed)
    hp = ppo.hyperparameters
    while ppo.steps < steps:
        rollout = ppo.collect()
        a = gae_of(rollout, hp)
        rollout.advantages[...] = a
        rollout.returns[...] = a + rollout.values
        train_on(ppo, rollout, hp, rng)


# %% rounded_mean_counts_as_change loses 13.7
# A number that never changes counts as one that does where its mean is rounded, as with 0.1.
# says: this
def responses(activations, observations):
    neurons = activations.shape[1]
    with np.errstate(divide="ignore", invalid="ignore"):
        both = np.corrcoef(activations.T, observations.T)
    return np.nan_to_num(both[:neurons, neurons:])
