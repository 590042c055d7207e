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
