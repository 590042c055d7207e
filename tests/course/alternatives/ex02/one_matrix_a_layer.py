# The bias is one more column of weights; a class for the network, a generator for the episode.
from functools import reduce
from statistics import fmean


class Net:
    def __init__(self, network):
        self.layers = [np.column_stack([network["W" + k], network["b" + k]]) for k in ("1", "2")]

    def __call__(self, values):
        return reduce(lambda x, layer: np.tanh(layer @ np.append(x, 1.0)), self.layers, values)


def parameters(ninputs, nhiddens, noutputs, seed):
    first, second = np.random.SeedSequence(seed).spawn(2)
    weights = [
        np.random.Generator(np.random.PCG64(sequence)).normal(scale=0.1, size=shape)
        for sequence, shape in ((first, (nhiddens, ninputs)), (second, (noutputs, nhiddens)))
    ]
    return {
        **{f"W{i}": w for i, w in enumerate(weights, 1)},
        **{f"b{i}": 0 * w[:, 0] for i, w in enumerate(weights, 1)},
    }


def forward(network, observation):
    return Net(network)(observation)


def sizes(environment_id):
    with gymnasium.make(environment_id) as env:
        match env.action_space:
            case spaces.Discrete(n=n):
                return env.observation_space.low.size, n
            case box:
                return env.observation_space.low.size, box.low.size


def act(outputs, action_space):
    match action_space:
        case spaces.Discrete(start=start):
            return start + max(range(len(outputs)), key=lambda i: outputs[i])
        case spaces.Box(low=low, high=high):
            share = (np.array(outputs, dtype=float) + 1) / 2
            return list(share * high + (1 - share) * low)


def steps(env, network, seed):
    observation, _ = env.reset(seed=seed)
    over = False
    while not over:
        action = act(Net(network)(observation), env.action_space)
        observation, reward, terminated, truncated, _ = env.step(action)
        over = terminated or truncated
        yield action, reward


def run_episode(environment_id, network, seed, maxsteps=200):
    env = gymnasium.make(environment_id)
    done = [step for _, step in zip(range(maxsteps), steps(env, network, seed))]
    return {"actions": [a for a, _ in done], "return": sum(r for _, r in done)}


def fitness(environment_id, network, seeds, maxsteps=200):
    return fmean(run_episode(environment_id, network, s, maxsteps)["return"] for s in seeds)


def forward_batch(networks, observations):
    ones = np.ones((len(observations), 1))
    values = observations
    for k in "12":
        layer = np.concatenate([networks["W" + k], networks["b" + k][:, :, None]], axis=2)
        values = np.tanh(np.matmul(layer, np.hstack([values, ones])[:, :, None]).squeeze(axis=2))
    return values


def random_search(environment_id, nnetworks, nhiddens, seed):
    shape = sizes(environment_id)
    report = {"networks": [], "fitness": []}
    for own in range(seed, seed + nnetworks):
        network = parameters(shape[0], nhiddens, shape[1], own)
        report["networks"].append(network)
        report["fitness"].append(fitness(environment_id, network, range(seed, seed + 10)))
    return {**report, "best": report["fitness"].index(max(report["fitness"]))}
