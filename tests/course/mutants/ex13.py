"""Wrong solutions of exercise 13; building.py describes how a case is written."""

# %% end_of_the_wrong_step loses 13.1
# Takes the first step of an episode for its last one, but step t is the last one if step t + 1 starts an episode.
_advantages = advantages


def advantages(rewards, values, episode_starts, last_values, dones, gamma, gae_lambda):
    shifted = np.concatenate([episode_starts[:1], episode_starts[:-1]])
    return _advantages(rewards, values, shifted, last_values, dones, gamma, gae_lambda)


# %% ends_ignored loses 13.1
# Ignores the ends of episodes: values and TD errors of the next episode count for the steps before its start.
# says: this
_advantages = advantages


def advantages(rewards, values, episode_starts, last_values, dones, gamma, gae_lambda):
    none = np.zeros_like(episode_starts)
    return _advantages(rewards, values, none, last_values, 0 * dones, gamma, gae_lambda)


# %% lambda_forgotten loses 13.1
# Leaves out gae_lambda: later TD errors are multiplied by gamma alone at each step, but should be by gamma * gae_lambda.
# says: this
_advantages = advantages


def advantages(rewards, values, episode_starts, last_values, dones, gamma, gae_lambda):
    return _advantages(rewards, values, episode_starts, last_values, dones, gamma, 1.0)


# %% last_end_ignored loses 13.1
# Treats the last step of the rollout as if its episode went on, even where dones is 1.
_advantages = advantages


def advantages(rewards, values, episode_starts, last_values, dones, gamma, gae_lambda):
    return _advantages(rewards, values, episode_starts, last_values, 0 * dones, gamma, gae_lambda)


# %% last_value_forgotten loses 13.1
# Leaves out the value of what comes after the last step, but where dones is 0, last_values should count there.
# says: this
_advantages = advantages


def advantages(rewards, values, episode_starts, last_values, dones, gamma, gae_lambda):
    return _advantages(rewards, values, episode_starts, 0 * last_values, dones, gamma, gae_lambda)


# %% one_step_only loses 13.1
# Takes only the TD error of the step itself and leaves out those of the later steps.
_advantages = advantages


def advantages(rewards, values, episode_starts, last_values, dones, gamma, gae_lambda):
    return _advantages(rewards, values, episode_starts, last_values, dones, gamma, 0.0)


# %% errors_leak loses 13.1
# Adds the TD errors of the next episode to the advantages of the one before, but where n_t is 0 they should be left out.
# says: this
# -         following = error + gamma * gae_lambda * goes_on * following
# +         following = error + gamma * gae_lambda * following


# %% values_leak loses 13.1
# Adds the next value to the TD error even where the episode ended, but where n_t is 0 it should be left out.
# says: this
# -         error = rewards[t] + gamma * goes_on * next_values - values[t]
# +         error = rewards[t] + gamma * next_values - values[t]


# %% ends_bootstrapped loses 13.1
# Adds gamma times the value where episodes ended by themselves, too, but only those that the time limit cut should get it.
# says: this
def bootstrapped(rewards, terminated, truncated, final_values, gamma):
    return rewards + gamma * np.maximum(terminated, truncated) * final_values


# %% both_bootstrapped loses 13.1
# Adds gamma times the value in steps that are both terminated and truncated, but an episode that ended by itself should get nothing.
# says: this
def bootstrapped(rewards, terminated, truncated, final_values, gamma):
    return rewards + gamma * truncated * final_values


# %% undiscounted_bootstrap loses 13.1
# Adds the critic's value without multiplying it by gamma.
# says: this
def bootstrapped(rewards, terminated, truncated, final_values, gamma):
    return rewards + truncated * (1 - terminated) * final_values


# %% never_bootstrapped loses 13.1
# Returns the rewards as they are, but where time ran out gamma times the critic's value should be added.
# says: this
def bootstrapped(rewards, terminated, truncated, final_values, gamma):
    return np.array(rewards)


# %% bootstrapped_in_place loses 13.1
# Changes the array of rewards that it is given, but should make a new one.
# says: changed its argument
def bootstrapped(rewards, terminated, truncated, final_values, gamma):
    rewards += gamma * truncated * (1 - terminated) * final_values
    return rewards


# %% asks_stable_baselines loses 13.1, 13.4, 13.6
# Lets a function of Stable-Baselines3 or torch give the answer, but it should be computed with NumPy.
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
# Always takes the clipped product instead of the smaller one of the two products.
_policy_loss = policy_loss


def policy_loss(log_prob, old_log_prob, advantages, clip_range):
    ratio = np.exp(log_prob - old_log_prob)
    cut = np.log(np.clip(ratio, 1 - clip_range, 1 + clip_range))
    loss = _policy_loss(cut, 0 * cut, advantages, clip_range)["loss"]
    return {"loss": loss, "clip_fraction": float((abs(ratio - 1) > clip_range).mean())}


# %% clips_the_logarithm loses 13.2
# Counts in clip_fraction the steps whose ln(ratio) is farther than clip_range from 0, instead of those whose ratio is farther than clip_range from 1.
_policy_loss = policy_loss


