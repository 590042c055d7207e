"""Right solutions of exercise 5 in other styles; building.py describes how a case is written."""

# %% complex_numbers
# The plane as complex numbers; a class that takes a body apart; einsum and deleted diagonals.
from functools import cached_property


class Body:
    def __init__(self, parameters):
        self.p = np.asarray(parameters)

    @cached_property
    def scales(self):
        return np.einsum("sk,k->ks", 1 + 0.9 * np.tanh(self.p[:22].reshape(11, 2)), [0.8, 0.2])

    @cached_property
    def masses(self):
        return np.einsum("s,s,s->s", *self.scales, 5 + 0.8 * np.tanh(self.p[53:64]))

    @cached_property
    def angles(self):
        return np.interp(self.p[42:53], [-1, 1], [-0.75 * np.pi, 0.75 * np.pi])

    @cached_property
    def limits(self):
        both = np.interp(self.p[22:42], [-1, 1], [-np.pi / 2, np.pi / 2])
        return np.minimum(both[::2], both[1::2]), np.maximum(both[::2], both[1::2])

    @cached_property
    def corners(self):
        heading = np.cumprod(np.exp(1j * self.angles))
        ends = np.cumsum(self.scales[0] * heading)
        begins = ends - self.scales[0] * heading
        side = 0.5j * self.scales[1] * heading
        return np.array([begins - side, ends - side, ends + side, begins + side]).T


def sizes(parameters):
    body = Body(parameters)
    return {"lengths": body.scales[0], "thicknesses": body.scales[1], "masses": body.masses}


def joints(parameters):
    body = Body(parameters)
    return dict(zip(("angles", "lower", "upper"), (body.angles, *body.limits)))


def outline(parameters):
    corners = Body(parameters).corners
    return np.dstack([corners.real, corners.imag])


def describe(parameters):
    body = Body(parameters)
    return {
        "length": body.scales[0].sum(),
        "mass": body.masses.sum(),
        "width": np.ptp(body.corners.real),
        "height": np.ptp(body.corners.imag),
        "freedom": np.subtract(*body.limits[::-1]).mean(),
    }


def evolve_walkers(experiment_file, seeds, folder, steps=None):
    Path(folder).mkdir(parents=True, exist_ok=True)

    def walkers():
        for seed in seeds:
            run = Run(config.load(experiment_file), seed)
            evolve(run, Path(folder), steps)
            yield run.record.bestg

    return np.stack(tuple(walkers()))


def body_of(genotype):
    return np.take(genotype, range(-134, -70))


def transplant(brain, body):
    places = np.arange(len(brain))
    inside = (places >= len(brain) - 134) & (places < len(brain) - 70)
    return np.where(inside, body, brain)


def cross_evaluate(experiment_file, walkers, seed, episodes):
    def meet(i, j):
        robot = SavedRobot(experiment_file, transplant(walkers[int(i)], walkers[int(j)]))
        return robot.evaluate(seed, episodes).mean()

    return np.vectorize(meet)(*np.indices((len(walkers), len(walkers))))


def loss(matrix):
    n = len(matrix)
    others = matrix[~np.eye(n, dtype=bool)].reshape(n, n - 1)
    above = matrix.T[~np.eye(n, dtype=bool)].reshape(n, n - 1)
    own = np.einsum("ii->i", matrix)
    return {
        "own": np.trace(matrix) / n,
        "foreign": np.average(others),
        "brains": np.mean(own[:, None] - others, axis=1),
        "bodies": np.mean(own[:, None] - above, axis=1),
        "at home": int(np.all(own[:, None] > others, axis=1).sum()),
    }


# %% plain_python
# Loops and `math`; lists and tuples come back; the best walkers are read from the files.
import math
import os


def cut(value):
    return max(-1.0, min(1.0, float(value)))


def sizes(parameters):
    found = {"lengths": [], "thicknesses": [], "masses": []}
    for i in range(SEGMENTS):
        length = 0.8 * (1 + 0.9 * math.tanh(parameters[2 * i]))
        thickness = 0.2 * (1 + 0.9 * math.tanh(parameters[2 * i + 1]))
        found["lengths"].append(length)
        found["thicknesses"].append(thickness)
        found["masses"].append(length * thickness * (5 + 0.8 * math.tanh(parameters[53 + i])))
    return found


def joints(parameters):
    lower, upper = [], []
    for i in range(JOINTS):
        ends = [math.pi / 2 * cut(parameters[22 + 2 * i + k]) for k in (0, 1)]
        lower.append(min(ends))
        upper.append(max(ends))
    angles = [math.radians(135) * cut(parameters[42 + i]) for i in range(SEGMENTS)]
    return {"angles": tuple(angles), "lower": tuple(lower), "upper": tuple(upper)}


