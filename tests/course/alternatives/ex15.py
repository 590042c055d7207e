"""Right solutions of exercise 15 in other styles; building.py describes how a case is written."""


# %% einsum_and_masks
# Einsum, masks and triangular matrices.
def chase(predator, prey, maxsteps=2000):
    arena = arenas.make("predprey", max_steps=maxsteps)
    arena.reset(seed=12)
    networks, fitness = [robot(predator), robot(prey)], 0.0
    poses = np.empty((maxsteps + 1, 2, 3))
    poses[0], t = arena.robots, 0
    while not arena.done:
        for k in (0, 1):
            networks[k].observation = arena.observation[24 * k : 24 * (k + 1)]
            networks[k].step()
        arena.action = np.ravel([network.action for network in networks])
        fitness += arena.step()
        t += 1
        poses[t] = arena.robots
    return {"poses": poses[: t + 1], "caught": arena.terminated, "fitness": fitness}


def tournament(predators, prey, maxsteps=2000):
    hunters, hunted = np.vstack(predators), np.vstack(prey)
    pairs = np.indices((len(hunters), len(hunted))).reshape(2, -1).T
    found = play(hunters, hunted, pairs, maxsteps)
    return np.reshape(found, (len(predators), predators[0].shape[0], len(prey), prey[0].shape[0]))


def master(table):
    predators = np.einsum("gihj->gh", table) / (table.shape[1] * table.shape[3])
    prey = np.mean(np.transpose(1 - table, (2, 3, 0, 1)), axis=(1, 3))
    return {"prey": prey, "predators": predators}


def profile(matrix):
    below, above = np.tril(np.ones_like(matrix), -1), np.triu(np.ones_like(matrix), 1)
    return {
        "ancient": ((matrix * below).sum(1)[1:] / below.sum(1)[1:]),
        "present": np.einsum("gg->g", matrix),
        "future": (matrix * above).sum(1)[:-1] / above.sum(1)[:-1],
    }


def progress(matrix):
    gains = matrix[1:] - matrix[:-1]
    ancient = np.tri(*gains.shape, dtype=bool)
    return {
        "historical": np.where(ancient, gains, 0).sum(axis=1) / ancient.sum(axis=1),
        "global": np.mean(gains, 1),
        "share": np.mean(np.sign(gains[ancient]) + 1) / 2,
    }


def cycles(matrix):
    wins = (matrix > matrix.T).astype(float)
    count = len(matrix)
    groups = count * (count - 1) * (count - 2) / 6
    return np.trace(wins @ wins @ wins) / 3 / groups if groups else 0.0


def red_queen(matrix):
    own, others = matrix.mean(axis=1), matrix.mean(axis=0)
    change = matrix.diagonal() - matrix[0, 0]
    return {"change": change[1:], "own": own[1:] - own[0], "others": others[1:] - others[0]}


def interval(table, measure, rng, resamples=300):
    G, n, H, m = table.shape
    measures = np.empty(resamples)
    for r in range(resamples):
        i = rng.integers(0, n, size=(G, n))[:, :, None, None]
        j = rng.integers(0, m, size=(H, m))[None, None]
        g, h = np.arange(G)[:, None, None, None], np.arange(H)[None, None, :, None]
        measures[r] = measure(table[g, i, h, j])
    return tuple(np.percentile(measures, [2.5, 97.5]).tolist())


def describe(poses):
    place, heading = poses[..., :2], poses[..., 2]
    ahead = np.stack([np.cos(heading), np.sin(heading)], axis=-1)[:-1]
    moved = np.diff(place, axis=0)
    turned = np.angle(np.exp(1j * np.diff(heading, axis=0)))
    to_other = (place[:, ::-1] - place)[:-1]
    apart = np.sqrt((to_other**2).sum(-1))
    cosine = np.einsum("tkx,tkx->tk", ahead, to_other) / apart
    inside = ((place >= 300) & (place <= 2700)).all(axis=-1)[:-1]
    return {
        "speed": 10 * np.hypot(*np.moveaxis(moved, -1, 0)).mean(0),
        "turning": np.mean(10 * np.abs(turned), axis=0),
        "backwards": np.mean(np.einsum("tkx,tkx->tk", ahead, moved) < 0, axis=0),
        "facing": np.mean(cosine > np.sqrt(0.5), axis=0),
        "wall": 1 - inside.mean(axis=0),
        "distance": apart.mean(),
    }