def policy_loss(log_prob, old_log_prob, advantages, clip_range):
    found = _policy_loss(log_prob, old_log_prob, advantages, clip_range)
    return {**found, "clip_fraction": float((abs(log_prob - old_log_prob) > clip_range).mean())}


# %% not_normalised loses 13.2
# Takes the advantages as they are, but in a batch of more than one step they should be normalised.
# says: this
def policy_loss(log_prob, old_log_prob, advantages, clip_range):
    ratio = np.exp(log_prob - old_log_prob)
    clipped = np.clip(ratio, 1 - clip_range, 1 + clip_range)
    loss = -np.minimum(ratio * advantages, clipped * advantages).mean()
    return {"loss": float(loss), "clip_fraction": float((abs(ratio - 1) > clip_range).mean())}


# %% population_deviation loses 13.2
# Divides by N in the standard deviation of the advantages, but should divide by N - 1 (ddof=1).
_policy_loss = policy_loss


def policy_loss(log_prob, old_log_prob, advantages, clip_range):
    n = len(advantages)
    found = _policy_loss(log_prob, old_log_prob, advantages, clip_range)
    return {**found, "loss": found["loss"] * np.sqrt(n / max(1, n - 1))}


# %% sign_of_the_loss loses 13.2
# Returns the loss with the opposite sign, but it should be minus the mean of the smaller products.
# says: this
_policy_loss = policy_loss


def policy_loss(log_prob, old_log_prob, advantages, clip_range):
    found = _policy_loss(log_prob, old_log_prob, advantages, clip_range)
    return {**found, "loss": -found["loss"]}


# %% single_step_normalised loses 13.2
# Returns the loss 0 for a batch of one step, but there the advantage should be taken as it is, without normalising.
_policy_loss = policy_loss


def policy_loss(log_prob, old_log_prob, advantages, clip_range):
    found = _policy_loss(log_prob, old_log_prob, advantages, clip_range)
    return {**found, "loss": 0.0} if len(advantages) == 1 else found


# %% single_step_gives_nan loses 13.2
# Normalises a batch of a single step, too, so that the loss is NaN, but its advantage should be taken as it is.
# says: this
# -     if len(advantages) > 1:
# -         advantages = (advantages - advantages.mean()) / (advantages.std(ddof=1) + 1e-8)
# +     advantages = (advantages - advantages.mean()) / (advantages.std(ddof=1) + 1e-8)


# %% zero_clips_nothing loses 13.3
# Treats clip_range_vf=0 like None and clips nothing, but with 0 the values should not be allowed to move at all.
# says: this
# -     if clip_range_vf is not None:
# +     if clip_range_vf:


# %% half_the_square loses 13.3
# Returns half the mean squared difference, but the whole mean squared difference is asked for.
# says: this
_value_loss = value_loss


def value_loss(values, old_values, returns, clip_range_vf=None):
    return _value_loss(values, old_values, returns, clip_range_vf) / 2


# %% value_clipped_around_the_return loses 13.3
# Clips the error (the difference of values and returns) instead of the movement (the difference of values and old_values).
_value_loss = value_loss


def value_loss(values, old_values, returns, clip_range_vf=None):
    if clip_range_vf is None:
        return _value_loss(values, old_values, returns)
    return float(np.mean(np.clip(returns - values, -clip_range_vf, clip_range_vf) ** 2))


# %% value_never_clipped loses 13.3
# Ignores clip_range_vf and never clips, but the movement of the values away from old_values should be clipped.
# says: this
_value_loss = value_loss


def value_loss(values, old_values, returns, clip_range_vf=None):
    return _value_loss(values, old_values, returns)


# %% entropy_in_bits loses 13.4
# Takes logarithms to the base 2 instead of natural logarithms.
# says: this
_entropy_of_choices = entropy_of_choices


def entropy_of_choices(scores):
    return _entropy_of_choices(scores) / np.log(2)


# %% entropy_of_nothing loses 13.4
# Returns NaN where an action has the probability 0, but such an action should add nothing to the entropy.
def entropy_of_choices(scores):
    with np.errstate(all="ignore"):
        powers = np.exp(scores - scores.max(axis=1, keepdims=True))
        shares = powers / powers.sum(axis=1, keepdims=True)
        return -(shares * np.log(shares)).sum(axis=1)


# %% entropy_of_one_actuator loses 13.4
# Takes the mean over the actuators instead of the sum.
_entropy_of_gaussians = entropy_of_gaussians


def entropy_of_gaussians(log_deviation):
    return _entropy_of_gaussians(log_deviation) / len(log_deviation)


# %% asks_later loses 13.4, 13.5, 13.6
# Takes the answer from a library function instead of computing it with NumPy.
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
# Takes the mean of -ln(ratio), but the mean of (ratio - 1) - ln(ratio) is asked for.
def approx_kl(log_prob, old_log_prob):
    return float(np.mean(old_log_prob - log_prob))


# %% stops_after_the_update loses 13.5
# Counts the update of the first batch whose divergence is too great, but this batch should make no update any more.
# says: this
_updates_made = updates_made


def updates_made(divergences, target_kl):
    total = sum(map(len, divergences))
    return min(total, _updates_made(divergences, target_kl) + 1)


