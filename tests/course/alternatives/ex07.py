"""Right solutions of exercise 7 in other styles; building.py describes how a case is written."""


# %% complex_numbers
# Angles as complex numbers, single precision where it does; annotations on black as arrows.
def to_state(observation):
    seen = np.asarray(observation)
    return np.concatenate(
        [np.angle(seen[..., :1] + 1j * seen[..., 1:2]), seen[..., 2:]], axis=-1
    ).astype(np.float32)


def episode(controller, seed):
    env = gymnasium.make("Pendulum-v1")
    seen, over = env.reset(seed=seed)[0], False
    yield to_state(seen)
    while not over:
        seen, _, *ends, _ = env.step(np.float32(controller(seen)))
        over = any(ends)
        yield to_state(seen)


def record(controller, seed, steps):
    return np.stack([state for state, _ in zip(episode(controller, seed), range(steps + 1))])


def arrows(before, after):
    turn = np.exp(1j * (after[:, 0] - before[:, 0]))
    return np.column_stack([before, np.angle(turn), after[:, 1] - before[:, 1]])


def grid(nangles, nvelocities):
    states = np.zeros((nvelocities, nangles, 2), dtype=np.float32)
    states[..., 0] = np.linspace(-np.pi, np.pi, nangles)
    states[..., 1] = np.linspace(-8, 8, nvelocities)[:, None]
    return states.reshape(-1, 2)


def next_states(controller, states):
    def step(state):
        env = gymnasium.make("Pendulum-v1").unwrapped
        env.reset()
        env.state = np.array(state, dtype=np.float64)
        return to_state(env.step(controller(env._get_obs()))[0])

    return np.stack([step(state) for state in states])


def evolve(algorithm, evaluate, generations, every):
    bests, history = [], np.empty(generations)
    for generation in np.arange(generations):
        candidates, seeds = algorithm.ask()
        fitness = evaluate(candidates, int(generation))
        bests.append(candidates[np.argsort(-fitness)[0]].astype(np.float32))
        history[generation] = fitness.max()
        algorithm.tell(fitness)
    kept = np.union1d(np.arange(0, generations, every), [generations - 1])
    return {"generations": kept, "parameters": np.array(bests)[kept], "history": history}


def three_stages(seed):
    robot = Robot("Pendulum-v1")
    algorithm = openai_es(robot, seed)
    best_of = []
    while len(best_of) < 600:
        candidates, _ = algorithm.ask()
        fitness = robot.evaluate(candidates, seed * 7919 + len(best_of), episodes=10)
        best_of.append(np.float32(candidates[fitness.argmax()]))
        algorithm.tell(fitness)
    some = np.array(best_of[::6])
    returns = robot.evaluate(some, seed + 1, episodes=100)
    level = (returns[0] + returns.max()) / 2
    return some[[0, np.abs(returns - level).argmin(), returns.argmax()]]


def draw_portraits(file, titles, fields, paths):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(3.2 * len(titles), 3.3), facecolor="black")
    for i, (title, field, path) in enumerate(zip(titles, fields, paths), 1):
        panel = figure.add_subplot(1, len(titles), i, facecolor="black")
        panel.set_xlim(-np.pi, np.pi)
        panel.set_ylim(-8, 8)
        panel.set_title(title, color="white")
        for rows, colour in ((field, "#203040"), (path, "yellow")):
            for x, y, dx, dy in rows:
                style = {"arrowstyle": "->", "color": colour, "shrinkA": 0, "shrinkB": 0}
                panel.annotate("", xy=(x + dx, y + dy), xytext=(x, y), arrowprops=style)
    figure.savefig(file, dpi=110)


# %% loops_and_pyplot
# Loops, `math`, lists and tuples; the pendulum's own formula; pyplot, with a field in light grey.
import math


def to_state(observation):
    if np.ndim(observation) == 1:
        cosine, sine, velocity = observation
        return math.atan2(sine, cosine), velocity
    return [to_state(each) for each in observation]


