"""Right solutions of exercise 1 in other styles; building.py describes how a case is written."""


# %% arrays
# NumPy throughout: arrays and NumPy's scalars come back where lists and floats may.
def describe(environment_id):
    env = gymnasium.make(environment_id)
    seen, _ = env.reset(seed=1)

    def told(space):
        try:
            return {
                "kind": "Discrete",
                "choices": np.int64(space.n),
                "first": np.int64(space.start),
            }
        except AttributeError:
            return {
                "kind": "Box",
                "size": np.prod(space.shape),
                "low": list(space.low.astype(np.float64)),
                "high": list(space.high),
            }

    return {
        "observation": told(env.observation_space),
        "action": told(env.action_space),
        "maxsteps": env.get_wrapper_attr("spec").max_episode_steps,
    }


def random_episode(environment_id, seed, maxsteps):
    with gymnasium.make(environment_id) as env:
        observations = env.reset(seed=seed)[0][None]
        env.action_space.seed(seed)
        actions, rewards, ends = [], np.zeros(0), np.zeros(2, dtype=bool)
        while not ends.any() and len(rewards) < maxsteps:
            actions += [env.action_space.sample()]
            observation, reward, terminated, truncated, _ = env.step(actions[-1])
            observations = np.vstack([observations, observation])
            rewards = np.append(rewards, reward)
            ends = np.array([terminated, truncated])
    return {
        "observations": observations,
        "actions": np.array(actions),
        "rewards": rewards,
        "terminated": ends[0],
        "truncated": ends[1],
    }


def fallen(observation):
    return np.any(np.abs(observation[[0, 2]]) > np.array([2.4, 12 * 2 * np.pi / 360]))


def cartpole_reward(observation, action):
    return np.float32(1) - np.float32(fallen(observation))


def pendulum_reward(observation, action):
    angle = np.angle(observation[0] + 1j * observation[1])
    torque = np.minimum(np.maximum(action, -2), 2)[0]
    return -np.dot([1, 0.1, 0.001], np.square([angle, observation[2], torque]))


def balance(observation):
    return np.heaviside(observation @ np.array([0.05, 0.1, 1.0, 0.5]), 0)


def compare(environment_ids, episodes, seed):
    rows = []
    for name in environment_ids:
        runs = [random_episode(name, seed + i, 2**31) for i in range(episodes)]
        returns = np.array([run["rewards"].sum() for run in runs])
        lengths = np.array([run["rewards"].size for run in runs])
        spread = np.sqrt(np.var(returns) * episodes / max(episodes - 1, 1))
        rows += [
            {
                "environment": name,
                "mean": returns.mean(),
                "deviation": spread,
                "length": lengths.mean(),
            }
        ]
    return rows


# %% classes_and_generators
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


# %% plain_python
# Plain Python: no NumPy of its own, tuples, `math` and `statistics`, truth values for actions.
import math
import statistics


def describe(environment_id):
    env = gymnasium.make(environment_id)
    told = {"maxsteps": gymnasium.spec(environment_id).max_episode_steps}
    for which, space in zip(("observation", "action"), (env.observation_space, env.action_space)):
        kind = type(space).__name__
        if kind == "Discrete":
            told[which] = dict(kind=kind, choices=space.n, first=space.start)
        else:
            told[which] = dict(
                kind=kind,
                size=math.prod(space.shape),
                low=[float(limit) for limit in space.low],
                high=[float(limit) for limit in space.high],
            )
    return told


def random_episode(environment_id, seed, maxsteps):
    env = gymnasium.make(environment_id)
    env.action_space.seed(seed)
    seen, done, paid = [tuple(env.reset(seed=seed)[0])], [], []
    ends = (False, False)
    for _ in range(maxsteps):
        done.append(env.action_space.sample())
        observation, reward, *ends, _ = env.step(done[-1])
        seen.append(tuple(observation))
        paid.append(reward)
        if any(ends):
            break
    return {
        "observations": seen,
        "actions": tuple(done),
        "rewards": tuple(paid),
        "terminated": ends[0],
        "truncated": ends[1],
    }


def fallen(observation):
    x, _, angle, _ = observation
    return not (-2.4 <= x <= 2.4 and -12 <= math.degrees(angle) <= 12)


def cartpole_reward(observation, action):
    return not fallen(observation)


def pendulum_reward(observation, action):
    angle = math.acos(max(-1.0, min(1.0, observation[0])))
    torque = max(-2.0, min(2.0, action[0]))
    return -(angle * angle + 0.1 * observation[2] ** 2 + 0.001 * torque * torque)


def balance(observation):
    return observation[2] + observation[3] / 4 > 0


