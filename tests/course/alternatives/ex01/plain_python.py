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
