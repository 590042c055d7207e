"""Right solutions of exercise 6 in other styles; building.py describes how a case is written."""

# %% classes_and_complex_numbers
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


# %% plain_python
# Unit by unit with `math`; lists and tuples; the memory that is frozen is kept by the function.
import math


def think(brain, observation, memory):
    known = [*observation, *memory[1]]
    sigma = lambda x: 1 / (1 + math.exp(-x))
    cells, outputs = [], []
    for unit in range(UNITS):
        f, i, o, c = (
            sum(w * x for w, x in zip(brain["gates"][gate][unit], known)) for gate in range(4)
        )
        cells.append(memory[0][unit] * sigma(f + 1) + math.tanh(c) * sigma(i))
        outputs.append(math.tanh(cells[-1]) * sigma(o))
    action = [
        math.tanh(brain["bias"][k] + sum(w * x for w, x in zip(brain["readout"][k], outputs)))
        for k in range(2)
    ]
    return action, [cells, outputs]


def episode(brain, start, cylinder, seed, remember=keep, maxsteps=500):
    arena = arenas.make("discrim", max_steps=maxsteps)
    arena.reset(seed)
    for k in range(3):
        arena.robots[0][k] = start[k]
    arena.objects[0][0], arena.objects[0][1] = cylinder
    arena.sense()
    told = {"poses": [tuple(arena.robots[0])]}
    for name in ("observations", "memories", "actions", "rewards"):
        told[name] = []
    memory = np.zeros((2, 10))
    while not arena.done:
        seen = list(arena.observation)
        action, after = think(brain, seen, memory)
        told["observations"].append(seen)
        told["memories"].append(np.array(memory))
        told["actions"].append(action)
        arena.action = action
        told["rewards"].append(arena.step())
        told["poses"].append(tuple(arena.robots[0]))
        memory = remember(len(told["rewards"]) - 1, memory, np.array(after))
    return {name: np.array(values) for name, values in told.items()}


def grid(places, headings):
    starts = []
    for j in range(places):
        for i in range(places):
            for k in range(headings):
                share = 1 / (places - 1)
                starts.append(
                    (150 + 100 * i * share, 270 + 80 * j * share, 2 * math.pi * k / headings)
                )
    return np.array(starts)


def describe(poses, rewards, cylinder):
    speed, turning, wall, pace, side = [], [], [], [], []
    searching, search = True, 0
    for t, reward in enumerate(rewards):
        (x, y, a), (x2, y2, a2) = poses[t], poses[t + 1]
        searching = searching and not reward > 0
        if searching:
            search += 1
            speed.append((x2 - x) * math.cos(a) + (y2 - y) * math.sin(a))
            turning.append(math.remainder(a2 - a, 2 * math.pi))
            wall.append(x < 72.5 or y < 72.5 or x > 327.5 or y > 327.5)
        if reward > 0:
            pace.append(math.dist((x, y), (x2, y2)))
            side.append(math.sin(math.atan2(cylinder[1] - y2, cylinder[0] - x2) - a2))
    return {
        "search": search,
        "speed": mean(speed),
        "turning": mean(turning),
        "wall": mean(wall),
        "pace": mean(pace),
        "side": mean(side),
    }


def standardise(table):
    columns = []
    for column in zip(*table):
        middle = sum(column) / len(column)
        spread = math.sqrt(sum((value - middle) ** 2 for value in column) / len(column))
        alike = max(column) == min(column)
        columns.append([0.0 if alike else (value - middle) / spread for value in column])
    return np.array(columns).T


def families(table, threshold):
    rows = standardise(table).tolist()
    groups = [{i} for i in range(len(rows))]

    def apart(one, other):
        return sum(math.dist(rows[i], rows[j]) for i in one for j in other) / len(one) / len(other)

    while len(groups) > 1:
        distance, a, b = min(
            (apart(groups[a], groups[b]), a, b) for b in range(len(groups)) for a in range(b)
        )
        if not distance < threshold:
            break
        groups[a] = groups[a] | groups.pop(b)
    answer = {}
    for number, group in enumerate(sorted(groups, key=min)):
        answer.update(dict.fromkeys(group, number))
    return [answer[i] for i in range(len(rows))]


def forget(step, before, after):
    return [[0] * UNITS, [0] * UNITS]


class Frozen:
    def __init__(self, since):
        self.since, self.memory = since, None

    def __call__(self, step, before, after):
        if step < self.since:
            return after
        if step == self.since:
            self.memory = np.array(before)
        return self.memory


def freeze(since):
    return Frozen(since)


