"""Grader of exercise 5; run it with `botschool grade 5`.

All tasks compare with our solution, and nothing is left to chance: runs and episodes are the same
to the last bit whenever experiment, genotype and seed are. Experiments are short, in the course's
own simulator: Box2D takes a hundred times as long.
"""

from functools import partial

import numpy as np

from botschool.course import genotype_file
from botschool.grading import Exercise, same, seed_of

exercise = Exercise(
    5,
    "Body and brain",
    file="body_and_brain.py",
    imports=("botschool.course", "botschool.evolution.run"),
    extras=("box2d",),
    packages=(),
)
BODY, OBSERVATIONS = 64, 35
TOOL = ("botschool.envs.morphology:decode",)
decoded = partial(same, tolerance=1e-5)


def sparse(rng, numbers, limits):
    """Parameters of a segment, a joint and the torso's angle; all others are 0."""
    parameters = np.zeros(BODY)
    segment, joint = rng.integers(1, 10, 2)
    places = [2 * segment, 2 * segment + 1, 42, 42 + segment, 53 + segment]
    parameters[places] = rng.permutation(numbers)
    parameters[[22 + 2 * joint, 23 + 2 * joint]] = rng.permutation(limits)
    return parameters


def bodies(rng, spread=0.6):
    """Parameters of bodies; the last are beyond -1 and 1, some so far that exp is infinite."""
    yield sparse(rng, [-0.7, -0.4, 0.3, 0.5, 0.6], [0.2, 0.7])
    yield sparse(rng, [-2.0, -1.2, -0.5, 1.3, 1.6], [-1.5, 0.4])
    yield from (spread * rng.normal(size=BODY), 5 * spread * rng.normal(size=BODY))
    beyond = rng.choice([-1, 1], BODY) * rng.uniform(1.1, 2.5, BODY)
    beyond[::5] *= 1000
    yield beyond


# ------------------------------------------------------------------- 5.1


size = exercise.task("5.1", "Sizes", refused=TOOL)
decoded(size, 6, "sizes", parts=("lengths",), name="length_of_each_segment")(bodies)
decoded(size, 4, "sizes", parts=("thicknesses",), name="thickness_of_each_segment")(bodies)
decoded(size, 4, "sizes", parts=("masses",), name="mass_of_each_segment")(bodies)

turning = exercise.task("5.2", "Angles", refused=TOOL)
decoded(turning, 6, "joints", parts=("angles",), name="default_angles")(bodies)
decoded(turning, 7, "joints", parts=("lower", "upper"), name="limits_of_joints")(bodies)

shape = exercise.task("5.3", "The shape at rest", needs=("5.1", "5.2"), refused=TOOL)


def with_angles(parameters, many):
    """The same body with this many default angles that are not 0."""
    parameters[42 + many : 53] = 0
    return parameters


@decoded(shape, 5, "outline")
def straight_bodies(rng):
    yield from (with_angles(each, 0) for each in bodies(rng))


@decoded(shape, 5, "outline")
def straight_bodies_that_lean(rng):
    yield from (with_angles(each, 1) for each in bodies(rng))


@decoded(shape, 9, "outline")
def bent_bodies(rng):
    yield from bodies(rng)
    yield from bodies(rng, spread=1.5)


numbers = exercise.task("5.4", "A body in five numbers", needs=("5.1", "5.2", "5.3"), refused=TOOL)
decoded(numbers, 4, "describe", parts=("length", "mass"), name="length_and_mass")(bodies)
decoded(numbers, 4, "describe", parts=("width", "height"), name="width_and_height")(bodies)
decoded(numbers, 2, "describe", parts=("freedom",), name="freedom_of_the_joints")(bodies)

# ------------------------------------------------------------------- 5.5
EXPERIMENT = """
[EXP]
environment = PlanarBodyBrain-v0
algo = OpenAI-ES

[POLICY]
episodes = 1
pepisodes = 1
maxsteps = {maxsteps}
nhiddens = {hidden}
bias = 1
out_type = 3
winit = 1
action_noise = 1
action_noise_range = {noise}
normalize = 1
clip = 1

[ALGO]
maxmsteps = 0.0004
samplesize = 2
noiseStdDev = 0.5
stepsize = 0.5
saveeach = 60
"""

running = exercise.task("5.5", "Evolve walkers")


def trial(rng, seeds, steps=None, earlier=()):
    """A run of 400 steps in which luck decides, so that the best is seldom the best post-evaluated.

    seeds: how many. earlier: seeds, by place in the list, of a call before.
    """
    text = EXPERIMENT.format(maxsteps=rng.integers(4, 8), hidden=4, noise=5)
    drawn = sorted({seed_of(rng) for _ in range(seeds)}, reverse=True)
    return text, drawn, steps, [drawn[i] for i in earlier]


