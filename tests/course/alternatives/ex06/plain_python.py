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