def memory_test(brain, starts, cylinder, seed, since, maxsteps=500):
    totals = {"keep": 0.0, "forget": 0.0, "freeze": 0.0}
    for i, start in enumerate(starts):
        for name, way in (("keep", keep), ("forget", forget), ("freeze", Frozen(since))):
            totals[name] += sum(episode(brain, start, cylinder, seed + i, way, maxsteps)["rewards"])
    return {name: total / len(starts) for name, total in totals.items()}


def reactions(brain, observation, memories):
    return [think(brain, observation, memory)[0] for memory in memories]


# %% single_precision
# Single precision, preallocated arrays, one einsum for all gates, families as a matrix.
def think(brain, observation, memory):
    gates, readout, bias = (np.float32(brain[name]) for name in ("gates", "readout", "bias"))
    cells, outputs = np.float32(memory)
    z = np.hstack([observation, outputs]).astype(np.float32)
    net = np.einsum("gui,i->gu", gates, z) + np.float32([[1], [0], [0], [0]])
    forget, enter, leave = 1 / (1 + np.exp(-net[:3]))
    new = np.empty((2, UNITS), dtype=np.float32)
    new[0] = cells * forget + enter * np.tanh(net[3])
    new[1] = leave * np.tanh(new[0])
    return np.tanh(readout.dot(new[1]) + bias), new


def episode(brain, start, cylinder, seed, remember=keep, maxsteps=500):
    arena = arenas.make("discrim", max_steps=maxsteps)
    arena.reset(seed)
    arena.robots[0, :] = start
    arena.objects[0, 0:2] = cylinder
    arena.sense()
    poses = np.zeros((maxsteps + 1, 3))
    seen = np.zeros((maxsteps, INPUTS))
    memories = np.zeros((maxsteps + 1, 2, UNITS), dtype=np.float32)
    actions, rewards = np.zeros((maxsteps, 2)), np.zeros(maxsteps)
    poses[0], t = arena.robots[0], 0
    while t < maxsteps and not arena.done:
        seen[t] = arena.observation
        actions[t], after = think(brain, seen[t], memories[t])
        arena.action = actions[t]
        rewards[t] = arena.step()
        memories[t + 1] = remember(t, memories[t], after)
        t += 1
        poses[t] = arena.robots[0]
    return {
        "poses": poses[: t + 1],
        "observations": seen[:t],
        "memories": memories[:t],
        "actions": actions[:t],
        "rewards": rewards[:t],
    }


def grid(places, headings):
    y, x, angle = np.meshgrid(
        np.linspace(270, 350, places),
        np.linspace(150, 250, places),
        np.linspace(0, 2 * np.pi, headings, endpoint=False),
        indexing="ij",
    )
    return np.stack([x.ravel(), y.ravel(), angle.ravel()], axis=1).astype(np.float32)


def describe(poses, rewards, cylinder):
    poses, rewards = np.float32(poses), np.asarray(rewards)
    near = np.flatnonzero(rewards > 0)
    search = near[0] if len(near) else rewards.size
    step = np.diff(poses, axis=0)
    heading = np.stack([np.cos(poses[:, 2]), np.sin(poses[:, 2])], axis=1)
    turn = np.unwrap(poses[:, 2])
    speed = (step[:, :2] * heading[:-1]).sum(axis=1)
    wall = np.abs(poses[:-1, :2] - 200).max(axis=1) > 200 - 72.5
    to = np.float32(cylinder) - poses[1:, :2]
    cross = heading[1:, 0] * to[:, 1] - heading[1:, 1] * to[:, 0]
    side = cross / np.linalg.norm(to, axis=1)
    pace = np.linalg.norm(step[:, :2], axis=1)
    average = lambda values: np.float32(values.mean()) if values.size else np.float32(0)
    return {
        "search": search,
        "speed": average(speed[:search]),
        "turning": average(np.diff(turn)[:search]),
        "wall": average(wall[:search].astype(np.float32)),
        "pace": average(pace[near]),
        "side": average(side[near]),
    }


def standardise(table):
    centred = table - table.mean(axis=0)
    spread = np.sqrt((centred**2).mean(axis=0))
    return np.float32(centred / np.maximum(spread, 1e-9))


def families(table, threshold):
    rows = standardise(table)
    member = np.eye(len(rows), dtype=np.float32)  # one row for each family
    apart = np.sqrt(((rows[:, None, :] - rows[None, :, :]) ** 2).sum(axis=2))
    while len(member) > 1:
        sizes = member.sum(axis=1)
        mean_apart = member @ apart @ member.T / np.outer(sizes, sizes)
        np.fill_diagonal(mean_apart, np.inf)
        i, j = np.unravel_index(np.argmin(mean_apart), mean_apart.shape)
        if mean_apart[i, j] >= threshold:
            break
        member[i] += member[j]
        member = np.delete(member, j, axis=0)
    member = member[np.argsort(member.argmax(axis=1))]
    return member.argmax(axis=0)