# %% stops_at_the_target loses 13.5
# Stops at a divergence greater than target_kl, but only one greater than 1.5 times target_kl should stop the training.
_updates_made = updates_made


def updates_made(divergences, target_kl):
    return _updates_made(divergences, None if target_kl is None else target_kl / 1.5)


# %% stops_the_epoch_only loses 13.5
# Ends only the epoch when a divergence is too great, but the later epochs should make no updates, either.
_updates_made = updates_made


def updates_made(divergences, target_kl):
    return sum(_updates_made([epoch], target_kl) for epoch in divergences)


# %% stops_when_equal loses 13.5
# Stops at a divergence that is equal to 1.5 times target_kl, but only a greater one should stop the training.
# -             if target_kl is not None and divergence > 1.5 * target_kl:
# +             if target_kl is not None and divergence >= 1.5 * target_kl:


# %% zero_target_never_stops loses 13.5
# Treats target_kl=0 like None and never stops, but every divergence greater than 0 should stop the training then.
# -             if target_kl is not None and divergence > 1.5 * target_kl:
# +             if target_kl and divergence > 1.5 * target_kl:


# %% entropy_is_punished loses 13.6
# Adds ent_coef times the mean entropy to the loss instead of subtracting it.
# says: this
_total_loss = total_loss


def total_loss(policy_loss, value_loss, entropies, ent_coef, vf_coef):
    return _total_loss(policy_loss, value_loss, entropies, -ent_coef, vf_coef)


# %% squared_correlation loses 13.6
# Returns the squared correlation of values and returns, but 1 - var(returns - values) / var(returns) is asked for.
def explained_variance(values, returns):
    return float(np.corrcoef(values.ravel(), returns.ravel())[0, 1] ** 2)


# %% covariance loses 13.7
# Returns the covariance, but the correlation is asked for (the covariance divided by both standard deviations).
def responses(activations, observations):
    h, x = activations - activations.mean(axis=0), observations - observations.mean(axis=0)
    return h.T @ x / len(h)


# %% linear_layers loses 13.7
# Gives the next layer the sums W x + b as they are, but should give it the activations tanh(W x + b).
# -         observations = np.tanh(observations @ np.asarray(weights).T + biases)
# -         activations.append(observations)
# +         observations = observations @ np.asarray(weights).T + biases
# +         activations.append(np.tanh(observations))


# %% nothing_to_follow loses 13.7
# Divides by 0, or by a mere rounding error, where a neuron or an observed number never changes, but the correlation should be 0 there.
def responses(activations, observations):
    h, x = activations - activations.mean(axis=0), observations - observations.mean(axis=0)
    with np.errstate(all="ignore"):
        return (h / np.sqrt((h**2).sum(0))).T @ (x / np.sqrt((x**2).sum(0)))


# %% returns_for_advantages loses 13.1
# Returns advantages plus values (the returns that the critic learns), but the advantages alone are asked for.
# says: this
# -         result[t] = following
# -     return result
# +         result[t] = following
# +     return result + values


# %% standardised_over_the_rollout loses 13.1
# Normalises the advantages (minus their mean, divided by their deviation), but they should be returned as they are.
# says: this
# -         result[t] = following
# -     return result
# +         result[t] = following
# +     return (result - result.mean()) / (result.std() + 1e-8)


# %% ratio_upside_down loses 13.2
# Divides the old probability by the new one, but the ratio should be the new probability divided by the old one.
# says: this
# -     ratio = np.exp(log_prob - old_log_prob)
# +     ratio = np.exp(old_log_prob - log_prob)


# %% clips_the_product loses 13.2
# Clips the product of ratio and advantage to 1 - clip_range ... 1 + clip_range, but only the ratio should be clipped.
# says: this
# -     clipped = np.clip(ratio, 1 - clip_range, 1 + clip_range)
# -     return {
# -         "loss": float(-np.minimum(ratio * advantages, clipped * advantages).mean()),
# +     clipped = np.clip(ratio * advantages, 1 - clip_range, 1 + clip_range)
# +     return {
# +         "loss": float(-np.minimum(ratio * advantages, clipped).mean()),


# %% clipped_upwards_only loses 13.2
# Counts in clip_fraction only ratios above 1 + clip_range, but those below 1 - clip_range should count, too.
# says: this
# -         "clip_fraction": float(np.mean(np.abs(ratio - 1) > clip_range)),
# +         "clip_fraction": float(np.mean(ratio - 1 > clip_range)),


# %% larger_of_two_value_losses loses 13.3
# Takes for each step the larger one of the clipped and the unclipped squared difference, but with clip_range_vf the clipped one is asked for.
# says: this
# -     return float(np.mean((returns - predictions) ** 2))
# +     both = (returns - predictions) ** 2, (returns - values) ** 2
# +     return float(np.mean(np.maximum(*both)))


# %% movement_cut_to_one_side loses 13.3
# Clips only values that have risen by more than clip_range_vf, but those that have fallen by more should be clipped, too.
# says: this
# -         predictions = old_values + np.clip(values - old_values, -clip_range_vf, clip_range_vf)
# +         predictions = old_values + np.minimum(values - old_values, clip_range_vf)