def record(controller, seed, steps):
    env = gymnasium.make("Pendulum-v1")
    seen, _ = env.reset(seed=seed)
    states = [to_state(seen)]
    for step in range(steps):
        torque = np.array(controller(seen), dtype=np.float32)
        seen, reward, terminated, truncated, info = env.step(torque)
        states.append(to_state(seen))
        if terminated or truncated:
            return states
    return states


def arrows(before, after):
    rows = []
    for (angle, velocity), (angle2, velocity2) in zip(before, after):
        change = angle2 - angle
        while change > math.pi:
            change -= 2 * math.pi
        while change < -math.pi:
            change += 2 * math.pi
        rows.append((angle, velocity, change, velocity2 - velocity))
    return np.array(rows)


def grid(nangles, nvelocities):
    angles, velocities = np.meshgrid(
        np.linspace(-math.pi, math.pi, nangles), np.linspace(-8, 8, nvelocities)
    )
    return np.c_[angles.ravel(), velocities.ravel()]


def next_states(controller, states):
    after = []
    for angle, velocity in states:
        torque = controller(np.array([math.cos(angle), math.sin(angle), velocity]))[0]
        torque = min(max(torque, -2), 2)
        velocity = velocity + (15 * math.sin(angle) + 3 * torque) * 0.05
        velocity = min(max(velocity, -8), 8)
        angle = angle + velocity * 0.05
        after.append([math.remainder(angle, 2 * math.pi), velocity])
    return np.array(after)


def evolve(algorithm, evaluate, generations, every):
    wanted = set(range(0, generations, every)) | {generations - 1}
    kept = {}
    history = []
    for g in range(generations):
        candidates = algorithm.ask()[0]
        fitness = evaluate(candidates, g)
        best = max(range(len(fitness)), key=lambda i: fitness[i])
        history.append(fitness[best])
        if g in wanted:
            kept[g] = [float(value) for value in candidates[best]]
        algorithm.tell(fitness)
    return {
        "generations": sorted(kept),
        "parameters": [kept[g] for g in sorted(kept)],
        "history": history,
    }


def three_stages(seed):
    robot = Robot("Pendulum-v1")
    run = evolve(
        openai_es(robot, seed), lambda c, g: robot.evaluate(c, 10_000 * seed + g, 10), 500, 10
    )
    worth = robot.evaluate(np.array(run["parameters"]), 5, episodes=100)
    last = max(range(len(worth)), key=lambda i: worth[i])
    for middle in range(len(worth)):
        if worth[0] + 200 < worth[middle] < worth[last] - 200:
            break
    return [run["parameters"][i] for i in (0, middle, last)]


def draw_portraits(file, titles, fields, paths):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    plt.figure(figsize=(5 * len(titles), 4), dpi=90)
    for i, title in enumerate(titles):
        plt.subplot(1, len(titles), i + 1)
        plt.xlim(-math.pi, math.pi)
        plt.ylim(-8, 8)
        plt.autoscale(False)
        x, y, dx, dy = fields[i].T
        plt.quiver(x, y, dx, dy, color="#f2f2f2", angles="xy", scale_units="xy", scale=1)
        x, y, dx, dy = paths[i].T
        plt.quiver(x, y, dx, dy, color="blue", angles="xy", scale_units="xy", scale=1)
        plt.title(title)
    plt.savefig(file)
    plt.close()


# %% patches_and_classes
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


# %% unwrapped_changes
# np.unwrap for the short way, meshgrid for the grid, one array for all stages, a list of states.
def arrows(before, after):
    turns = np.unwrap(np.stack([before[:, 0], after[:, 0]]), axis=0)
    return np.column_stack([before, turns[1] - turns[0], after[:, 1] - before[:, 1]])


def grid(nangles, nvelocities):
    axes = np.linspace(-np.pi, np.pi, nangles), np.linspace(-8, 8, nvelocities)
    return np.dstack(np.meshgrid(*axes)).reshape(-1, 2)