def forget(step, before, after):
    return 0.0 * before


def freeze(since):
    def way(step, before, after):
        return np.where(step < since, after, before)

    return way


def memory_test(brain, starts, cylinder, seed, since, maxsteps=500):
    def worth(way):
        runs = [episode(brain, s, cylinder, seed + i, way, maxsteps) for i, s in enumerate(starts)]
        return np.mean([run["rewards"].sum() for run in runs])

    return {"keep": worth(keep), "forget": worth(forget), "freeze": worth(freeze(since))}


def reactions(brain, observation, memories):
    return np.array([think(brain, observation, memory)[0] for memory in memories], np.float32)


# %% einsum_of_gates
# One einsum for the gates, exponentials in place of logistic, a deque for the record.
from collections import deque


def think(brain, observation, memory):
    cells, outputs = memory
    seen = np.hstack([observation, outputs])
    z = np.einsum("gui,i->gu", brain["gates"], seen)
    opened = 1 / (1 + np.exp(-np.array([z[0] + 1, z[1], z[2]])))
    new = opened[0] * cells + opened[1] * np.tanh(z[3])
    shown = opened[2] * np.tanh(new)
    return np.tanh(brain["bias"] + np.dot(brain["readout"], shown)), np.array([new, shown])


def episode(brain, start, cylinder, seed, remember=keep, maxsteps=500):
    arena = arenas.make("discrim", max_steps=maxsteps)
    arena.reset(seed)
    arena.robots[0, :] = np.asarray(start)
    arena.objects[0, 0], arena.objects[0, 1] = cylinder
    arena.sense()
    record, poses, step = deque(), [np.array(arena.robots[0])], 0
    memory = np.zeros((2, 10))
    while not arena.done:
        seen = np.array(arena.observation)
        action, after = think(brain, seen, np.array(memory))
        arena.action = np.array(action)
        reward = arena.step()
        record.append({"observations": seen, "memories": np.array(memory), "actions": action,
                       "rewards": reward})  # fmt: skip
        poses.append(np.array(arena.robots[0]))
        memory = remember(step, memory, after)
        step += 1
    names = ("observations", "memories", "actions", "rewards")
    return {"poses": np.stack(poses)} | {
        name: np.array([row[name] for row in record]) for name in names
    }


# %% product_of_places
# itertools for the places, angles by the remainder of math, a class for the frozen memory.
import itertools
import math


def grid(places, headings):
    def along(low, high):
        if places == 1:
            return [low]
        return [low + (high - low) * i / (places - 1) for i in range(places)]

    turns = [2 * math.pi * k / headings for k in range(headings)]
    triples = itertools.product(along(270, 350), along(150, 250), turns)
    return np.array([[x, y, heading] for y, x, heading in triples])


class Frozen:
    def __init__(self, since):
        self.since = since

    def __call__(self, step, before, after):
        return before.copy() if step >= self.since else after.copy()


def freeze(since):
    return Frozen(since)


def forget(step, before, after):
    return 0.0 * np.asarray(after)


# %% merging_in_a_table
# Sums of distances between groups in a table; the mean and the variance by their formulas.
def standardise(table):
    table = np.asarray(table, dtype=float)
    centred = table - table.sum(axis=0) / len(table)
    spread = np.sqrt((centred**2).sum(axis=0) / len(table))
    result = np.zeros(table.shape)
    for column in range(table.shape[1]):
        if spread[column] > 1e-12:
            result[:, column] = centred[:, column] / spread[column]
    return result


def families(table, threshold):
    rows = standardise(table)
    groups = {i: [i] for i in range(len(rows))}

    def apart(one, other):
        pairs = [np.sqrt(((rows[a] - rows[b]) ** 2).sum()) for a in one for b in other]
        return sum(pairs) / len(pairs)

    while len(groups) > 1:
        keys = sorted(groups)
        best = min((apart(groups[i], groups[j]), j, i) for j in keys for i in keys if i < j)
        if best[0] >= threshold:
            break
        groups[best[2]] = groups[best[2]] + groups.pop(best[1])
    numbers = {}
    for number, key in enumerate(sorted(groups, key=lambda k: min(groups[k]))):
        for robot in groups[key]:
            numbers[robot] = number
    return [numbers[robot] for robot in range(len(rows))]


def reactions(brain, observation, memories):
    found = np.empty((len(memories), 2))
    for i in range(len(memories)):
        found[i], _ = think(brain, observation, memories[i])
    return found


