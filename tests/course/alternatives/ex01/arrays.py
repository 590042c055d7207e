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