def evolve(algorithm, evaluate, generations, every):
    table = {}
    for g in range(generations):
        candidates, _ = algorithm.ask()
        fitness = evaluate(candidates, g)
        algorithm.tell(fitness.copy())
        top = fitness.argsort()[-1]
        table[g] = (fitness[top], np.array(candidates[top]))
    kept = [g for g in table if g % every == 0 or g + 1 == generations]
    return {
        "generations": np.array(kept),
        "parameters": np.stack([table[g][1] for g in kept]),
        "history": [table[g][0] for g in table],
    }


# %% while_loops
# while loops and math; the remainder of math for the short way; states of one step by np.array.
import math


def to_state(observation):
    observation = np.asarray(observation)
    if observation.ndim == 2:
        return np.array([to_state(row) for row in observation])
    cosine, sine, velocity = map(float, observation)
    return np.array([math.atan2(sine, cosine), velocity])


def record(controller, seed, steps):
    env = gymnasium.make("Pendulum-v1")
    observation, _ = env.reset(seed=seed)
    states, over = [to_state(observation)], False
    while len(states) <= steps and not over:
        observation, reward, *ends, _ = env.step(controller(observation))
        states.append(to_state(observation))
        over = any(ends)
    return np.vstack(states)


def arrows(before, after):
    rows = []
    for (angle, velocity), (later, faster) in zip(before, after):
        turn = math.remainder(later - angle, 2 * math.pi)
        rows.append((angle, velocity, turn, faster - velocity))
    return rows


# %% stages_by_threshold
# The first stage that beats a third of the way is the middle; single precision for the stages.
def three_stages(seed):
    robot = Robot("Pendulum-v1")
    run = evolve(
        openai_es(robot, seed), lambda rows, g: robot.evaluate(rows, 7 * seed + g, episodes=12),
        600, 4,
    )  # fmt: skip
    fitness = robot.evaluate(run["parameters"], seed + 99_999, episodes=100)
    last = int(fitness.argmax())
    goal = fitness[0] + 0.4 * (fitness[last] - fitness[0])
    middle = int(np.argmin(abs(fitness[: last + 1] - goal)))
    return [np.float32(run["parameters"][i]) for i in (0, middle, last)]


# %% another_way_around
# Arc tangent of sines and cosines, loops.
def to_state(observation):
    o = np.array(observation, dtype=np.float64)
    if o.ndim == 1:
        return np.array([np.arctan2(o[1], o[0]), o[2]])
    return np.array([to_state(each) for each in o]).reshape(-1, 2)


def record(controller, seed, steps):
    with gymnasium.make("Pendulum-v1") as env:
        seen = [env.reset(seed=seed)[0]]
        over, n = False, 0
        while not over and n < steps:
            o, r, a, b, i = env.step(controller(seen[-1]))
            seen.append(o)
            over, n = a or b, n + 1
    return np.array([to_state(o) for o in seen])


def arrows(before, after):
    turn = after[:, 0] - before[:, 0]
    turn = np.arctan2(np.sin(turn), np.cos(turn))
    return np.column_stack([before[:, 0], before[:, 1], turn, after[:, 1] - before[:, 1]])


def grid(nangles, nvelocities):
    return np.array(
        [
            (a, v)
            for v in np.linspace(-8, 8, nvelocities)
            for a in np.linspace(-np.pi, np.pi, nangles)
        ]
    )


def next_states(controller, states):
    out = np.empty((len(states), 2))
    env = gymnasium.make("Pendulum-v1")
    for i, state in enumerate(states):
        env.reset(seed=i)
        env.unwrapped.state = np.array(state, dtype=float)
        u = controller(np.array([np.cos(state[0]), np.sin(state[0]), state[1]]))
        out[i] = to_state(env.step(u)[0])
    return out


def evolve(algorithm, evaluate, generations, every):
    out = {"generations": [], "parameters": [], "history": []}
    wanted = sorted({*range(0, generations, every), generations - 1})
    for g in range(generations):
        c, _ = algorithm.ask()
        f = np.array(evaluate(c, g))
        out["history"].append(float(f.max()))
        if g in wanted:
            out["generations"].append(g)
            out["parameters"].append(np.array(c[int(f.argmax())]))
        algorithm.tell(f)
    out["parameters"] = np.stack(out["parameters"])
    return out
