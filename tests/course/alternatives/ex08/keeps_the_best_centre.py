# Classes and closures of its own; stops when the centre itself, evaluated now and then, is good.
class Adam:
    def __init__(self, n):
        self.m, self.v, self.t = np.zeros(n), np.zeros(n), 0

    def step(self, centre, d, stepsize):
        self.t += 1
        centre, self.m, self.v = adam(centre, d, self.m, self.v, self.t, stepsize)
        return centre


def candidates_around(centre, samples, noiseStdDev):
    both = np.stack([centre + noiseStdDev * samples, centre - noiseStdDev * samples])
    return both.transpose(1, 0, 2).reshape(-1, len(centre))


def utilities(fitness):
    fitness = np.asarray(fitness)
    order = sorted(range(len(fitness)), key=fitness.__getitem__)
    result = dict(zip(order, np.linspace(-0.5, 0.5, len(fitness)), strict=False))
    return np.array([result[i] for i in range(len(fitness))])


def gradient(samples, utilities):
    weights = np.array(utilities[::2]) - np.array(utilities[1::2])
    return sum(weight * e for weight, e in zip(weights, samples, strict=True)) / len(utilities)


def descent(gradient, centre, wdecay):
    return [0, centre, np.sign(centre)][wdecay] * np.float64(0.005) - gradient


def evolve(
    evaluate, centre, generations, seed, samplesize=20, noiseStdDev=0.02, stepsize=0.01, wdecay=0
):
    rng, optimiser = np.random.default_rng(seed), Adam(len(centre))
    history = np.zeros(generations)
    for g in range(generations):
        e = rng.standard_normal((samplesize, len(centre)))
        fitness = evaluate(candidates_around(centre, e, noiseStdDev), seed + g)
        history[g] = np.mean(fitness)
        d = descent(gradient(e, utilities(fitness)), centre, wdecay)
        centre = optimiser.step(centre, d, stepsize)
    return {"centre": centre, "history": history, "generations": generations}


def train(environment, seed):
    robot, rng = Robot(environment), np.random.default_rng(seed)
    centre = 0.1 * rng.standard_normal(robot.nbiases + robot.nweights)
    goal = 200 if environment == "CartPole-v0" else -180
    for stretch in range(40):
        run = evolve(
            lambda candidates, s: robot.evaluate(candidates, s, episodes=5), centre, 40,
            seed + 1000 * stretch, samplesize=25, noiseStdDev=0.25, stepsize=0.05,
        )  # fmt: skip
        centre = run["centre"]
        if robot.evaluate(centre[None], seed + 77, episodes=50)[0] >= goal:
            break
    return centre