def evolved(module, text, seeds, steps, earlier):
    """evolve_walkers('trial.ini', {1}, 'some/runs', {2})"""
    import pathlib
    import shutil

    import numpy

    shutil.rmtree("some", ignore_errors=True)
    pathlib.Path("trial.ini").write_text(text)
    if earlier:  # the folder holds longer runs
        module.evolve_walkers("trial.ini", earlier, "some/runs")
    given = list(seeds)
    walkers = module.evolve_walkers("trial.ini", given, "some/runs", steps)
    found = {"its answer": walkers, "the list of seeds, afterwards,": given}
    for seed in seeds:
        name = f"bestgS{seed}.npy"
        files = [*pathlib.Path("some/runs").glob(name), *sorted(pathlib.Path().rglob(name))]
        found[f"the folder of {name}"] = files[0].parent.as_posix() if files else "none"
        found[name] = numpy.load(files[0]) if files else None
    return found


ANSWER = ("its answer", "the list of seeds, afterwards,")


@same(running, 6, evolved, parts=ANSWER)
def best_walker_of_each_run(rng):
    yield trial(rng, 2)
    yield from (trial(rng, 3) for _ in range(2))
    for count in (1, 2):
        text, seeds, *more = trial(rng, count)
        yield text, [*seeds, 0], *more


@same(running, 3, evolved)
def leaves_the_files(rng):
    yield from (trial(rng, count) for count in (1, 3))


@same(running, 3, evolved, parts=ANSWER)
def stops_after_the_steps(rng):
    yield trial(rng, 3, 200)
    yield trial(rng, 3, 200, earlier=(0, 2))
    yield trial(rng, 3, 150, earlier=(1,))


surgery = exercise.task("5.6", "Give a brain another body")


def genotypes(rng, count):
    """Made-up genotypes of experiments with few or many hidden neurons."""
    for hidden in (int(rng.integers(3, 9)), 10, int(rng.integers(11, 60))):
        yield tuple(rng.normal(size=(count, 46 * hidden + 10 + BODY + 2 * OBSERVATIONS)))


same(surgery, 3, "body_of", 0, name="body_is_cut_out")(genotypes, 1)
same(surgery, 7, "transplant", 0, name="brain_in_another_body")(genotypes, 2)

crossing = exercise.task("5.7", "The co-adaptation matrix", needs=("5.6",))


def crossed(module, text, walkers, seed, episodes):
    """cross_evaluate('trial.ini', {1}, {2}, {3})"""
    import pathlib

    pathlib.Path("trial.ini").write_text(text)
    matrix = module.cross_evaluate("trial.ini", walkers, seed, episodes)
    return {"its answer": matrix, "the walkers, afterwards,": walkers}


def varied(rng):
    """The pre-evolved walkers, each with brain and body varied a little."""
    walkers = np.array([np.load(genotype_file(f"bodybrainS{seed}.npy")) for seed in (1, 2, 3)])
    walkers[:, :-70] += 0.02 * rng.normal(size=walkers[:, :-70].shape)
    return walkers


@same(crossing, 6, crossed, 1e-5)
def pre_evolved_walkers(rng):
    text, walkers = EXPERIMENT.format(maxsteps=60, hidden=50, noise=0.01), varied(rng)
    yield text, walkers[:2], seed_of(rng), 1
    yield text, walkers, seed_of(rng), 3


@same(crossing, 3, crossed, 1e-5)
def another_experiment(rng):
    text = EXPERIMENT.format(maxsteps=20, hidden=5, noise=0.01)
    walkers = rng.normal(size=(5, 46 * 5 + 10 + BODY + 2 * OBSERVATIONS))
    walkers[:, -OBSERVATIONS:] = 1
    for count, seed, episodes in ((2, seed_of(rng), 2), (2, 0, 3), (5, 0, 1), (4, seed_of(rng), 4)):
        yield text, walkers[:count], seed, episodes


losing = exercise.task("5.8", "What is lost")
lost = partial(same, tolerance=1e-5, off={"one": "there are at least two walkers"})
TIES = [[4.0, 4.0, 1.0], [2.0, -1.0, -1.0], [4.0, 0.0, 3.0]]
"""Returns that are the same as the own one in a row, or in a column."""


def matrices(rng):
    """Matrices of returns, the small ones with whole numbers."""
    made = [30 * rng.normal(size=(n, n)) + 25 * np.eye(n) * rng.random() for n in (2, 3, 5, 8)]
    yield from (matrix.round() + 0.0 for matrix in made[:2])
    yield from (*made[2:], np.array(TIES))


lost(losing, 4, "loss", parts=("own", "foreign"), name="own_and_foreign")(matrices)
lost(losing, 3, "loss", parts=("brains",), name="loss_of_brains")(matrices)
lost(losing, 3, "loss", parts=("bodies",), name="loss_of_bodies")(matrices)


@lost(losing, 2, "loss", parts=("at home",))
def at_home(rng):
    yield from list(matrices(rng))[:-1]


@lost(losing, 1, "loss", parts=("at home",))
def as_good_elsewhere_is_not_at_home(rng):
    """Equal returns, and all of them below 0."""
    yield np.array([[4.0, 4.0], [1.0, 2.0]])
    yield np.array([[-3.0, -3.0, -5.0], [-7.0, -2.0, -4.0], [-6.0, -1.0, -1.0]])
    yield np.full((4, 4), -2.0)
    yield -np.abs(rng.normal(size=(6, 6)).round(1)) - 1