def compare(environment_ids, episodes, seed):
    table = []
    for name in environment_ids:
        lives = [random_episode(name, seed + i, 10**9)["rewards"] for i in range(episodes)]
        returns = list(map(math.fsum, lives))
        table.append(
            {
                "environment": name,
                "mean": statistics.mean(returns),
                "deviation": statistics.stdev(returns) if episodes > 1 else 0,
                "length": statistics.mean(map(len, lives)),
            }
        )
    return table


# %% isinstance_of_box
# The other kind is asked for; chained comparisons in degrees; a rule with four weights; zip of tuples.
def describe(environment_id):
    env = gymnasium.make(environment_id)
    found = {"maxsteps": env.spec.max_episode_steps}
    for name in ("observation", "action"):
        space = getattr(env, name + "_space")
        if isinstance(space, spaces.Box):
            limits = {side: [float(x) for x in getattr(space, side)] for side in ("low", "high")}
            found[name] = {"kind": "Box", "size": len(limits["low"]), **limits}
        else:
            found[name] = dict(kind="Discrete", choices=int(space.n), first=int(space.start))
    return found


def random_episode(environment_id, seed, maxsteps):
    env = gymnasium.make(environment_id)
    env.action_space.seed(seed)
    steps, seen = [], [env.reset(seed=seed)[0]]
    for _ in range(maxsteps):
        action = env.action_space.sample()
        after, reward, terminated, truncated, _ = env.step(action)
        steps.append((action, float(reward), terminated, truncated))
        seen.append(after)
        if terminated or truncated:
            break
    actions, rewards, terminated, truncated = map(list, zip(*steps))
    return {
        "observations": np.stack(seen),
        "actions": actions,
        "rewards": rewards,
        "terminated": terminated[-1],
        "truncated": truncated[-1],
    }


def fallen(observation):
    return not (-2.4 <= observation[0] <= 2.4 and -12 <= np.degrees(observation[2]) <= 12)


def balance(observation):
    return int(np.dot([0.05, 0.1, 1.0, 0.5], observation) > 0)


# %% statistics_of_rows
# A recursive generator of steps, statistics for the table, a reward by products.
import statistics


def pendulum_reward(observation, action):
    cosine, sine, speed = observation
    angle = np.arccos(np.clip(cosine, -1, 1)) * (1 if sine >= 0 else -1)
    torque = max(-2, min(2, action.item()))
    return -float(angle * angle + speed * speed / 10 + torque * torque / 1000)


def cartpole_reward(observation, action):
    return int(not fallen(observation))


def compare(environment_ids, episodes, seed):
    def row(name):
        runs = [random_episode(name, s, 10**9)["rewards"] for s in range(seed, seed + episodes)]
        returns = [float(np.sum(rewards)) for rewards in runs]
        return {
            "length": statistics.fmean(map(len, runs)),
            "deviation": statistics.stdev(returns) if len(returns) > 1 else 0,
            "mean": statistics.fmean(returns),
            "environment": name,
        }

    return [row(name) for name in environment_ids]


# %% a_rule_that_looks_ahead
# The rule asks where the pole will be in a quarter of a second; truth values as numbers.
def fallen(observation):
    far = np.maximum(abs(observation[0]) - 2.4, abs(observation[2]) - np.pi / 15)
    return np.bool_(far > 0)


def cartpole_reward(observation, action):
    return float(1 - fallen(observation))


def balance(observation):
    angle, speed = np.asarray(observation)[2:]
    for _ in range(25):
        angle = angle + 0.02 * speed
    return 1 if angle > 0 else 0


def pendulum_reward(observation, action):
    angle = np.angle(complex(observation[0], observation[1]))
    weights = np.array([1, 0.1, 0.001], dtype=np.float32)
    torque = np.clip(np.asarray(action, dtype=np.float32), -2, 2)[0]
    values = np.array([angle, observation[2], torque], dtype=np.float32)
    return float(-(weights * values**2).sum())


# %% counted_backwards
# Counts the steps left, reads the limits from the source's own numbers, and looks rows up in dicts.
def random_episode(environment_id, seed, maxsteps):
    with gymnasium.make(environment_id) as env:
        env.action_space.seed(seed)
        seen, left, ends = [env.reset(seed=seed)[0]], maxsteps, (False, False)
        record = {"actions": [], "rewards": []}
        while left and ends == (False, False):
            record["actions"] += [env.action_space.sample()]
            after, paid, *ends, _ = env.step(record["actions"][-1])
            ends = tuple(bool(end) for end in ends)
            seen += [after]
            record["rewards"] += [float(paid)]
            left -= 1
    return record | {"observations": np.stack(seen), **dict(zip(("terminated", "truncated"), ends))}


def fallen(observation):
    limits = np.array([2.4, np.inf, 12 * 2 * np.pi / 360, np.inf])
    return bool((np.abs(np.asarray(observation, dtype=np.float64)) > limits).any())


def cartpole_reward(observation, action):
    return float(not fallen(observation))


