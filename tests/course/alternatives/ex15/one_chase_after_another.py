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