# %% loops_and_lists
# Loops and lists instead of arrays.
import math


def chase(predator, prey, maxsteps=2000):
    arena = arenas.make("predprey", max_steps=maxsteps)
    arena.reset(1)
    hunter, hunted = robot(predator), robot(prey)
    poses, rewards = [[list(each) for each in arena.robots]], []
    while not arena.done:
        seen = list(arena.observation)
        hunter.observation, hunted.observation = seen[:24], seen[24:]
        arena.action = [*hunter.step(), *hunted.step()]
        rewards.append(arena.step())
        poses.append([list(each) for each in arena.robots])
    return {"poses": poses, "caught": bool(arena.terminated), "fitness": sum(rewards)}


def tournament(predators, prey, maxsteps=2000):
    table = np.zeros((len(predators), len(predators[0]), len(prey), len(prey[0])))
    for g, hunters in enumerate(predators):
        for h, hunted in enumerate(prey):
            pairs = [[i, j] for i in range(len(hunters)) for j in range(len(hunted))]
            found = play(hunters, hunted, np.array(pairs), maxsteps)
            for (i, j), fitness in zip(pairs, found, strict=True):
                table[g, i, h, j] = fitness
    return table


def master(table):
    G, n, H, m = np.shape(table)
    predators = [[0.0] * H for _ in range(G)]
    prey = [[0.0] * G for _ in range(H)]
    for g in range(G):
        for h in range(H):
            for i in range(n):
                for j in range(m):
                    predators[g][h] += table[g, i, h, j] / (n * m)
            prey[h][g] = 1 - predators[g][h]
    return {"predators": predators, "prey": prey}


def profile(matrix):
    rows = matrix.tolist()
    G = len(rows)
    return {
        "ancient": [sum(rows[g][:g]) / g for g in range(1, G)],
        "present": [rows[g][g] for g in range(G)],
        "future": [sum(rows[g][g + 1 :]) / (G - g - 1) for g in range(G - 1)],
    }


def progress(matrix):
    G, historical, everywhere, points, cases = len(matrix), [], [], 0.0, 0
    for g in range(1, G):
        gains = [matrix[g][k] - matrix[g - 1][k] for k in range(G)]
        historical.append(sum(gains[:g]) / g)
        everywhere.append(sum(gains) / G)
        for k in range(g):
            cases += 1
            if matrix[g][k] > matrix[g - 1][k]:
                points += 1
            elif matrix[g][k] == matrix[g - 1][k]:
                points += 0.5
    return {"historical": historical, "global": everywhere, "share": points / cases}


def cycles(matrix):
    from itertools import combinations

    def beats(a, b):
        return matrix[a, b] > matrix[b, a]

    groups = list(combinations(range(len(matrix)), 3))
    if not groups:
        return 0
    found = 0
    for a, b, c in groups:
        wins = sorted([beats(x, y) + 0 for x, y in ((a, b), (b, c), (c, a))])
        draws = any(matrix[x, y] == matrix[y, x] for x, y in ((a, b), (b, c), (c, a)))
        found += not draws and wins in ([0, 0, 0], [1, 1, 1])
    return found / len(groups)


def red_queen(matrix):
    G = len(matrix)
    parts = {"change": [], "own": [], "others": []}
    for g in range(1, G):
        parts["change"].append(matrix[g][g] - matrix[0][0])
        parts["own"].append(sum(matrix[g][k] - matrix[0][k] for k in range(G)) / G)
        parts["others"].append(sum(matrix[k][g] - matrix[k][0] for k in range(G)) / G)
    return parts


def interval(table, measure, rng, resamples=300):
    G, n, H, m = table.shape
    measures = []
    for _ in range(resamples):
        hunters = rng.integers(n, size=(G, n))
        hunted = rng.integers(m, size=(H, m))
        drawn = np.zeros((G, n, H, m))
        for g in range(G):
            for i in range(n):
                for h in range(H):
                    for j in range(m):
                        drawn[g, i, h, j] = table[g, hunters[g, i], h, hunted[h, j]]
        measures.append(measure(drawn))
    return [np.quantile(measures, 0.025), np.quantile(measures, 0.975)]


