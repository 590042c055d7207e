# loses: 12.8
# Learns by another algorithm: it varies the parameters at random and keeps the better ones.
def train(environment, seed):
    rng = np.random.default_rng(seed)
    outputs = 2 if environment == "CartPole-v1" else 1
    sizes = ((8, 4), (8,), (outputs, 8), (outputs,))
    best, centre = -1.0, [np.zeros(size) for size in sizes]
    returns = []
    while best < 200 and len(returns) < 400:
        tried = [each + 0.5 * rng.standard_normal(each.shape) for each in centre]

        def act(observation, tried=tried):
            found = outputs_of(tried, observation)
            return int(found.argmax()) if outputs == 2 else found

        returns.append([run_episode(environment, act, seed + e)["return"] for e in range(8)])
        if np.mean(returns[-1]) >= best:
            best, centre = np.mean(returns[-1]), tried
    return {"parameters": centre, "returns": returns}
