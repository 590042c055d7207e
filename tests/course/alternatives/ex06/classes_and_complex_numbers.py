# A class for the mind, a generator for the episode, the arena's plane in complex numbers.
from functools import partial


class Mind:
    def __init__(self, brain, memory=None):
        self.matrix = brain["gates"].reshape(4 * UNITS, -1)
        self.out = np.column_stack([brain["readout"], brain["bias"]])
        self.memory = np.zeros((2, UNITS)) if memory is None else np.array(memory)

    def step(self, seen):
        f, i, o, c = np.split(self.matrix @ np.append(seen, self.memory[1]), 4)
        half = lambda x: 0.5 + 0.5 * np.tanh(x / 2)
        cells = half(f + 1) * self.memory[0] + half(i) * np.tanh(c)
        self.memory = np.vstack([cells, half(o) * np.tanh(cells)])
        return np.tanh(self.out @ np.append(self.memory[1], 1))


def think(brain, observation, memory):
    mind = Mind(brain, memory)
    return mind.step(observation), mind.memory


def steps(arena, brain, remember):
    mind, step = Mind(brain), 0
    while not arena.done:
        seen, before = np.array(arena.observation), mind.memory
        arena.action[:] = mind.step(seen)
        action = np.array(arena.action)
        reward = arena.step()
        mind.memory = np.array(remember(step, before, mind.memory))
        yield np.array(arena.robots[0]), seen, before, action, reward
        step += 1


def episode(brain, start, cylinder, seed, remember=keep, maxsteps=500):
    arena = arenas.make("discrim", max_steps=maxsteps)
    arena.reset(seed)
    arena.robots[0], arena.objects[0, :2] = start, cylinder
    arena.sense()
    first = np.array(arena.robots[0])
    poses, *others = (np.array(column) for column in zip(*steps(arena, brain, remember)))
    names = ("observations", "memories", "actions", "rewards")
    return {"poses": np.vstack([first, poses]), **dict(zip(names, others))}


def grid(places, headings):
    xs, ys = np.linspace(150, 250, places), np.linspace(270, 350, places)
    turn = np.arange(headings) * (2 * np.pi / headings)
    return np.c_[
        np.tile(np.repeat(xs, headings), places),
        np.repeat(ys, places * headings),
        np.tile(turn, places * places),
    ].tolist()


def describe(poses, rewards, cylinder):
    place, facing = poses[:, 0] + 1j * poses[:, 1], np.exp(1j * poses[:, 2])
    near = np.asarray(rewards) == 1
    search = int(np.argmax(np.append(near, True)))
    moved = np.diff(place) / facing[:-1]
    free = np.minimum.reduce([place.real, place.imag, 400 - place.real, 400 - place.imag])[:-1]
    there = (complex(*cylinder) - place[1:]) / facing[1:]
    first = np.arange(len(near)) < search
    parts = {
        "speed": moved.real[first],
        "turning": np.angle(facing[1:] / facing[:-1])[first],
        "wall": free[first] < 72.5,
        "pace": np.abs(moved)[near],
        "side": (there.imag / np.abs(there))[near],
    }
    return {"search": search, **{key: mean(values) for key, values in parts.items()}}


def standardise(table):
    with np.errstate(all="ignore"):
        scaled = (table - np.average(table, axis=0)) / np.sqrt(np.var(table, axis=0))
    return np.where(np.ptp(table, axis=0) == 0, 0, scaled)


def families(table, threshold):
    """The distances of merged families are means weighted by their sizes."""
    rows = standardise(table)
    distance = np.sqrt(((rows[:, None] - rows) ** 2).sum(-1))
    np.fill_diagonal(distance, np.inf)
    size, label = np.ones(len(rows)), np.arange(len(rows))
    while True:
        i, j = sorted(np.unravel_index(distance.argmin(), distance.shape))
        if i == j or distance[i, j] >= threshold:
            break
        merged = (size[i] * distance[i] + size[j] * distance[j]) / (size[i] + size[j])
        distance[i], distance[:, i] = merged, merged
        distance[j], distance[:, j], distance[i, i] = np.inf, np.inf, np.inf
        size[i] += size[j]
        label[label == j] = i
    seen = list(dict.fromkeys(label))
    return tuple(seen.index(each) for each in label)


def forget(step, before, after):
    after = np.array(after)
    after.fill(0)
    return after


def _frozen(since, step, before, after):
    return (before, after)[step < since]


def freeze(since):
    return partial(_frozen, since)


def memory_test(brain, starts, cylinder, seed, since, maxsteps=500):
    ways = dict(keep=keep, forget=forget, freeze=freeze(since))
    table = np.array(
        [
            [
                np.sum(episode(brain, start, cylinder, seed + i, way, maxsteps)["rewards"])
                for way in ways.values()
            ]
            for i, start in enumerate(starts)
        ]
    )
    return dict(zip(ways, table.mean(axis=0)))


def reactions(brain, observation, memories):
    return np.stack([Mind(brain, memory).step(observation) for memory in memories])
