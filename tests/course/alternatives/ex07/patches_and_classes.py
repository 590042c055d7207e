# Classes; vectorised where a loop would do; arrows as patches on a transparent ground.
from dataclasses import dataclass, field


def to_state(observation):
    cosine, sine, velocity = np.moveaxis(np.array(observation, dtype=float), -1, 0)
    half = np.sign(sine) + (sine == 0)
    return np.stack([half * np.arccos(np.clip(cosine, -1, 1)), velocity], axis=-1)


class Recorder(gymnasium.Wrapper):
    def __init__(self, env):
        super().__init__(env)
        self.seen = []

    def reset(self, **options):
        seen, info = self.env.reset(**options)
        self.seen.append(seen)
        return seen, info

    def step(self, action):
        self.seen.append((answer := self.env.step(action))[0])
        return answer


def record(controller, seed, steps):
    env = Recorder(gymnasium.make("Pendulum-v1"))
    env.reset(seed=seed)
    over = False
    while not over and len(env.seen) <= steps:
        _, _, terminated, truncated, _ = env.step(controller(env.seen[-1]))
        over = terminated or truncated
    cosine, sine, velocity = np.array(env.seen).T
    return np.array([np.arctan2(sine, cosine), velocity]).T


def arrows(before, after):
    change = np.asarray(after) - before
    turns = np.rint(change[:, 0] / (2 * np.pi))
    return np.c_[before, change[:, 0] - 2 * np.pi * turns, change[:, 1]]


def grid(nangles, nvelocities):
    return [
        [-np.pi + 2 * np.pi * i / (nangles - 1), -8 + 16 * j / (nvelocities - 1)]
        for j in range(nvelocities)
        for i in range(nangles)
    ]


def next_states(controller, states):
    env = gymnasium.make("Pendulum-v1").unwrapped
    env.reset(seed=1)
    after = np.empty((len(states), 2))
    for i, state in enumerate(states):
        env.state = tuple(state)
        env.step(controller(np.array([np.cos(state[0]), np.sin(state[0]), state[1]])))
        angle, velocity = env.state
        after[i] = (angle + np.pi) % (2 * np.pi) - np.pi, velocity
    return after


@dataclass
class Album:
    every: int
    last: int
    numbers: list = field(default_factory=list)
    kept: list = field(default_factory=list)

    def look(self, generation, candidate):
        if not generation % self.every or generation == self.last:
            self.numbers.append(generation)
            self.kept.append(np.array(candidate))


def evolve(algorithm, evaluate, generations, every):
    album, history = Album(every, generations - 1), []
    for generation in range(generations):
        candidates, _ = algorithm.ask()
        pairs = list(zip(evaluate(candidates, generation), candidates))
        best = max(pairs, key=lambda pair: pair[0])
        history.append(best[0])
        album.look(generation, best[1])
        algorithm.tell(np.array([fitness for fitness, _ in pairs]))
    return {
        "generations": tuple(album.numbers),
        "parameters": np.vstack(album.kept),
        "history": history,
    }


def three_stages(seed):
    """A hill climb of one, in place of the algorithm that is given."""
    robot, rng = Robot("Pendulum-v1"), np.random.default_rng(seed)
    population = np.zeros((40, robot.nbiases + robot.nweights))
    population[:, robot.nbiases :] = 0.1 * rng.standard_normal((40, robot.nweights))
    stages = []
    for generation in range(900):
        fitness = robot.evaluate(population, int(rng.integers(2**31)))
        order = fitness.argsort()[::-1]
        if generation % 10 == 0:
            stages.append(population[order[0]].copy())
        noise = 0.5 * rng.standard_normal((20, population.shape[1]))
        population = np.vstack([population[order[:20]], population[order[:20]] + noise])
    returns = robot.evaluate(np.array(stages), seed, episodes=100)
    wanted = (returns[0] + returns.max()) / 2
    return np.stack([stages[i] for i in (0, abs(returns - wanted).argmin(), returns.argmax())])


def draw_portraits(file, titles, fields, paths):
    from matplotlib.figure import Figure
    from matplotlib.patches import FancyArrow

    n = len(titles)
    figure = Figure(figsize=(4 * n, 4))
    for i in range(n):
        panel = figure.add_axes([(i + 0.12) / n, 0.1, 0.8 / n, 0.8])
        panel.set(xlim=(-np.pi, np.pi), ylim=(-8, 8), title=titles[i], facecolor="none")
        for rows, colour in ((fields[i], (0, 0, 0, 0.15)), (paths[i], "red")):
            for x, y, dx, dy in rows:
                panel.add_patch(
                    FancyArrow(
                        x, y, dx, dy, width=0.02, head_width=0.2, head_length=0.15,
                        length_includes_head=True, color=colour,
                    )
                )  # fmt: skip
    figure.savefig(file, dpi=100, transparent=True)