# %% mean_entropy_of_the_batch loses 13.4
# Returns the mean entropy of the batch for every step, but each step should have its own entropy.
# -     return -(np.exp(logarithms) * logarithms).sum(axis=1)
# +     return np.full(len(scores), -(np.exp(logarithms) * logarithms).sum(axis=1).mean())


# %% deviation_for_its_logarithm loses 13.4
# Takes the logarithm of log_deviation, but log_deviation already is ln sigma and should be added as it is.
# says: this
# -     return float(np.sum(0.5 + 0.5 * np.log(2 * np.pi) + np.asarray(log_deviation)))
# +     return float(np.sum(0.5 + 0.5 * np.log(2 * np.pi) + np.log(np.abs(log_deviation))))


# %% divergence_the_other_way_round loses 13.5
# Takes the ratio upside down (the old probability divided by the new one), but the new one divided by the old one is asked for.
# says: this
# -     log_ratio = log_prob - old_log_prob
# +     log_ratio = old_log_prob - log_prob


# %% half_the_squared_difference loses 13.5
# Takes half the mean squared difference of the logarithms, but the mean of (ratio - 1) - ln(ratio) is asked for.
# says: this
# -     return float(np.mean(np.exp(log_ratio) - 1 - log_ratio))
# +     return float(np.mean(log_ratio**2) / 2)


# %% stops_when_the_mean_is_too_far loses 13.5
# Judges an epoch as a whole by the mean of its divergences, but each batch should be judged by its own divergence.
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


# %% squared_error_for_variance loses 13.6
# Takes the mean of (returns - values) ** 2 instead of the variance of returns - values, so a constant error makes the result smaller.
# says: this
# -     return float(1 - np.var(returns - values) / np.var(returns))
# +     return float(1 - np.mean((returns - values) ** 2) / np.var(returns))


# %% never_below_zero loses 13.6
# Returns 0 where the explained variance is negative, but the negative number is asked for.
# says: this
# -     return float(1 - np.var(returns - values) / np.var(returns))
# +     return max(0.0, float(1 - np.var(returns - values) / np.var(returns)))


# %% last_layer_only loses 13.7
# Returns the activations of the last hidden layer alone, but those of every hidden layer are asked for.
# -         activations.append(observations)
# +         activations = [observations]


# %% loop_without_returns loses 13.8
# Leaves zeros in rollout.returns, but advantages plus values should be written into it.
# says: this
# -         rollout.advantages[:], rollout.returns[:] = found, found + rollout.values
# +         rollout.advantages[:] = found


# %% loop_against_the_gradient loses 13.8
# Makes its updates in the opposite direction: ppo.step should get loss.gradient with its own sign.
# -             ppo.step(loss.gradient)
# +             ppo.step(-loss.gradient)


# %% loop_with_one_order loses 13.8
# Never shuffles the steps of a rollout, but each epoch should have a new random order.
# -         orders = [rng.permutation(ended.size) for _ in range(h.n_epochs)]
# +         orders = [np.arange(ended.size) for _ in range(h.n_epochs)]


# %% loop_with_one_epoch loses 13.8
# Goes through each rollout once instead of n_epochs times.
# -         orders = [rng.permutation(ended.size) for _ in range(h.n_epochs)]
# +         orders = [rng.permutation(ended.size)]


# %% loop_without_early_stop loses 13.8
# Never stops early, but a divergence greater than 1.5 times target_kl should end the training on the rollout.
# -             if h.target_kl is not None and divergence > 1.5 * h.target_kl:
# +             if divergence > 100:


# %% loop_stops_late loses 13.8
# Makes the update of the batch whose divergence is too great and stops after it, but should stop before this update.
# -             if h.target_kl is not None and divergence > 1.5 * h.target_kl:
# -                 break
# -             ppo.step(loss.gradient)
# +             ppo.step(loss.gradient)
# +             if h.target_kl is not None and divergence > 1.5 * h.target_kl:
# +                 break


# %% loop_forgets_ends loses 13.8
# Computes the advantages as if no episode ever ended, but steps where rollout.ended is 1 or 2 end an episode.
# -         ended = (rollout.ended > 0).astype(float)
# +         ended = np.zeros_like(rollout.ended)


