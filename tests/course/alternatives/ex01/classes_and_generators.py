# Classes, generators and pattern matching; other formulas; the helpers have names of their own.
from dataclasses import asdict, dataclass
from itertools import count, islice


@dataclass
class Choice:
    choices: int
    first: int
    kind: str = "Discrete"


@dataclass
class Numbers:
    size: int
    low: list
    high: list
    kind: str = "Box"


def describe(environment_id):
    def told(space):
        match space:
            case spaces.Discrete(n=n, start=start):
                return asdict(Choice(int(n), int(start)))
            case spaces.Box(low=low, high=high):
                return asdict(Numbers(low.size, low.tolist(), high.tolist()))

    env = gymnasium.make(environment_id)
    return dict(
        observation=told(env.observation_space),
        action=told(env.action_space),
        maxsteps=env.spec.max_episode_steps,
    )


class Life:
    def __init__(self, environment_id, seed):
        self.env = gymnasium.make(environment_id)
        self.env.action_space.seed(seed)
        self.first, _ = self.env.reset(seed=seed)
        self.terminated = self.truncated = False

    def __iter__(self):
        for _ in count():
            action = self.env.action_space.sample()
            seen, reward, self.terminated, self.truncated, _ = self.env.step(action)
            yield seen, action, float(reward)
            if self.terminated or self.truncated:
                return


def random_episode(environment_id, seed, maxsteps):
    life = Life(environment_id, seed)
    seen, actions, rewards = zip(*islice(life, maxsteps), strict=True)
    return {
        "observations": np.stack([life.first, *seen]),
        "actions": list(actions),
        "rewards": list(rewards),
        "terminated": bool(life.terminated),
        "truncated": bool(life.truncated),
    }


def fallen(observation):
    return max(abs(observation[0]) / 2.4, abs(observation[2]) / (np.pi / 15)) > 1


def cartpole_reward(observation, action):
    if fallen(observation):
        return 0
    return 1


def pendulum_reward(observation, action):
    cosine, sine, speed = observation
    half = 2 * np.arctan2(sine, 1 + cosine) if cosine > -0.99 else np.arctan2(sine, cosine)
    torque = float(np.clip(action, -2, 2).item())
    return -1.0 * (half**2 + speed**2 / 10 + torque**2 / 1000)


class Balancer:
    """Where will the pole be in 0.3 seconds?"""

    seconds = 0.3

    def __call__(self, observation):
        return np.int8(observation[2] + self.seconds * observation[3] >= 0)


balance = Balancer()


def compare(environment_ids, episodes, seed):
    def row(name):
        runs = [random_episode(name, seed + i, 1_000_000)["rewards"] for i in range(episodes)]
        n, total = len(runs), sum(map(sum, runs))
        squares = sum((sum(run) - total / n) ** 2 for run in runs)
        return {
            "deviation": (squares / (n - 1)) ** 0.5 if n > 1 else 0.0,
            "length": sum(map(len, runs)) / n,
            "mean": total / n,
            "environment": name,
        }

    return list(map(row, environment_ids))
