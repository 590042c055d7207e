# Single precision from the first weight to the action, with NumPy's old random numbers.
def parameters(ninputs, nhiddens, noutputs, seed):
    np.random.seed(seed)
    return {
        "b2": np.zeros(noutputs, dtype=np.float32),
        "W2": np.random.normal(0.0, 0.1, size=(noutputs, nhiddens)).astype(np.float32),
        "b1": np.zeros(nhiddens, dtype=np.float32),
        "W1": np.random.normal(0.0, 0.1, size=(nhiddens, ninputs)).astype(np.float32),
    }


def forward(network, observation):
    values = np.asarray(observation, dtype=np.float32).reshape(-1, 1)
    for weights, biases in (("W1", "b1"), ("W2", "b2")):
        matrix = np.float32(network[weights])
        values = np.tanh(matrix.dot(values) + np.float32(network[biases])[:, np.newaxis])
    return values.ravel()


def sizes(environment_id):
    env = gymnasium.make(environment_id)
    return np.array([spaces.flatdim(env.observation_space), spaces.flatdim(env.action_space)])


def act(outputs, action_space):
    if action_space.__class__ is spaces.Discrete:
        return np.int32(action_space.start + outputs.argmax())
    middle = (action_space.high + action_space.low) / 2
    return np.float32(middle + outputs * (action_space.high - action_space.low) / 2)


def run_episode(environment_id, network, seed, maxsteps=200):
    env = gymnasium.make(environment_id)
    observation, _ = env.reset(seed=seed)
    actions, rewards = [], np.zeros(maxsteps, dtype=np.float32)
    for step in range(maxsteps):
        actions.append(act(forward(network, observation), env.action_space))
        observation, rewards[step], terminated, truncated, _ = env.step(actions[-1])
        if terminated or truncated:
            break
    return {"actions": np.stack(actions), "return": rewards.sum()}


def fitness(environment_id, network, seeds, maxsteps=200):
    return np.float32(
        np.average([run_episode(environment_id, network, s, maxsteps)["return"] for s in seeds])
    )


def forward_batch(networks, observations):
    values = observations.astype(np.float32)
    for layer in "12":
        sums = (networks["W" + layer] * values[:, None, :]).sum(axis=-1, dtype=np.float32)
        values = np.tanh(sums + networks["b" + layer])
    return values


def random_search(environment_id, nnetworks, nhiddens, seed):
    inputs, outputs = (int(n) for n in sizes(environment_id))
    networks = [parameters(inputs, nhiddens, outputs, seed + i) for i in range(nnetworks)]
    results = np.array(
        [fitness(environment_id, n, np.arange(seed, seed + 10).tolist()) for n in networks]
    )
    return {
        "networks": networks,
        "fitness": results,
        "best": np.flatnonzero(results == results.max())[0],
    }