# %% loop_with_the_same_order_in_each_epoch loses 13.8
# Draws one order for all epochs of a rollout, but each epoch should have a new one.
# -         orders = [rng.permutation(ended.size) for _ in range(h.n_epochs)]
# +         orders = [rng.permutation(ended.size)] * h.n_epochs
# %% final_values_of_the_next_step loses 13.1
# Adds the number of the next row of final_values, but the row of the step itself is asked for.
# -     return rewards + gamma * out_of_time * final_values
# +     return rewards + gamma * out_of_time * np.roll(final_values, -1, axis=0)
# %% value_for_the_reward loses 13.1
# Replaces the reward by gamma times the critic's value where time ran out, but should add this to the reward.
# -     return rewards + gamma * out_of_time * final_values
# +     return np.where(out_of_time > 0, gamma * final_values, rewards)
# %% value_of_the_same_step loses 13.1
# Takes the value of step t for the next value in the TD error of step t, but the value of step t + 1 is asked for.
# -         next_values = last_values if last else values[t + 1]
# +         next_values = last_values if last else values[t]
# %% environments_mixed loses 13.1
# Gives all environments the mean of their advantages in each step, but each environment should have its own.
# -         result[t] = following
# +         following = np.full(np.shape(following), following.mean())
# +         result[t] = following
# %% normalised_by_the_range loses 13.2
# Divides the advantages by their range (largest minus smallest) instead of their standard deviation.
# -         advantages = (advantages - advantages.mean()) / (advantages.std(ddof=1) + 1e-8)
# +         advantages = (advantages - advantages.mean()) / (np.ptp(advantages) + 1e-8)
# %% mean_not_subtracted loses 13.2
# Leaves the mean in the advantages and only divides them by their standard deviation, but the mean should be subtracted first.
# -         advantages = (advantages - advantages.mean()) / (advantages.std(ddof=1) + 1e-8)
# +         advantages = advantages / (advantages.std(ddof=1) + 1e-8)
# %% absolute_error loses 13.3
# Takes the mean absolute difference instead of the mean squared difference.
# -     return float(np.mean((returns - predictions) ** 2))
# +     return float(np.mean(np.abs(returns - predictions)))
# %% half_missing_in_the_entropy loses 13.4
# Leaves out one 1/2 for each actuator, but the sum of 1/2 + 1/2 ln(2 pi) + ln sigma is asked for.
# -     return float(np.sum(0.5 + 0.5 * np.log(2 * np.pi) + np.asarray(log_deviation)))
# +     return float(np.sum(0.5 * np.log(2 * np.pi) + np.asarray(log_deviation)))
# %% entropy_along_the_batch loses 13.4
# Makes the probabilities of each action add up to 1 over the steps, but those of each step should add up to 1.
# -     logarithms = shifted - np.log(np.exp(shifted).sum(axis=1, keepdims=True))
# +     logarithms = shifted - np.log(np.exp(shifted).sum(axis=0, keepdims=True))
# %% counts_epochs loses 13.5
# Counts the completed epochs instead of the updates.
# -             made += 1
# +             pass
# +         made += 1
# %% value_loss_halved loses 13.6
# Halves the value loss before it is added, but it should only be multiplied by vf_coef.
# -     return float(policy_loss + vf_coef * value_loss - ent_coef * np.mean(entropies))
# +     return float(policy_loss + 0.5 * vf_coef * value_loss - ent_coef * np.mean(entropies))
# %% all_layers_see_the_first loses 13.7
# Gives every later layer the activations of the first layer, but each should get those of the layer before it.
# -         observations = np.tanh(observations @ np.asarray(weights).T + biases)
# -         activations.append(observations)
# +         seen = observations if not activations else activations[0]
# +         activations.append(np.tanh(seen @ np.asarray(weights).T + biases))
# %% observations_not_centred loses 13.7
# Subtracts the mean from the activations only, but it should also be subtracted from the observations.
# -     h, x = activations - activations.mean(axis=0), observations - observations.mean(axis=0)
# +     h, x = activations - activations.mean(axis=0), observations.copy()
# %% loop_with_values_as_returns loses 13.8
# Writes the advantages alone into rollout.returns, but advantages plus values are asked for.
# -         rollout.advantages[:], rollout.returns[:] = found, found + rollout.values
# +         rollout.advantages[:], rollout.returns[:] = found, found
# %% loop_with_lambda_one loses 13.8
# Computes the advantages with gae_lambda=1 instead of the gae_lambda of ppo.hyperparameters.
# -             h.gamma, h.gae_lambda,
# +             h.gamma, 1.0,


# %% stop_ends_the_epoch loses 13.8
# Ends only the epoch with its early stop, but this should end all training on the rollout, the later epochs, too.
# says: this
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
# Lets an episode that the time limit cut (ended is 2) go on into the next one in the advantages, but it should end there like any other.
# says: this
# -         ended = (rollout.ended > 0).astype(float)
# +         ended = (rollout.ended == 1).astype(float)


# %% share_that_lost loses 13.2
# Counts in clip_fraction the steps whose clipped product is the smaller one, instead of all steps whose ratio is farther than clip_range from 1.
# says: this
# -         "clip_fraction": float(np.mean(np.abs(ratio - 1) > clip_range)),
# +         "clip_fraction": float(np.mean(clipped * advantages < ratio * advantages)),


# %% ratio_of_the_logarithms loses 13.2
# Divides the logarithms of the probabilities instead of taking the exponential of their difference.
# says: this
# -     ratio = np.exp(log_prob - old_log_prob)
# +     ratio = log_prob / old_log_prob


# %% constant_of_one_actuator loses 13.4
# Adds 1/2 + 1/2 ln(2 pi) only once, but it should be added for each actuator.
# says: this
# -     return float(np.sum(0.5 + 0.5 * np.log(2 * np.pi) + np.asarray(log_deviation)))
# +     return float(0.5 + 0.5 * np.log(2 * np.pi) + np.sum(log_deviation))


# %% exponential_of_the_logarithm loses 13.4
# Adds sigma, the exponential of log_deviation, but ln sigma should be added, which is log_deviation itself.
# says: this
# -     return float(np.sum(0.5 + 0.5 * np.log(2 * np.pi) + np.asarray(log_deviation)))
# +     return float(np.sum(0.5 + 0.5 * np.log(2 * np.pi) + np.exp(log_deviation)))


