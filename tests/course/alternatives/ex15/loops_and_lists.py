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
