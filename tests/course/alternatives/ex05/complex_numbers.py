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