def describe(poses):
    T = len(poses) - 1
    names = ("speed", "turning", "backwards", "facing", "wall")
    found = {name: [0.0, 0.0] for name in names}
    found["distance"] = 0.0
    for t in range(T):
        found["distance"] += math.dist(poses[t][0][:2], poses[t][1][:2]) / T
        for k in (0, 1):
            x, y, heading = poses[t][k]
            x2, y2, heading2 = poses[t + 1][k]
            found["speed"][k] += 10 * math.hypot(x2 - x, y2 - y) / T
            turn = math.remainder(heading2 - heading, 2 * math.pi)
            found["turning"][k] += 10 * abs(turn) / T
            if (x2 - x) * math.cos(heading) + (y2 - y) * math.sin(heading) < 0:
                found["backwards"][k] += 1 / T
            other = poses[t][1 - k]
            bearing = math.atan2(other[1] - y, other[0] - x) - heading
            while bearing > math.pi:
                bearing -= 2 * math.pi
            while bearing < -math.pi:
                bearing += 2 * math.pi
            if abs(bearing) < math.radians(45):
                found["facing"][k] += 1 / T
            if x < 300 or y < 300 or x > 2700 or y > 2700:
                found["wall"][k] += 1 / T
    return found


# %% one_chase_after_another
# The tournament by one's own chase, complex numbers for the poses, resamples by rows.
def chase(predator, prey, maxsteps=2000):
    arena = arenas.make("predprey", max_steps=maxsteps)
    arena.reset(seed=3)
    networks = robot(predator), robot(prey)
    trail, total = [np.array(arena.robots)], 0.0
    for _ in range(maxsteps):
        views = np.array(arena.observation).reshape(2, 24)
        wheels = []
        for network, view in zip(networks, views, strict=False):
            network.observation = view
            wheels.append(np.array(network.step()))
        arena.action = np.hstack(wheels)
        total += arena.step()
        trail.append(np.array(arena.robots))
        if arena.terminated:
            break
    return {"poses": np.stack(trail), "caught": arena.terminated, "fitness": np.float64(total)}


def tournament(predators, prey, maxsteps=2000):
    return np.array(
        [
            [
                [[chase(a, b, maxsteps)["fitness"] for b in hunted] for hunted in prey]
                for a in hunters
            ]
            for hunters in predators
        ]
    )


def master(table):
    mean = np.mean(np.mean(table, axis=3), axis=1)
    return {"predators": mean.copy(), "prey": np.ones_like(mean.T) - mean.T}


def profile(matrix):
    split = [np.split(row, [g, g + 1]) for g, row in enumerate(matrix)]
    return {
        "ancient": np.array([ancient.mean() for ancient, _, _ in split[1:]]),
        "present": np.array([present[0] for _, present, _ in split]),
        "future": np.array([future.mean() for _, _, future in split[:-1]]),
    }


def progress(matrix):
    sums = np.cumsum(matrix, axis=1)
    count = len(matrix)
    historical = [(sums[g, g - 1] - sums[g - 1, g - 1]) / g for g in range(1, count)]
    better, cases = 0, 0
    for g in range(1, count):
        gain = matrix[g, :g] - matrix[g - 1, :g]
        better += np.count_nonzero(gain > 0) + np.count_nonzero(gain == 0) / 2
        cases += g
    means = matrix.mean(axis=1)
    return {"historical": historical, "global": means[1:] - means[:-1], "share": better / cases}


def cycles(matrix):
    signs = np.sign(matrix - matrix.T)
    G, found, groups = len(signs), 0, 0
    for c in range(2, G):
        for b in range(1, c):
            for a in range(b):
                groups += 1
                found += abs(signs[a, b] + signs[b, c] + signs[c, a]) == 3
    return found / max(groups, 1)


def red_queen(matrix):
    G = matrix.shape[0]
    return {
        "change": np.array([matrix[g, g] - matrix[0, 0] for g in range(1, G)]),
        "own": np.array([np.mean(matrix[g] - matrix[0]) for g in range(1, G)]),
        "others": np.array([np.mean(matrix[:, g] - matrix[:, 0]) for g in range(1, G)]),
    }


def interval(table, measure, rng, resamples=300):
    G, n, H, m = table.shape

    def resample():
        chosen, met = rng.integers(n, size=(G, n)), rng.integers(m, size=(H, m))
        rows = np.stack([table[g][chosen[g]] for g in range(G)])
        return np.stack([rows[:, :, h][:, :, met[h]] for h in range(H)], axis=2)

    measures = sorted(measure(resample()) for _ in range(resamples))
    return tuple(float(np.quantile(measures, q)) for q in (0.025, 0.975))


