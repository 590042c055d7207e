"""Right solutions of exercise 2 in other styles; building.py describes how a case is written."""

# %% one_matrix_a_layer
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


# %% plain_python
# Loops over neurons with `math` and `random`; tuples and lists come back where they may.
import math
import random


def parameters(ninputs, nhiddens, noutputs, seed):
    draw = random.Random(seed)
    layer = lambda rows, columns: np.array(
        [[draw.gauss(0, 0.1) for _ in range(columns)] for _ in range(rows)]
    )
    return dict(
        W1=layer(nhiddens, ninputs),
        b1=[0.0] * nhiddens,
        W2=layer(noutputs, nhiddens),
        b2=[0.0] * noutputs,
    )


def forward(network, observation):
    def layer(weights, biases, values):
        out = []
        for row, bias in zip(weights, biases):
            total = bias
            for w, x in zip(row, values):
                total += w * x
            out.append(math.tanh(total))
        return out

    hidden = layer(network["W1"], network["b1"], observation)
    return layer(network["W2"], network["b2"], hidden)


def sizes(environment_id):
    env = gymnasium.make(environment_id)
    observation, _ = env.reset(seed=0)
    noutputs = len(env.action_space.low) if hasattr(env.action_space, "low") else env.action_space.n
    return [len(observation), noutputs]


def act(outputs, action_space):
    if isinstance(action_space, spaces.Discrete):
        best = 0
        for i in range(1, len(outputs)):
            if outputs[i] > outputs[best]:
                best = i
        return best + action_space.start
    return np.array(
        [l + (y + 1) / 2 * (u - l) for y, l, u in zip(outputs, action_space.low, action_space.high)]
    )


def run_episode(environment_id, network, seed, maxsteps=200):
    env = gymnasium.make(environment_id)
    observation = env.reset(seed=seed)[0]
    actions, rewards = (), ()
    for _ in range(maxsteps):
        action = act(forward(network, observation), env.action_space)
        observation, reward, end, timeout, _ = env.step(action)
        actions, rewards = actions + (action,), rewards + (reward,)
        if end or timeout:
            break
    return {"actions": actions, "return": math.fsum(rewards)}


def fitness(environment_id, network, seeds, maxsteps=200):
    total = 0
    for seed in seeds:
        total += run_episode(environment_id, network, seed, maxsteps=maxsteps)["return"]
    return total / len(seeds)


def forward_batch(networks, observations):
    hidden = np.tanh(np.einsum("nhi,ni->nh", networks["W1"], observations) + networks["b1"])
    return np.tanh(np.einsum("noh,nh->no", networks["W2"], hidden) + networks["b2"])


def random_search(environment_id, nnetworks, nhiddens, seed):
    networks, results, best = [], [], 0
    for i in range(nnetworks):
        network = parameters(sizes(environment_id)[0], nhiddens, sizes(environment_id)[1], seed + i)
        networks.append(network)
        results.append(fitness(environment_id, network, range(seed, seed + 10)))
        if results[i] > results[best]:
            best = i
    return {"networks": networks, "fitness": results, "best": best}


# %% single_precision
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


# %% library_functions
# einsum for the layers, flatdim for the sizes, interp for the stretching; arrays for the actions.
def forward(network, observation):
    hidden = np.tanh(np.einsum("hi,i->h", network["W1"], observation) + network["b1"])
    return np.tanh(np.einsum("oh,h->o", network["W2"], hidden) + network["b2"])


def sizes(environment_id):
    env = gymnasium.make(environment_id)
    found = [spaces.flatdim(space) for space in (env.observation_space, env.action_space)]
    env.close()
    return np.array(found)


def act(outputs, action_space):
    if isinstance(action_space, spaces.Discrete):
        return range(action_space.start, action_space.start + action_space.n)[np.argmax(outputs)]
    limits = zip(action_space.low, action_space.high)
    return np.array([np.interp(y, [-1, 1], both) for y, both in zip(outputs, limits)])


def run_episode(environment_id, network, seed, maxsteps=200):
    env = gymnasium.make(environment_id)
    observation, info = env.reset(seed=seed)
    actions, rewards = [], []
    for _ in range(maxsteps):
        actions.append(act(forward(network, observation), env.action_space))
        observation, reward, *ends, info = env.step(actions[-1])
        rewards.append(reward)
        if any(ends):
            break
    return {"actions": np.array(actions), "return": np.sum(rewards)}


def forward_batch(networks, observations):
    hidden = np.tanh(np.einsum("nhi,ni->nh", networks["W1"], observations) + networks["b1"])
    return np.tanh(np.einsum("noh,nh->no", networks["W2"], hidden) + networks["b2"])