# %% variance_of_the_predictions loses 13.6
# Divides the variance of the values by that of the returns, but 1 - var(returns - values) / var(returns) is asked for.
# says: this
# -     return float(1 - np.var(returns - values) / np.var(returns))
# +     return float(np.var(values) / np.var(returns))


# %% rectified loses 13.7
# Cuts the hidden neurons off at 0 (ReLU), but tanh is asked for.
# says: this
# -         observations = np.tanh(observations @ np.asarray(weights).T + biases)
# +         observations = np.maximum(0, observations @ np.asarray(weights).T + biases)


# %% means_stay loses 13.7
# Multiplies activations and observations without subtracting their means, but both means should be subtracted first.
# says: this
# -     h, x = activations - activations.mean(axis=0), observations - observations.mean(axis=0)
# +     h, x = np.array(activations), np.array(observations)


# %% lost_arrays loses 13.8
# Leaves zeros in both rollout.advantages and rollout.returns, but your numbers should be written into them.
# says: this
# -         rollout.advantages[:], rollout.returns[:] = found, found + rollout.values
# +         own = found, found + rollout.values
# +         assert len(own) == 2


# %% first_step_for_the_last loses 13.8
# Leaves out whether the last step of the rollout ended its episode, but dones should be 1 where it did.
# says: this
# -             rollout.rewards, rollout.values, starts, rollout.last_values, ended[-1],
# +             rollout.rewards, rollout.values, starts, rollout.last_values, ended[0],


# %% clips_the_values loses 13.3
# Clips the values themselves to -clip_range_vf ... clip_range_vf, but only their movement away from old_values should be clipped.
# says: this
# -         predictions = old_values + np.clip(values - old_values, -clip_range_vf, clip_range_vf)
# +         predictions = np.clip(values, -clip_range_vf, clip_range_vf)


# %% shares_of_the_scores loses 13.4
# Divides the absolute scores by their sum to get probabilities, but softmax is asked for.
# says: this
def entropy_of_choices(scores):
    shares = np.abs(scores) / np.abs(scores).sum(axis=1, keepdims=True)
    return -(shares * np.log(shares)).sum(axis=1)


# %% a_single_rollout loses 13.8
# Collects only one rollout, but should go on until ppo.steps is at least `steps`.
# says: this
# -     while ppo.steps < steps:
# +     if ppo.steps < steps:


# %% divergences_add_up loses 13.5
# Adds up the divergences of all batches so far, but each batch should be judged by its own divergence.
# says: this
# -             if target_kl is not None and divergence > 1.5 * target_kl:
# -                 return made
# -             made += 1
# +             total = divergence + (total if made else 0.0)
# +             if target_kl is not None and total > 1.5 * target_kl:
# +                 return made
# +             made += 1


# %% logarithm_clipped loses 13.2
# Clips the logarithm of the ratio to -clip_range ... clip_range, but the ratio itself should be clipped, to 1 - clip_range ... 1 + clip_range.
# says: this
# -     clipped = np.clip(ratio, 1 - clip_range, 1 + clip_range)
# +     clipped = np.exp(np.clip(log_prob - old_log_prob, -clip_range, clip_range))


# %% returns_of_one_step loses 13.8
# Writes rewards plus gamma times the next values into rollout.returns, but advantages plus values are asked for.
# says: this
# -         rollout.advantages[:], rollout.returns[:] = found, found + rollout.values
# +         following = np.vstack([rollout.values[1:], rollout.last_values[None]])
# +         rollout.advantages[:] = found
# +         rollout.returns[:] = rollout.rewards + h.gamma * (1 - ended) * following


# %% whole_epoch_left_out loses 13.5
# Counts no update of the epoch with the divergence that is too great, but those of the batches before it should count.
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
# Uses n of step t + 1 for the later TD errors in the advantage of step t, but n of step t is asked for.
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
# Divides the ratios by their mean in the batch, but they should stay as they are.
# says: this
# -     ratio = np.exp(log_prob - old_log_prob)
# +     ratio = np.exp(log_prob - old_log_prob)
# +     ratio = ratio / ratio.mean()


# %% mean_divergence_so_far loses 13.5
# Judges a batch by the mean divergence of its epoch so far, but it should be judged by its own divergence.
# says: this
# -         for divergence in epoch:
# -             if target_kl is not None and divergence > 1.5 * target_kl:
# +         for k in range(len(epoch)):
# +             if target_kl is not None and np.mean(epoch[: k + 1]) > 1.5 * target_kl:


# %% variances_of_the_columns loses 13.6
# Takes the variances of each column and then their means, but each variance should be that of all numbers together.
# says: this
# -     return float(1 - np.var(returns - values) / np.var(returns))
# +     left, whole = np.var(returns - values, axis=0), np.var(returns, axis=0)
# +     return float(1 - left.mean() / whole.mean())


# %% any_end_ends_all loses 13.1
# Ends the episodes of all environments where that of any environment ends, but each environment should have its own ends.
# says: this
# -         goes_on = 1 - (dones if last else episode_starts[t + 1])
# +         goes_on = 1 - np.max(dones if last else episode_starts[t + 1])