def describe(poses):
    poses = np.asarray(poses)
    place, turn = poses[..., 0] + 1j * poses[..., 1], np.exp(1j * poses[..., 2])
    step = np.diff(place, axis=0)
    other = (place[:, ::-1] - place)[:-1]
    margin = np.stack([poses[..., 0], poses[..., 1], 3000 - poses[..., 0], 3000 - poses[..., 1]])
    return {
        "speed": np.abs(step).mean(axis=0) / 0.1,
        "turning": np.abs(np.angle(turn[1:] / turn[:-1])).mean(axis=0) / 0.1,
        "backwards": ((step * turn[:-1].conj()).real < 0).mean(axis=0),
        "facing": (np.abs(np.angle(other / turn[:-1], deg=True)) < 45).mean(axis=0),
        "wall": (margin.min(axis=0)[:-1] < 300).mean(axis=0),
        "distance": np.abs(other[:, 0]).mean(),
    }


# %% sums_in_place_of_means
# Sums and counts in place of means, loops over generations, a table of the pairs.
def master(table):
    count, n, others, m = np.shape(table)
    predators = np.einsum("ginj->gn", table) / (n * m)
    return {"prey": np.array([[1 - predators[g, h] for g in range(count)] for h in range(others)]),
            "predators": predators}  # fmt: skip


def profile(matrix):
    count = len(matrix)
    below, above = np.tril(matrix, -1), np.triu(matrix, 1)
    numbers = np.arange(1, count)
    return {
        "future": above.sum(axis=1)[:-1] / numbers[::-1],
        "ancient": below.sum(axis=1)[1:] / numbers,
        "present": [matrix[g][g] for g in range(count)],
    }


def red_queen(matrix):
    count = len(matrix)
    rows, columns = matrix.sum(axis=1) / count, matrix.sum(axis=0) / count
    present = matrix.diagonal()
    return {
        "own": rows[1:] - rows[0],
        "others": columns[1:] - columns[0],
        "change": present[1:] - present[0],
    }


# %% combinations
# itertools for the triples, generators for the cases, complex numbers for the headings.
from itertools import combinations


def cycles(matrix):
    groups = list(combinations(range(len(matrix)), 3))
    won = [[matrix[a, b] > matrix[b, a] for b in range(len(matrix))] for a in range(len(matrix))]
    found = 0
    for group in groups:
        wins = sorted(sum(won[a][b] for b in group if b != a) for a in group)
        found += wins == [1, 1, 1]
    return found / len(groups) if groups else 0


def progress(matrix):
    count = len(matrix)
    historical, overall, points, cases = [], [], 0.0, 0
    for g in range(1, count):
        gains = [matrix[g][h] - matrix[g - 1][h] for h in range(count)]
        overall.append(sum(gains) / count)
        historical.append(sum(gains[:g]) / g)
        points += sum(1.0 if gain > 0 else 0.5 if gain == 0 else 0.0 for gain in gains[:g])
        cases += g
    return {"historical": historical, "global": overall, "share": points / cases}


# %% take_along_axis
# take_along_axis for the resamples, percentiles, arenas with a list of actions.
def interval(table, measure, rng, resamples=300):
    table = np.asarray(table)
    found = np.empty(resamples)
    for i in range(resamples):
        first = rng.integers(0, table.shape[1], (table.shape[0], table.shape[1]))
        second = rng.integers(0, table.shape[3], (table.shape[2], table.shape[3]))
        drawn = np.take_along_axis(table, first[:, :, None, None], axis=1)
        found[i] = measure(np.take_along_axis(drawn, second[None, None], axis=3))
    return tuple(np.percentile(found, [2.5, 97.5]))


def chase(predator, prey, maxsteps=2000):
    arena = arenas.make("predprey", max_steps=maxsteps)
    arena.reset(seed=1)
    minds, poses, total = [robot(predator), robot(prey)], [np.array(arena.robots)], 0
    half = len(arena.observation) // 2
    while not arena.done:
        seen, wheels = np.array(arena.observation), []
        for i, mind in enumerate(minds):
            mind.observation = seen[i * half : (i + 1) * half]
            wheels += list(mind.step())
        arena.action = np.array(wheels)
        total = total + arena.step()
        poses.append(np.array(arena.robots))
    return {"fitness": total, "caught": bool(arena.terminated), "poses": np.stack(poses)}