# %% a_batch_of_one
# forward is a batch of one network; sums of products by broadcasting; a running mean.
def forward_batch(networks, observations):
    values = np.asarray(observations, dtype=float)
    for weights, biases in (("W1", "b1"), ("W2", "b2")):
        values = np.tanh((networks[weights] * values[:, None, :]).sum(axis=-1) + networks[biases])
    return values


def forward(network, observation):
    networks = {key: np.asarray(value)[np.newaxis] for key, value in network.items()}
    return forward_batch(networks, np.asarray(observation)[np.newaxis])[0]


def fitness(environment_id, network, seeds, maxsteps=200):
    mean = 0.0
    for n, seed in enumerate(seeds, 1):
        mean += (run_episode(environment_id, network, seed, maxsteps)["return"] - mean) / n
    return mean


def random_search(environment_id, nnetworks, nhiddens, seed):
    ninputs, noutputs = sizes(environment_id)
    networks, measured = [], []
    for s in range(seed, seed + nnetworks):
        networks.append(parameters(ninputs, nhiddens, noutputs, s))
        measured.append(fitness(environment_id, networks[-1], range(seed, seed + 10), 200))
    best = max(range(nnetworks), key=measured.__getitem__)
    return {"best": best, "fitness": tuple(measured), "networks": networks, "seeds": seed}


# %% one_stream_of_numbers
# All weights are cut from one stream; a table of ways to act; one environment is kept for each name.
_kept = {}


def parameters(ninputs, nhiddens, noutputs, seed):
    stream = np.random.RandomState(seed % 2**32).normal(0, 0.1, nhiddens * (ninputs + noutputs))
    first, second = np.split(stream, [nhiddens * ninputs])
    return dict(
        W1=first.reshape(nhiddens, ninputs), b1=np.full(nhiddens, 0),
        W2=second.reshape(noutputs, nhiddens), b2=np.full(noutputs, 0),
    )  # fmt: skip


def environment(name):
    if name not in _kept:
        _kept[name] = gymnasium.make(name)
    return _kept[name]


def sizes(environment_id):
    env = environment(environment_id)
    count = {spaces.Discrete: lambda s: int(s.n), spaces.Box: lambda s: int(np.prod(s.shape))}
    return [
        int(np.prod(env.observation_space.shape)),
        count[type(env.action_space)](env.action_space),
    ]


def act(outputs, action_space):
    ways = {
        spaces.Discrete: lambda s: int(s.start) + list(outputs).index(max(outputs)),
        spaces.Box: lambda s: s.high * ((1 + outputs) / 2) + s.low * ((1 - outputs) / 2),
    }
    return ways[type(action_space)](action_space)


def run_episode(environment_id, network, seed, maxsteps=200):
    env = environment(environment_id)
    (observation, _), done, actions, total = env.reset(seed=seed), False, [], 0
    while not done and maxsteps > 0:
        actions += [act(forward(network, observation), env.action_space)]
        observation, reward, terminated, truncated, _ = env.step(actions[-1])
        total, done, maxsteps = total + reward, terminated | truncated, maxsteps - 1
    return {"actions": actions, "return": total}


# %% global_generator_and_one_matrix
# The old generator of NumPy; biases as a column of the weights; argmax by max; a running mean.
def parameters(ninputs, nhiddens, noutputs, seed):
    np.random.seed(np.random.SeedSequence(seed).generate_state(4))
    names = [("W1", nhiddens, ninputs), ("W2", noutputs, nhiddens)]
    network = {
        name: np.random.normal(scale=0.1, size=(rows, columns)) for name, rows, columns in names
    }
    return network | {"b1": np.zeros((nhiddens,)), "b2": np.zeros((noutputs,))}


def forward(network, observation):
    values = np.asarray(observation, dtype=np.float32)
    for layer in "12":
        table = np.column_stack([network["W" + layer], network["b" + layer]])
        values = np.tanh(table.astype(np.float32) @ np.append(values, np.float32(1)))
    return values


def sizes(environment_id):
    env = gymnasium.make(environment_id)
    sample = env.observation_space.sample()
    space = env.action_space
    many = getattr(space, "n", None)
    return [sample.size, int(many) if many is not None else space.sample().size]


def act(outputs, action_space):
    values = [float(each) for each in outputs]
    if hasattr(action_space, "n"):
        return values.index(max(values)) + int(action_space.start)
    middle = (action_space.high.astype(float) + action_space.low) / 2
    reach = (action_space.high.astype(float) - action_space.low) / 2
    return np.array(values) * reach + middle


