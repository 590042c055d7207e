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
