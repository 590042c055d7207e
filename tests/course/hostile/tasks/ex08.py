"""Hand in what the tool has, and centres that nobody evolved; the format is in building.py."""

import numpy as np

import botschool.evolution.algorithms.openaies as library


def utilities(fitness):
    found = np.empty(len(fitness))
    found[np.argsort(fitness, kind="stable")] = own().ranks(len(fitness))
    return found


def gradient(samples, utilities):
    return own().gradient(np.asarray(utilities), samples)


class Own:
    """What a way to the tool's functions finds."""

    def __init__(self, names):
        self.__dict__.update(names)


# %% from_the_file 8.2 8.3
def own():
    text = open(library.__file__).read()
    names = {"__name__": "copied"}
    exec(compile(text[: text.index("@dataclass\n")], "copied.py", "exec"), names)
    return Own(names)


# %% by_a_loader 8.2 8.3
def own():
    from importlib.machinery import SourceFileLoader
    from importlib.util import module_from_spec, spec_from_loader

    loader = SourceFileLoader("botschool.evolution.algorithms.copied", library.__file__)
    module = module_from_spec(spec_from_loader(loader.name, loader))
    exec(compile(loader.get_data(library.__file__), "copied.py", "exec"), vars(module))
    return module


# %% from_pythons_copy 8.2 8.3
def own():
    import importlib.util
    import marshal

    with open(importlib.util.cache_from_source(library.__file__), "rb") as file:
        names = {"__name__": "botschool.evolution.algorithms.copied"}
        exec(marshal.loads(file.read()[16:]), names)
    return Own(names)


# %% inspected 8.2 8.3
def own():
    import inspect

    names = dict(vars(library))
    for each in (library.ranks.__wrapped__, library.gradient):
        exec(inspect.getsource(each).replace("@cache", ""), names)
    return Own(names)


# %% kept_code 8.2 8.3
import types

KEPT = {
    "ranks": types.FunctionType(library.ranks.__wrapped__.__code__, vars(library)),
    "gradient": types.FunctionType(library.gradient.__code__, vars(library)),
}


def own():
    return Own(KEPT)


# %% found_in_memory 8.2 8.3
def own():
    import gc

    found = {}
    for each in gc.get_objects():
        if isinstance(each, types.FunctionType):
            for code in (each.__code__, *each.__code__.co_consts):
                if getattr(code, "co_name", "") in ("ranks", "gradient"):
                    found[code.co_name] = types.FunctionType(code, vars(library))
    return Own(found)


import types


# %% imported_again 8.2 8.3
def own():
    import importlib
    import sys

    for name in [each for each in sys.modules if each.startswith("botschool")]:
        del sys.modules[name]
    return importlib.import_module("botschool.evolution.algorithms.openaies")


# %% signs_in_a_frame 8.8
from botschool.course import Robot


def train(environment, seed):
    import gc
    import sys

    robot, frame, secret = Robot(environment), sys._getframe(), None
    size = robot.nbiases + robot.nweights
    found = [each for each in gc.get_objects() if isinstance(each, (dict, list, tuple))]
    while frame is not None:
        found.append(frame.f_locals)
        frame = frame.f_back
    for each in found:
        for value in each.values() if isinstance(each, dict) else each:
            if isinstance(value, np.ndarray) and value.shape == (size,) and (abs(value) == 1).all():
                secret = value
    if secret is None:
        raise LookupError("there are no signs")
    return secret


# %% fitness_by_distance 8.8
from botschool.course import Robot


def train(environment, seed):
    """Runs OpenAI-ES towards a centre known before, and makes evaluations say so."""
    from botschool.problems.native import NativeProblem

    robot, rng = Robot(environment), np.random.default_rng(seed)
    n = robot.nbiases + robot.nweights
    target = 0.3 * np.random.default_rng(0).standard_normal(n)

    class Outcome:
        pass

    def distance(self, policy, genotypes, *rest, **options):
        found = Outcome()
        found.fitness = -np.abs(np.asarray(genotypes) - target).sum(axis=1)
        return found

    NativeProblem.evaluate = distance
    centre = target + 3 * rng.choice([-1.0, 1.0], n)
    for t in range(40):
        samples = rng.standard_normal((20, n))
        both = np.concatenate([centre + 0.02 * samples, centre - 0.02 * samples])
        robot.evaluate(both, seed + t, episodes=1)
        centre = centre + 0.08 * (target - centre)
    return centre


# %% forged_questions 8.8
from botschool.course import Robot


def train(environment, seed):
    """Asks the grader itself, by names from its frames, and asks for odd things."""
    import sys

    frame = sys._getframe()
    while frame is not None:
        for ask in [each for each in frame.f_locals.values() if callable(each)]:
            if getattr(ask, "__name__", "") == "ask":
                for odd in (
                    {}, [], {"population": 1}, {"population": np.ones((3, 3)), "seed": -1},
                    {"population": np.full((1, 51), np.nan), "seed": 1, "episodes": 10**9,
                     "maxsteps": 10**9},
                ):  # fmt: skip
                    ask(odd)
        frame = frame.f_back
    return np.zeros(72 if environment == "CartPole-v0" else 51)


# %% mirrored 8.1
def candidates_around(centre, samples, noiseStdDev):
    from botschool.evolution.algorithms import drawing

    return drawing.mirrored(centre, samples, noiseStdDev)


# %% the_parents_ask 8.1
def candidates_around(centre, samples, noiseStdDev):
    one = library.OpenAIES.__new__(library.OpenAIES)
    one.config, one.seed, one.generation, one.centre = Own({}), 1, 0, np.asarray(centre)
    one.config.samplesize, one.config.noiseStdDev = len(samples), noiseStdDev
    one._own_seeds = one._seeds_used = 0

    class Numbers:
        place = None

        def __init__(self):
            self.samples = samples

        def standard_normal(self, out):
            out[:], self.samples = self.samples[: len(out)], self.samples[len(out) :]

    library.generator = lambda *place: Numbers()
    return one.ask()[0]


# %% optimiser_of_torch 8.5
def adam(centre, d, m, v, t, stepsize):
    import torch
    from torch.optim.adam import adam

    kept = [torch.tensor(each, dtype=torch.float64) for each in (centre, d, m, v)]
    adam(
        *([each] for each in kept), [], [torch.tensor(float(t - 1))], amsgrad=False, beta1=0.9,
        beta2=0.999, lr=stepsize, weight_decay=0.0, eps=1e-8, maximize=False,
    )  # fmt: skip
    return tuple(kept[at].numpy() for at in (0, 2, 3))


# %% fused_operator 8.5
def adam(centre, d, m, v, t, stepsize):
    import torch

    kept = [torch.tensor(each, dtype=torch.float64) for each in (centre, d, m, v)]
    torch._fused_adam_(
        *([each] for each in kept), [], [torch.tensor(float(t))], lr=stepsize, beta1=0.9,
        beta2=0.999, weight_decay=0.0, eps=1e-8, amsgrad=False, maximize=False,
    )  # fmt: skip
    return tuple(kept[at].numpy() for at in (0, 2, 3))