# %% last_value_of_the_first_environment loses 13.1
# Takes the first number of last_values for all environments, but each environment should have its own.
# says: this
# -         next_values = last_values if last else values[t + 1]
# +         next_values = last_values[0] if last else values[t + 1]


# %% bootstrapped_by_reward loses 13.1
# Multiplies the reward by gamma, too, where time ran out, but only the critic's value should be multiplied by it.
# says: this
# -     return rewards + gamma * out_of_time * final_values
# +     return np.where(out_of_time > 0, gamma * (rewards + final_values), rewards)


# %% first_environment_alone loses 13.1
# Takes the ends of the first environment for those of all environments, but each should have its own.
# says: this
# -         goes_on = 1 - (dones if last else episode_starts[t + 1])
# +         goes_on = 1 - (dones if last else episode_starts[t + 1])[0]


# %% minimum_of_means loses 13.2
# Takes the smaller one of the means of both products, but the mean of each step's smaller product is asked for.
# says: this
# -         "loss": float(-np.minimum(ratio * advantages, clipped * advantages).mean()),
# +         "loss": float(-min((ratio * advantages).mean(), (clipped * advantages).mean())),


# %% fraction_of_low_ratios loses 13.2
# Counts in clip_fraction only ratios below 1 - clip_range, but those above 1 + clip_range should count, too.
# says: this
# -         "clip_fraction": float(np.mean(np.abs(ratio - 1) > clip_range)),
# +         "clip_fraction": float(np.mean(1 - ratio > clip_range)),


# %% ratio_of_values loses 13.3
# Clips the ratio of the new values to the old ones, but their difference should be clipped.
# says: this
# -         predictions = old_values + np.clip(values - old_values, -clip_range_vf, clip_range_vf)
# +         ratio = np.clip(values / old_values, 1 - clip_range_vf, 1 + clip_range_vf)
# +         predictions = old_values * ratio


# %% smaller_of_two_value_losses loses 13.3
# Takes for each step the smaller one of the clipped and the unclipped squared difference, but with clip_range_vf the clipped one is asked for.
# says: this
# -     return float(np.mean((returns - predictions) ** 2))
# +     return float(np.mean(np.minimum((returns - predictions) ** 2, (returns - values) ** 2)))


# %% surprise_of_all_actions loses 13.4
# Takes the plain mean of -ln p over the actions, but each should be multiplied by its probability p and then added up.
# says: this
# -     return -(np.exp(logarithms) * logarithms).sum(axis=1)
# +     return -logarithms.mean(axis=1)


# %% entropy_divided_by_its_largest loses 13.4
# Divides the entropy by the logarithm of the number of actions, but it should not be divided.
# says: this
# -     return -(np.exp(logarithms) * logarithms).sum(axis=1)
# +     return -(np.exp(logarithms) * logarithms).sum(axis=1) / np.log(logarithms.shape[1])


# %% variance_for_the_deviation loses 13.4
# Adds only half of ln sigma, but the whole log_deviation should be added.
# says: this
# -     return float(np.sum(0.5 + 0.5 * np.log(2 * np.pi) + np.asarray(log_deviation)))
# +     return float(np.sum(0.5 + 0.5 * np.log(2 * np.pi) + 0.5 * np.asarray(log_deviation)))


# %% counts_within_the_epoch loses 13.5
# Counts only the updates of the last epoch that it reaches, but those of all epochs should be added up.
# says: this
# -         for divergence in epoch:
# +         made = 0
# +         for divergence in epoch:


# %% skips_the_far_batch loses 13.5
# Leaves out only the batches whose divergence is too great, but the first of them should end the training.
# says: this
# -                 return made
# +                 continue


# %% last_entropy loses 13.6
# Takes the entropy of the last step instead of the mean of all entropies.
# says: this
# -     return float(policy_loss + vf_coef * value_loss - ent_coef * np.mean(entropies))
# +     return float(policy_loss + vf_coef * value_loss - ent_coef * entropies[-1])


# %% policy_loss_subtracted loses 13.6
# Subtracts policy_loss instead of adding it.
# says: this
# -     return float(policy_loss + vf_coef * value_loss - ent_coef * np.mean(entropies))
# +     return float(-policy_loss + vf_coef * value_loss - ent_coef * np.mean(entropies))


# %% amounts_of_responses loses 13.7
# Returns the correlations without their signs, but those below 0 should stay negative.
# says: this
# -     return np.divide(h.T @ x, sizes, out=np.zeros_like(sizes), where=sizes > 0)
# +     return abs(np.divide(h.T @ x, sizes, out=np.zeros_like(sizes), where=sizes > 0))


# %% running_sum_not_reset loses 13.1
# Adds an advantage of the environment before to the last step of the next one, but the advantage behind a last step should be 0.
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
# Puts the mean ratio into the formula, but the formula should be computed for each step, and then its mean.
# says: this
# -     log_ratio = log_prob - old_log_prob
# -     return float(np.mean(np.exp(log_ratio) - 1 - log_ratio))
# +     ratio = np.mean(np.exp(log_prob - old_log_prob))
# +     return float((ratio - 1) - np.log(ratio))