def run_episode(environment_id, network, seed, maxsteps=200):
    env = gymnasium.make(environment_id)
    now, _ = env.reset(seed=seed)
    done, rewards = [], []
    for _ in range(maxsteps):
        choice = act(forward(network, now), env.action_space)
        if not isinstance(choice, int):
            choice = choice.astype(env.action_space.dtype)
        now, reward, *ends, _ = env.step(choice)
        done.append(choice)
        rewards.append(reward)
        if any(ends):
            break
    return {"return": sum(rewards), "actions": done}


def fitness(environment_id, network, seeds, maxsteps=200):
    mean = 0.0
    for count, seed in enumerate(seeds, start=1):
        mean += (run_episode(environment_id, network, seed, maxsteps)["return"] - mean) / count
    return mean


def forward_batch(networks, observations):
    values = observations
    for layer in ("1", "2"):
        sums = (networks["W" + layer] * values[:, np.newaxis, :]).sum(axis=-1)
        values = np.tanh(sums + networks["b" + layer])
    return values


def random_search(environment_id, nnetworks, nhiddens, seed):
    ninputs, noutputs = sizes(environment_id)
    tried = []
    for number in range(seed, seed + nnetworks):
        network = parameters(ninputs, nhiddens, noutputs, number)
        tried.append(
            (fitness(environment_id, network, np.arange(seed, seed + 10).tolist()), network)
        )
    best = max(range(nnetworks), key=lambda number: (tried[number][0], -number))
    return {"best": best, "fitness": [each for each, _ in tried], "networks": [n for _, n in tried]}


# %% loops_and_dots
# Python loops and dot products.
def parameters(ninputs, nhiddens, noutputs, seed):
    rng = np.random.RandomState(seed % 2**32)
    n1, n2 = nhiddens * ninputs, noutputs * nhiddens
    flat = rng.normal(0.0, 0.1, n1 + n2)
    return dict(
        W1=flat[:n1].reshape(nhiddens, ninputs),
        W2=flat[n1:].reshape(noutputs, nhiddens),
        b1=np.zeros((nhiddens,)),
        b2=np.zeros((noutputs,)),
    )


def forward(network, observation):
    x = np.asarray(observation, dtype=np.float64)
    h = np.array([np.tanh(np.dot(w, x) + b) for w, b in zip(network["W1"], network["b1"])])
    return np.array([np.tanh(np.dot(w, h) + b) for w, b in zip(network["W2"], network["b2"])])


def sizes(environment_id):
    env = gymnasium.make(environment_id)
    a = env.action_space
    return (len(env.observation_space.low), int(a.n) if hasattr(a, "n") else len(a.low))


def act(outputs, action_space):
    if type(action_space) is spaces.Discrete:
        return int(action_space.start) + list(outputs).index(max(outputs))
    middle, half = (
        (action_space.high + action_space.low) / 2,
        (action_space.high - action_space.low) / 2,
    )
    return middle + half * np.asarray(outputs)


def run_episode(environment_id, network, seed, maxsteps=200):
    with gymnasium.make(environment_id) as env:
        o, _ = env.reset(seed=seed)
        chosen, rewards = [], []
        for _ in range(maxsteps):
            chosen.append(act(forward(network, o), env.action_space))
            o, r, a, b, _ = env.step(chosen[-1])
            rewards.append(r)
            if a or b:
                break
    return {"actions": chosen, "return": float(np.sum(rewards))}


def fitness(environment_id, network, seeds, maxsteps=200):
    total = 0.0
    for s in seeds:
        total += run_episode(environment_id, network, s, maxsteps)["return"]
    return total / len(seeds)


def forward_batch(networks, observations):
    h = np.tanh((networks["W1"] * observations[:, None, :]).sum(-1) + networks["b1"])
    return np.tanh((networks["W2"] * h[:, None, :]).sum(-1) + networks["b2"])


def random_search(environment_id, nnetworks, nhiddens, seed):
    i, o = sizes(environment_id)
    nets, values, best = [], [], 0
    for k in range(nnetworks):
        nets.append(parameters(i, nhiddens, o, seed + k))
        values.append(fitness(environment_id, nets[-1], tuple(range(seed, seed + 10))))
        if values[k] > values[best]:
            best = k
    return {"networks": nets, "fitness": np.array(values), "best": best}


# %% read_only_arrays
# Nobody can write into the arrays that are returned.
def parameters(ninputs, nhiddens, noutputs, seed):
    rng = np.random.Generator(np.random.Philox(seed))
    network = {
        "W1": np.asfortranarray(rng.normal(0, 0.1, (nhiddens, ninputs))),
        "W2": rng.normal(0, 0.1, (nhiddens, noutputs)).T,
        "b1": np.zeros(nhiddens, dtype=np.float32),
        "b2": np.zeros(noutputs, dtype=np.float32),
    }
    for array in network.values():
        array.setflags(write=False)
    return network