def outline(parameters):
    size, angles = sizes(parameters), joints(parameters)["angles"]
    x = y = heading = 0.0
    corners = []
    for length, thickness, angle in zip(size["lengths"], size["thicknesses"], angles):
        heading += angle
        c, s = math.cos(heading), math.sin(heading)
        w = thickness / 2
        x2, y2 = x + length * c, y + length * s
        corners.append(
            [
                (x + w * s, y - w * c),
                (x2 + w * s, y2 - w * c),
                (x2 - w * s, y2 + w * c),
                (x - w * s, y + w * c),
            ]
        )
        x, y = x2, y2
    return np.array(corners)


def describe(parameters):
    size, angles = sizes(parameters), joints(parameters)
    xs = [x for segment in outline(parameters) for x, _ in segment]
    ys = [y for segment in outline(parameters) for _, y in segment]
    return {
        "length": sum(size["lengths"]),
        "mass": sum(size["masses"]),
        "width": max(xs) - min(xs),
        "height": max(ys) - min(ys),
        "freedom": sum(u - l for l, u in zip(angles["lower"], angles["upper"])) / JOINTS,
    }


def evolve_walkers(experiment_file, seeds, folder, steps=None):
    os.makedirs(folder, exist_ok=True)
    for seed in seeds:
        evolve(Run(config.load(experiment_file), seed), Path(folder), steps)
    return [np.load(os.path.join(folder, f"bestgS{seed}.npy")) for seed in seeds]


def body_of(genotype):
    end = len(genotype) - 70
    return [genotype[i] for i in range(end - 64, end)]


def transplant(brain, body):
    chimera = list(brain)
    end = len(chimera) - 70
    chimera[end - 64 : end] = body_of(body)
    return np.array(chimera)


def cross_evaluate(experiment_file, walkers, seed, episodes):
    table = []
    for brain in walkers:
        row = []
        for body in walkers:
            robot = SavedRobot(experiment_file, transplant(brain, body))
            returns = robot.evaluate(seed, episodes)
            row.append(sum(returns) / episodes)
        table.append(row)
    return np.array(table)


def loss(matrix):
    n = len(matrix)
    own, foreign, home = [], [], 0
    brains, bodies = [], []
    for i in range(n):
        row = [matrix[i][j] for j in range(n) if j != i]
        column = [matrix[j][i] for j in range(n) if j != i]
        own.append(matrix[i][i])
        foreign += row
        brains.append(own[i] - sum(row) / len(row))
        bodies.append(own[i] - sum(column) / len(column))
        home += all(own[i] > value for value in row)
    return {
        "own": sum(own) / n,
        "foreign": sum(foreign) / len(foreign),
        "brains": brains,
        "bodies": bodies,
        "at home": home,
    }


# %% single_precision
# Single precision and slices with steps; rotation matrices; masked arrays.
def sizes(parameters):
    p = np.float32(parameters)
    squeeze = lambda values, nominal: nominal + 0.9 * nominal * np.tanh(values)
    lengths, thicknesses = squeeze(p[0:22:2], np.float32(0.8)), squeeze(p[1:22:2], np.float32(0.2))
    masses = np.prod([lengths, thicknesses, 5 + np.float32(0.8) * np.tanh(p[-11:])], axis=0)
    return {"lengths": lengths, "thicknesses": thicknesses, "masses": masses}


def joints(parameters):
    p = np.float32(np.minimum(np.maximum(parameters, -1), 1))
    limits = np.sort(p[22:42].reshape(10, 2) * np.float32(np.pi / 2))
    return {
        "angles": p[42:53] * np.float32(0.75 * np.pi),
        "lower": limits[:, 0],
        "upper": limits[:, 1],
    }


def outline(parameters):
    size = sizes(parameters)
    headings = np.cumsum(joints(parameters)["angles"], dtype=np.float32)
    corners = np.empty((SEGMENTS, 4, 2), dtype=np.float32)
    begin = np.zeros(2, dtype=np.float32)
    for i, heading in enumerate(headings):
        turn = np.array([[np.cos(heading), -np.sin(heading)], [np.sin(heading), np.cos(heading)]])
        length, half = size["lengths"][i], size["thicknesses"][i] / 2
        box = np.array([[0, -half], [length, -half], [length, half], [0, half]])
        corners[i] = begin + box @ turn.T
        begin = begin + turn @ (length, 0)
    return corners


def describe(parameters):
    size, angles, corners = sizes(parameters), joints(parameters), outline(parameters)
    span = corners.reshape(-1, 2).max(axis=0) - corners.reshape(-1, 2).min(axis=0)
    return {
        "freedom": np.mean(angles["upper"]) - np.mean(angles["lower"]),
        "length": size["lengths"].sum(),
        "mass": size["masses"].sum(),
        "width": span[0],
        "height": span[1],
    }


