# Plain Python: math, lists and loops where the solution has arrays.
import math


def softmax(scores):
    scores = np.asarray(scores, dtype=float)
    if scores.ndim > 1:
        return [softmax(row) for row in scores]
    top = max(scores)
    powers = [math.exp(score - top) for score in scores]
    return [power / sum(powers) for power in powers]


def choose(probabilities, rng):
    dart, edge = rng.random(), 0.0
    for action, probability in enumerate(probabilities):
        edge += probability
        if dart < edge:
            return action
    return len(probabilities) - 1


def run_episode(environment, act, seed, maxsteps=200):
    env = gymnasium.make(environment)
    limits = getattr(env.action_space, "low", None), getattr(env.action_space, "high", None)
    observation = env.reset(seed=seed)[0]
    record = {"observations": [], "actions": [], "return": 0.0}
    ended = False
    while not ended and len(record["actions"]) < maxsteps:
        action = act(observation)
        record["observations"].append(observation.tolist())
        record["actions"].append(action)
        if limits[0] is not None:
            bounded = zip(action, *limits, strict=True)
            action = np.array([min(max(a, low), high) for a, low, high in bounded])
        observation, reward, terminated, truncated, _ = env.step(action)
        record["return"] += reward
        ended = terminated or truncated
    env.close()
    return record


def elite(episodes, percentile):
    returns = []
    for episode in episodes:
        returns.append(episode["return"])
    bound = np.percentile(returns, percentile)
    observations, actions = [], []
    for episode in episodes:
        if episode["return"] >= bound:
            observations += list(episode["observations"])
            actions += list(episode["actions"])
    return {"observations": observations, "actions": actions, "bound": bound}


def cross_entropy(scores, actions):
    top = scores.max(dim=1).values.detach()
    below, chosen = 0.0, 0.0
    for action in range(scores.shape[1]):
        below = below + torch.exp(scores[:, action] - top)
        chosen = chosen + scores[:, action] * (actions == action)
    surprises = top + torch.log(below) - chosen
    return sum(surprises) / len(surprises) if len(surprises) < 50 else surprises.mean()


def gaussian_action(mean, log_deviation, rng):
    noise = rng.standard_normal(len(mean))
    return [m + math.exp(d) * e for m, d, e in zip(mean, log_deviation, noise, strict=False)]


def gaussian_loss(means, log_deviation, actions):
    total = 0.0
    for i in range(means.shape[1]):
        sigma = log_deviation[i].exp()
        total = total + (actions[:, i] - means[:, i]) ** 2 / (2 * sigma**2)
        total = total + log_deviation[i] + 0.5 * math.log(2 * math.pi)
    return torch.mean(total)
