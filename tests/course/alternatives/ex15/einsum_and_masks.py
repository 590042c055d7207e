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