def evolve_walkers(experiment_file, seeds, folder, steps=None):
    place = Path(folder)
    place.mkdir(parents=True, exist_ok=True)
    walkers = None
    for seed in seeds:
        run = Run(config.load(experiment_file), seed)
        evolve(run, place, steps)
        best = np.atleast_2d(run.record.bestg)
        walkers = best if walkers is None else np.vstack([walkers, best])
    return walkers


def body_of(genotype):
    return np.split(genotype, [len(genotype) - 134, len(genotype) - 70])[1]


def transplant(brain, body):
    cuts = [len(brain) - 134, len(brain) - 70]
    before, _, after = np.split(brain, cuts)
    return np.concatenate([before, body_of(body), after])


def cross_evaluate(experiment_file, walkers, seed, episodes):
    matrix = np.full((len(walkers), len(walkers)), np.nan, dtype=np.float32)
    for i, j in np.ndindex(matrix.shape):
        walker = SavedRobot(experiment_file, transplant(walkers[i], walkers[j]))
        matrix[i, j] = np.mean(walker.evaluate(seed, episodes))
    return matrix


def loss(matrix):
    own = matrix.diagonal()
    others = np.ma.masked_array(matrix, mask=np.eye(len(matrix)))
    return {
        "own": own.mean(),
        "foreign": np.float32(others.mean()),
        "brains": np.float32(own - others.mean(axis=1).data),
        "bodies": np.float32(own - others.mean(axis=0).data),
        "at home": np.count_nonzero(own > others.max(axis=1).data),
    }


# %% folder_as_text
# The folder stays a text; seeds give a dict of runs; hstack, partial sums and a loop of corners.
import os


def sizes(parameters):
    squeezed = np.tanh(parameters)
    lengths, thicknesses = (
        np.array([nominal * (1 + 0.9 * squeezed[2 * i + k]) for i in range(SEGMENTS)])
        for k, nominal in enumerate((0.8, 0.2))
    )
    return {
        "masses": lengths * thicknesses * (5 + 0.8 * squeezed[-11:]),
        "lengths": lengths,
        "thicknesses": thicknesses,
    }


def evolve_walkers(experiment_file, seeds, folder, steps=None):
    os.makedirs(folder, exist_ok=True)
    runs = {seed: Run(config.load(experiment_file), seed) for seed in seeds}
    for run in runs.values():
        evolve(run, folder, steps=steps)
    return np.vstack([runs[seed].record.bestg for seed in seeds])


def transplant(brain, body):
    return np.hstack([brain[:-134], body[-134:-70], brain[-70:]])


# %% walking_along_the_chain
# One loop along the chain for the outline; sorted limits; extremes by min and max of lists.
import math


def joints(parameters):
    cut = [max(-1.0, min(1.0, float(p))) for p in parameters]
    pairs = [sorted(cut[i : i + 2]) for i in range(22, 42, 2)]
    return {
        "angles": [0.75 * math.pi * p for p in cut[42:53]],
        "lower": [pair[0] * math.pi / 2 for pair in pairs],
        "upper": np.array([pair[1] for pair in pairs]) * math.pi / 2,
    }


def outline(parameters):
    size, corners, x, y, heading = sizes(parameters), [], 0.0, 0.0, 0.0
    turns = joints(parameters)["angles"]
    for length, thickness, turn in zip(size["lengths"], size["thicknesses"], turns):
        heading = math.remainder(heading + turn, 2 * math.pi)
        right = (thickness / 2 * math.sin(heading), -thickness / 2 * math.cos(heading))
        x2, y2 = x + length * math.cos(heading), y + length * math.sin(heading)
        corners.append(
            [
                (x + right[0], y + right[1]),
                (x2 + right[0], y2 + right[1]),
                (x2 - right[0], y2 - right[1]),
                (x - right[0], y - right[1]),
            ]
        )
        x, y = x2, y2
    return corners


def describe(parameters):
    xs, ys = zip(*[corner for segment in outline(parameters) for corner in segment])
    size, angles = sizes(parameters), joints(parameters)
    spans = [upper - lower for lower, upper in zip(angles["lower"], angles["upper"])]
    return {
        "length": sum(size["lengths"]),
        "mass": sum(size["masses"]),
        "width": max(xs) - min(xs),
        "height": max(ys) - min(ys),
        "freedom": sum(spans) / len(spans),
    }


# %% masks_and_means
# Masked means for the losses; a table filled by column; splits of the genotype.
def body_of(genotype):
    return np.split(np.asarray(genotype), [-134, -70])[1]


def transplant(brain, body):
    parts = np.split(brain, [len(brain) - 134, len(brain) - 70])
    parts[1] = body_of(body)
    return np.concatenate(parts)


