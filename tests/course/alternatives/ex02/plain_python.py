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