# %% last_error_left_out loses 13.1
# Leaves out the TD error of the step that ends an episode in the advantages of the steps before it, but it should count there.
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
# Clips nothing in a batch of one step, but there only the normalisation should be left out.
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
# Puts a value that has moved too far back to the old value, but it should end clip_range_vf away from the old value.
# says: this
# -         predictions = old_values + np.clip(values - old_values, -clip_range_vf, clip_range_vf)
# +         predictions = np.where(
# +             np.abs(values - old_values) <= clip_range_vf, values, old_values
# +         )


# %% scores_cut_at_50 loses 13.4
# Cuts the scores to -50 ... 50, but scores of any size should be used as they are.
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
# Counts all updates if already the first batch has too great a divergence, but then no update should be made.
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
# Gives the correlation 0 to all observed numbers after one that never changes, but only that one should have 0.
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


# %% return_behind_the_last_step_is_zero loses 13.1
# Counts last_values only 1 - gae_lambda times, as if the return behind the last step were 0, but where dones is 0 that return should be last_values.
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
# Chooses the side on which it clips by the sign of the advantage before normalising, but the normalised advantage should decide.
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
# Returns entropies that are too small by the largest score: if it is subtracted from the scores, it should be added back to the logarithm of the sum.
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
# Treats numbers that change by very little as if they never changed, but only numbers that are all equal never change.
# says: this
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
# Normalises the advantages before it adds the values, but the returns should be advantages plus values without normalising.
# says: this
# -         rollout.advantages[:], rollout.returns[:] = found, found + rollout.values
# +         found = (found - found.mean()) / (found.std() + 1e-8)
# +         rollout.advantages[:], rollout.returns[:] = found, found + rollout.values


# %% ended_as_a_factor loses 13.8
# Takes n = -1 where time ran out (rollout.ended is 2 there), but n should be 0 wherever an episode ended.
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
# Returns a correlation other than 0 for some numbers that never change: their mean is rounded. The numbers themselves should be compared.
# says: this
def responses(activations, observations):
    neurons = activations.shape[1]
    with np.errstate(divide="ignore", invalid="ignore"):
        both = np.corrcoef(activations.T, observations.T)
    return np.nan_to_num(both[:neurons, neurons:])


# %% starts_ignored loses 13.1
# Leaves out the ends of episodes on the way (episode_starts) and counts only those of the last step (dones).
# says: this
# -         goes_on = 1 - (dones if last else episode_starts[t + 1])
# +         goes_on = 1 - (dones if last else 0 * episode_starts[t + 1])


# %% terminated_bootstrapped loses 13.1
# Adds gamma times the value where an episode ended by itself, but it should be added where time ran out.
# says: this
# -     out_of_time = np.asarray(truncated) * (1 - np.asarray(terminated))
# +     out_of_time = np.asarray(terminated)


# %% clipped_around_0 loses 13.2
# Clips the ratio to -clip_range ... clip_range, but 1 - clip_range ... 1 + clip_range is asked for.
# says: this
# -     clipped = np.clip(ratio, 1 - clip_range, 1 + clip_range)
# +     clipped = np.clip(ratio, -clip_range, clip_range)


# %% clipped_from_above loses 13.2
# Clips only ratios above 1 + clip_range, but those below 1 - clip_range should be clipped, too.
# says: this
# -     clipped = np.clip(ratio, 1 - clip_range, 1 + clip_range)
# +     clipped = np.minimum(ratio, 1 + clip_range)


# %% clipped_from_below loses 13.2
# Clips only ratios below 1 - clip_range, but those above 1 + clip_range should be clipped, too.
# says: this
# -     clipped = np.clip(ratio, 1 - clip_range, 1 + clip_range)
# +     clipped = np.maximum(ratio, 1 - clip_range)


# %% lower_limit_upside_down loses 13.2
# Takes 1 / (1 + clip_range) for the lower limit of the ratio, but 1 - clip_range is asked for.
# says: this
# -     clipped = np.clip(ratio, 1 - clip_range, 1 + clip_range)
# +     clipped = np.clip(ratio, 1 / (1 + clip_range), 1 + clip_range)


# %% smaller_amount loses 13.2
# Takes the product with the smaller absolute value, but signs should count, too.
# says: this
# -         "loss": float(-np.minimum(ratio * advantages, clipped * advantages).mean()),
# +         "loss": float(
# +             -np.where(
# +                 abs(ratio * advantages) < abs(clipped * advantages),
# +                 ratio * advantages,
# +                 clipped * advantages,
# +             ).mean()
# +         ),


# %% loop_with_rewards_as_returns loses 13.8
# Writes the rewards into rollout.returns, but advantages plus values are asked for.
# says: this
# -         rollout.advantages[:], rollout.returns[:] = found, found + rollout.values
# +         rollout.advantages[:], rollout.returns[:] = found, rollout.rewards


# %% loop_with_discounted_sums loses 13.8
# Writes the discounted sums of the later rewards into rollout.returns, but advantages plus values are asked for.
# says: this
# -         rollout.advantages[:], rollout.returns[:] = found, found + rollout.values
# +         every = advantages(
# +             rollout.rewards, rollout.values, starts, rollout.last_values, ended[-1], h.gamma, 1.0
# +         )
# +         rollout.advantages[:], rollout.returns[:] = found, every + rollout.values