# %% parts_of_z_and_complex_plane
# The gates in two products; arrays made in advance; complex numbers; families as sets.
def think(brain, observation, memory):
    cells, shown = memory
    w_seen, w_shown = brain["gates"][..., :8], brain["gates"][..., 8:]
    net = w_seen @ observation + w_shown @ shown
    f, i, o = 0.5 + 0.5 * np.tanh((net[:3] + np.array([[1.0], [0], [0]])) / 2)
    fresh = f * cells + i * np.tanh(net[3])
    out = o * np.tanh(fresh)
    return list(np.tanh(out @ brain["readout"].T + brain["bias"])), (fresh, out)


def reactions(brain, observation, memories):
    answers = []
    for cells, outputs in memories:
        action, _ = think(brain, observation, (cells, outputs))
        answers.append(action)
    return answers


def forget(step, before, after):
    return np.zeros((2, UNITS))


class freeze:
    def __init__(self, since):
        self.since = since

    def __call__(self, step, before, after):
        return [after, before][step >= self.since]


def episode(brain, start, cylinder, seed, remember=keep, maxsteps=500):
    arena = arenas.make("discrim", max_steps=maxsteps)
    arena.reset(seed)
    arena.objects[0, 0], arena.objects[0, 1] = cylinder
    arena.robots[0, :] = np.asarray(start)
    arena.sense()
    seen = np.empty((maxsteps, 8))
    kept = np.empty((maxsteps, 2, 10))
    acted = np.empty((maxsteps, 2))
    won = np.empty(maxsteps)
    poses = [tuple(arena.robots[0])]
    memory, t = np.zeros((2, 10)), 0
    while t < maxsteps and not arena.done:
        seen[t], kept[t] = arena.observation, memory
        acted[t], after = think(brain, seen[t], kept[t])
        arena.action = acted[t]
        won[t] = arena.step()
        poses.append(tuple(arena.robots[0]))
        memory = remember(t, memory, after)
        t += 1
    return {
        "poses": np.array(poses),
        "observations": seen[:t],
        "memories": kept[:t],
        "actions": acted[:t],
        "rewards": won[:t],
    }


def memory_test(brain, starts, cylinder, seed, since, maxsteps=500):
    def earned(way):
        return sum(
            float(np.sum(episode(brain, s, cylinder, seed + k, way, maxsteps)["rewards"]))
            for k, s in enumerate(starts)
        ) / len(starts)

    return {"freeze": earned(freeze(since)), "forget": earned(forget), "keep": earned(keep)}


def grid(places, headings):
    n = places * places * headings
    k = np.arange(n)
    h, x, y = k % headings, k // headings % places, k // (headings * places)
    step = max(places - 1, 1)
    return np.column_stack([150 + 100 * x / step, 270 + 80 * y / step, 2 * np.pi * h / headings])


def describe(poses, rewards, cylinder):
    z, e = poses[:, 0] + 1j * poses[:, 1], np.exp(1j * poses[:, 2])
    found = np.where(rewards > 0)[0]
    search = np.arange(len(rewards)) < (found[0] if found.size else len(rewards))
    move = np.diff(z)
    to = complex(*cylinder) - z[1:]
    side = (to * e[1:].conj() / np.abs(to)).imag
    wall = np.max(np.abs(poses[:-1, :2] - 200), axis=1) > 127.5
    return {
        "search": int(search.sum()),
        "speed": mean((move * e[:-1].conj()).real[search]),
        "turning": mean(np.angle(e[1:] / e[:-1])[search]),
        "wall": mean(wall[search]),
        "pace": mean(np.abs(move)[found]),
        "side": mean(side[found]),
    }


def standardise(table):
    out = np.zeros(table.shape)
    for c in range(table.shape[1]):
        column = table[:, c]
        if np.ptp(column) > 1e-9 * max(1.0, np.abs(column).max()):
            out[:, c] = (column - np.mean(column)) / np.sqrt(
                np.mean((column - np.mean(column)) ** 2)
            )
    return out


def families(table, threshold):
    z = standardise(table)
    sets = [frozenset([i]) for i in range(len(z))]

    def apart(a, b):
        return np.mean([np.sqrt(((z[i] - z[j]) ** 2).sum()) for i in a for j in b])

    while len(sets) > 1:
        pairs = [
            (apart(a, b), k, m) for k, a in enumerate(sets) for m, b in enumerate(sets) if k < m
        ]
        nearest, k, m = min(pairs)
        if not nearest < threshold - 1e-12:
            break
        merged = sets[k] | sets[m]
        sets = [s for n, s in enumerate(sets) if n not in (k, m)] + [merged]
    names = {}
    out = []
    for i in range(len(z)):
        own = next(s for s in sets if i in s)
        out.append(names.setdefault(own, len(names)))
    return np.array(out)