def pendulum_reward(observation, action):
    z = complex(observation[0], observation[1])
    effort = sorted((-2.0, float(np.squeeze(action)), 2.0))[1]
    costs = np.array([np.angle(z), observation[2], effort], dtype=np.float64) ** 2
    return -float(costs @ [1, 0.1, 0.001])


def balance(observation):
    return 1 if np.dot(observation, [0.02, 0.1, 1.0, 0.6]) > 0 else 0


def compare(environment_ids, episodes, seed):
    rows = []
    for name in environment_ids:
        lives = [random_episode(name, s, float("inf")) for s in range(seed, seed + episodes)]
        totals = np.array([np.sum(life["rewards"]) for life in lives])
        spread = 0.0
        if episodes > 1:
            spread = float(np.sqrt(np.sum((totals - totals.mean()) ** 2) / (episodes - 1)))
        steps = sum(len(life["actions"]) for life in lives) / episodes
        rows.append(dict(environment=name, mean=totals.mean(), deviation=spread, length=steps))
    return rows


# %% arccosine_squared
# The square of the angle is that of its arc cosine; an environment is kept for each name.
_kept = {}


def random_episode(environment_id, seed, maxsteps):
    env = _kept.setdefault(environment_id, gymnasium.make(environment_id))
    first, _ = env.reset(seed=seed)
    env.action_space.seed(seed)
    observations, actions, rewards = np.array([first]), [], []
    for _ in range(int(maxsteps)):
        actions.append(env.action_space.sample())
        after, reward, terminated, truncated, _ = env.step(actions[-1])
        observations = np.vstack([observations, after])
        rewards.append(reward)
        if terminated or truncated:
            break
    return {
        "observations": observations,
        "actions": actions,
        "rewards": rewards,
        "terminated": terminated,
        "truncated": truncated,
    }


def pendulum_reward(observation, action):
    angle = np.arccos(np.clip(observation[0], -1, 1))
    torque = min(2, abs(float(action[0])))
    return (-(angle * angle) - observation[2] ** 2 / 10 - torque**2 / 1000).item()


# %% limit_of_the_documentation
# Takes 0.2095 for 12 degrees, as Gymnasium's documentation does.
def fallen(observation):
    return bool(np.abs(observation[0]) > 2.4 or np.abs(observation[2]) > 0.2095)


# %% lists_and_math
# Lists, math and a while loop.
import math


def describe(environment_id):
    with gymnasium.make(environment_id) as env:
        out = {}
        for key, space in (("observation", env.observation_space), ("action", env.action_space)):
            if hasattr(space, "n"):
                out[key] = dict(kind="Discrete", choices=int(space.n), first=int(space.start))
            else:
                out[key] = dict(
                    kind="Box",
                    size=int(np.prod(space.shape)),
                    low=[float(x) for x in np.ravel(space.low)],
                    high=[float(x) for x in np.ravel(space.high)],
                )
        out["maxsteps"] = env.spec.max_episode_steps
    return out


def random_episode(environment_id, seed, maxsteps):
    env = gymnasium.make(environment_id)
    env.action_space.seed(seed)
    first, _ = env.reset(seed=seed)
    seen, done, paid, over, cut = [np.array(first)], [], [], False, False
    for _ in range(maxsteps):
        done.append(env.action_space.sample())
        state, reward, over, cut, _ = env.step(done[-1])
        seen.append(np.array(state))
        paid.append(reward)
        if over or cut:
            break
    return dict(
        observations=np.stack(seen),
        actions=done,
        rewards=[float(x) for x in paid],
        terminated=bool(over),
        truncated=bool(cut),
    )


def fallen(observation):
    x, _, a, _ = [float(v) for v in observation]
    return not (-2.4 <= x <= 2.4 and -math.pi * 12 / 180 <= a <= 12 * math.pi / 180)


def cartpole_reward(observation, action):
    return float(not fallen(observation))


def pendulum_reward(observation, action):
    c, s, v = (float(x) for x in observation)
    u = min(2.0, max(-2.0, float(np.ravel(action)[0])))
    a = math.atan2(s, c)
    return 0.0 - a * a - v * v / 10 - u * u / 1000


def balance(observation):
    return (
        1
        if 3 * observation[2] + observation[3] + 0.05 * observation[0] + 0.1 * observation[1] > 0
        else 0
    )


def compare(environment_ids, episodes, seed):
    def row(name):
        runs = [random_episode(name, k, 10**9) for k in range(seed, seed + episodes)]
        r = [math.fsum(run["rewards"]) for run in runs]
        m = sum(r) / episodes
        s = math.sqrt(sum((x - m) ** 2 for x in r) / (episodes - 1)) if episodes > 1 else 0
        return {
            "environment": name,
            "mean": m,
            "deviation": s,
            "length": sum(len(run["actions"]) for run in runs) / episodes,
        }

    return list(map(row, environment_ids))
