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