def cross_evaluate(experiment_file, walkers, seed, episodes):
    columns = []
    for body in walkers:
        robots = (SavedRobot(experiment_file, transplant(brain, body)) for brain in walkers)
        columns.append([np.mean(robot.evaluate(seed, episodes)) for robot in robots])
    return np.transpose(columns).astype(np.float32)


def loss(matrix):
    table = np.asarray(matrix, dtype=np.float32)
    off = ~np.eye(len(table), dtype=bool)
    own = np.array([table[i, i] for i in range(len(table))])
    rows = table[off].reshape(len(table), -1)
    columns = table.T[off].reshape(len(table), -1)
    return {
        "own": own.mean(),
        "foreign": table[off].mean(),
        "brains": own - rows.mean(axis=1),
        "bodies": list(own - columns.mean(axis=1)),
        "at home": sum(bool(np.all(mine > others)) for mine, others in zip(own, rows)),
    }


# %% frames_and_rolled_rows
# Frames by matrix products along the chain; rolled genotypes and rows; walkers kept by seed.
def _segment(p, k):
    t = np.tanh(np.asarray(p, dtype=float)[[2 * k, 2 * k + 1, 53 + k]])
    return {"l": 0.8 + 0.72 * t[0], "t": 0.2 + 0.18 * t[1], "d": 5 + 0.8 * t[2]}


def sizes(parameters):
    parts = [_segment(parameters, k) for k in range(SEGMENTS)]
    return {
        "masses": tuple(s["l"] * s["t"] * s["d"] for s in parts),
        "thicknesses": tuple(s["t"] for s in parts),
        "lengths": tuple(s["l"] for s in parts),
        "names": "extra",
    }


def joints(parameters):
    own = list(parameters)
    turn = [max(-1.0, min(1.0, v)) for v in own]
    lower, upper = [], []
    for j in range(JOINTS):
        pair = sorted(turn[22 + 2 * j : 24 + 2 * j])
        lower.append(pair[0] * np.pi / 2)
        upper.append(pair[1] * np.pi / 2)
    return {"angles": [v * np.pi * 0.75 for v in turn[42:53]], "lower": lower, "upper": upper}


def outline(parameters):
    size, bends = sizes(parameters), joints(parameters)["angles"]
    frame = np.eye(3)
    found = []
    for length, thick, bend in zip(size["lengths"], size["thicknesses"], bends, strict=True):
        c, s = np.cos(bend), np.sin(bend)
        frame = frame @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
        box = np.array(
            [[0, length, length, 0], [-thick / 2, -thick / 2, thick / 2, thick / 2], [1, 1, 1, 1]]
        )
        found.append((frame @ box)[:2].T)
        frame = frame @ np.array([[1, 0, length], [0, 1, 0], [0, 0, 1]])
    return np.stack(found)


def describe(parameters):
    size, angle = sizes(parameters), joints(parameters)
    xs, ys = zip(*outline(parameters).reshape(-1, 2).tolist())
    return {
        "length": sum(size["lengths"]),
        "mass": sum(size["masses"]),
        "width": max(xs) - min(xs),
        "height": max(ys) - min(ys),
        "freedom": sum(u - l for u, l in zip(angle["upper"], angle["lower"])) / JOINTS,
    }


def body_of(genotype):
    return np.roll(genotype, 134)[:64].copy()


def transplant(brain, body):
    places = np.arange(len(brain) - 134, len(brain) - 70)
    new = np.array(brain, copy=True)
    np.put(new, places, np.take(body, places))
    return new


def cross_evaluate(experiment_file, walkers, seed, episodes):
    n = len(walkers)
    table = np.empty(n * n)
    for k in reversed(range(n * n)):
        i, j = divmod(k, n)
        table[k] = np.average(
            SavedRobot(experiment_file, transplant(walkers[i], walkers[j])).evaluate(seed, episodes)
        )
    return table.reshape(n, n)


def loss(matrix):
    n = len(matrix)
    turned = np.array([np.roll(matrix[i], -i) for i in range(n)])
    columns = np.array([np.roll(matrix[:, i], -i) for i in range(n)])
    return {
        "own": turned[:, 0].mean(),
        "foreign": turned[:, 1:].mean(),
        "brains": (turned[:, :1] - turned[:, 1:]).mean(axis=1),
        "bodies": (columns[:, :1] - columns[:, 1:]).mean(axis=1),
        "at home": np.count_nonzero((turned[:, :1] > turned[:, 1:]).all(axis=1)),
    }


def evolve_walkers(experiment_file, seeds, folder, steps=None):
    import os

    os.makedirs(folder, exist_ok=True)
    known = {}

    def walker(seed):
        if seed not in known:
            run = Run(config.load(experiment_file), seed)
            evolve(run, str(folder), steps)
            known[seed] = np.array(run.record.bestg)
        return known[seed]

    return np.stack(list(map(walker, seeds)))
