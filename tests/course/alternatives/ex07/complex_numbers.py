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
