"""Grader of exercise 13; run it with `botschool grade 13`.

All tasks compare with our solution; tests/exercises/test_inside_ppo.py proves that it computes what
Stable-Baselines3's own code computes.

Stochastic check (13.8): with five seeds, the loop must reach 0.3 of the engine's mean return after
6,144 steps, and 0.5 after 24,576. The margin: of 100,000 draws of five from 60 seeds, the solution
reached less than 0.41 and 0.55 once. A loop that goes against the gradient reaches 0.03.
"""

from functools import partial
from itertools import pairwise

import numpy as np

from botschool.grading import Exercise, expect, same
from botschool.grading.declare.libraries import (
    ADVANTAGES,
    ENTROPY,
    EXPLAINED_VARIANCE,
    PPO_LOOP,
    UPDATES_MADE,
)

exercise = Exercise(13, "Inside PPO", file="inside_ppo.py", extras=("rl",), packages=())
close = partial(same, tolerance=1e-6)

estimating = exercise.task("13.1", "Advantages", refused=ADVANTAGES)


def rollout(rng, steps, envs, ends=0.0, done=0.0, gamma=None, gae_lambda=None):
    """Arguments of advantages; ends: share of steps that begin an episode."""
    rewards, values = rng.normal(size=(2, steps, envs)).round(3)
    starts, dones = (rng.random((steps, envs)) < ends).astype(float), np.full(envs, done)
    starts[0] = 1.0
    dones[: envs // 2] = 1.0
    last_values = (3 * rng.normal(size=envs)).round(3)
    gamma = round(float(rng.uniform(0.8, 0.99)), 3) if gamma is None else gamma
    gae_lambda = round(float(rng.uniform(0.5, 0.95)), 3) if gae_lambda is None else gae_lambda
    return rewards, 3 * values, starts, last_values, dones, gamma, gae_lambda


@close(estimating, 4, "advantages")
def one_episode_that_goes_on(rng):
    for steps in (1, 3, 40):
        yield rollout(rng, steps, 1)


@close(estimating, 4, "advantages")
def episodes_that_end_on_the_way(rng):
    for steps in (4, 60):
        yield rollout(rng, steps, 1, ends=0.3)


@close(estimating, 2, "advantages")
def an_episode_that_ends_with_the_rollout(rng):
    for steps in (1, 5):
        yield rollout(rng, steps, 1, done=1.0)


@close(estimating, 4, "advantages")
def several_environments(rng):
    yield rollout(rng, 50, 4, ends=0.2)
    yield rollout(rng, 6, 2, ends=0.4)
    yield rollout(rng, 20, 3, ends=0.2, gae_lambda=0.0)
    yield rollout(rng, 20, 3, ends=0.2, gae_lambda=1.0, gamma=1.0)


@close(estimating, 4, "bootstrapped")
def episodes_that_were_cut(rng):
    for steps, envs in ((4, 1), (2, 2), (30, 3)):
        rewards, values = rng.normal(size=(2, steps, envs)).round(2)
        terminated, truncated = (rng.random((2, steps, envs)) < 0.4).astype(float)
        terminated.flat[:4], truncated.flat[:4] = [1, 0, 1, 0], [1, 1, 0, 0]
        yield rewards, terminated, truncated, values, round(float(rng.uniform(0.8, 0.98)), 2)


surrogate = exercise.task("13.2", "The clipped surrogate")


def batch(rng, n, spread, clip_range, unchanged=0):
    """Arguments of policy_loss; unchanged: steps whose probability has stayed the same."""
    old, change = rng.normal(-1, 0.5, n).round(3), (spread * rng.normal(size=n)).round(3)
    change[:unchanged] = 0.0
    return old + change, old, (5 + 20 * rng.normal(size=n)).round(2), clip_range


@close(surrogate, 6, "policy_loss", parts=("loss",))
def nothing_to_clip(rng):
    for n in (2, 50):
        yield batch(rng, n, 0.01, 0.5)
    for alike in (np.full(4, 0.5), 1e-7 * np.arange(4.0)):  # there, the 1e-8 counts
        new, old, _, clip_range = batch(rng, 4, 0.01, 0.5)
        yield new, old, rng.permutation(alike), clip_range


@close(surrogate, 5, "policy_loss", parts=("loss",))
def clipped(rng):
    for n, spread, clip_range in ((5, 0.6, 0.2), (4, 1.0, 0.1), (128, 0.1, 0.05), (300, 0.6, 0.2)):
        yield batch(rng, n, spread, clip_range)


@close(surrogate, 3, "policy_loss", parts=("clip_fraction",))
def clip_fraction(rng):
    for n, spread, clip_range in ((128, 0.1, 0.05), (80, 0.6, 0.3), (40, 0.4, 0.2)):
        yield batch(rng, n, spread, clip_range)
    for n, unchanged in ((8, 5), (5, 1)):  # a distance that equals the limit is not farther
        yield batch(rng, n, 0.6, 0.0, unchanged)


@close(surrogate, 2, "policy_loss", parts=("loss",))
def a_batch_of_one_step(rng):
    for spread in (0.6, 0.6, 2.0, 2.0, 2.0):
        yield batch(rng, 1, spread, 0.2)


critic = exercise.task("13.3", "The loss of the critic")


@close(critic, 4, "value_loss")
def without_clipping(rng):
    for n in (4, 128):
        yield tuple(rng.normal(size=(3, n)).round(2))


@close(critic, 6, "value_loss")
def with_clipping(rng):
    for n, limit in ((5, 0.5), (3, 0.0), (12, 0.0), (64, 0.3), (128, 2.0)):
        yield *rng.normal(size=(3, n)).round(2), limit


undecided = exercise.task("13.4", "Entropy", refused=ENTROPY)


@close(undecided, 3, "entropy_of_choices")
def of_choices(rng):
    for shape in ((1, 2), (30, 2), (25, 6)):
        yield rng.normal(size=shape).round(2)


@close(undecided, 3, "entropy_of_choices", off={"single": "of 1000, it has four decimals"})
def of_choices_with_large_scores(rng):
    yield np.array([[1000.0, 0.0], [1000.0, 1000.0], [-900.0, -901.0]])
    yield 600 * rng.normal(size=(20, 4))


@close(undecided, 4, "entropy_of_gaussians")
def of_gaussians(rng):
    for actuators in (1, 2, 17):
        yield rng.normal(size=actuators).round(2)


moving = exercise.task("13.5", "How far has the policy moved?", refused=UPDATES_MADE)


@close(moving, 7, "approx_kl")
def estimates_the_divergence(rng):
    for n, spread in ((6, 0.8), (30, 0.8), (128, 0.1)):
        yield batch(rng, n, spread, 0.0)[:2]


def divergences(rng, epochs, batches, low=0.0001, high=0.005):
    return rng.uniform(low, high, (epochs, batches)).round(5).tolist()


@same(moving, 4, "updates_made")
def stops_early(rng):
    for epochs, batches in ((1, 3), (3, 2), (4, 8)):
        found = divergences(rng, epochs, batches)
        found[int(rng.integers(epochs))][int(rng.integers(batches))] = 0.09
        yield found, 0.02
    yield [[0.09, 0.0001, 0.0001]], 0.02
    yield [[0.0002, 0.0001, 0.0001, 0.037], [0.0001] * 4], 0.02
    yield [[0.0001] * 5, [0.0001, 0.0002, 0.0002, 0.0001, 0.05]], 0.02
    yield [[0.01, 0.015, 0.012], [0.02, 0.04, 0.01]], 0.02


@same(moving, 3, "updates_made")
def goes_on_when_near(rng):
    yield divergences(rng, 3, 4), 0.02
    yield divergences(rng, 2, 3, 0.024, 0.028), 0.02
    yield divergences(rng, 2, 4, 0.1, 0.6), None
    yield [[0.25, 0.375], [0.125, 0.5]], 0.25  # 0.375 is 1.5 times 0.25
    yield [[0.75, 0.75], [0.75, 0.8]], 0.5
    yield [[0.0, 0.0, 0.125], [0.125, 0.125, 0.125]], 0.0
    yield [[0.0, 0.25]], 0.0


together = exercise.task("13.6", "All together", refused=EXPLAINED_VARIANCE)


@close(together, 5, "total_loss")
def adds_up_the_losses(rng):
    for n in (3, 8, 128):
        policy, value, ent_coef, vf_coef = rng.uniform(0.1, 2, 4).round(3).tolist()
        yield policy, value, rng.uniform(0.1, 2, n).round(3), ent_coef, vf_coef
    yield -0.02, 3.5, rng.uniform(0.1, 2, 5).round(3), 0.0, 0.5


@close(together, 3, "explained_variance")
def explains_the_variance(rng):
    for shape in (5, 40, (16, 2), (64, 4)):
        returns = 4 + rng.normal(size=shape).round(2)
        for values in (1 + returns + 0.3 * rng.normal(size=shape).round(2), -returns):
            yield values, returns


seeing = exercise.task("13.7", "What the hidden neurons respond to")


@close(seeing, 5, "hidden_activations")
def activates_layer_after_layer(rng):
    for steps, sizes, factor in (
        (5, (3, 4, 2), 1),
        (1, (3, 2), 1),
        (4, (3, 3, 3, 3, 2), 1),
        (5, (3, 4, 2), 5000),  # e to the power of such sums is infinite
        (40, (4, 16, 16, 16), 0.5),
    ):
        layers = [
            (factor * rng.normal(size=(n, before)), factor * rng.normal(size=n))
            for before, n in pairwise(sizes)
        ]
        yield layers, rng.normal(size=(steps, sizes[0]))


@close(seeing, 3, "responses")
def follows_the_observed(rng):
    for steps, neurons, numbers in ((6, 2, 1), (40, 3, 5), (100, 64, 4)):
        observations = 2 * rng.normal(size=(steps, numbers)) - 1
        yield np.tanh(observations @ rng.normal(size=(numbers, neurons))), observations


@close(seeing, 1, "responses")
def what_never_changes(rng):
    # the mean of 0.7 and that of 0.1 are rounded, those of 0.5 and 0.25 are exact
    for steps, constant, values in (
        (16, 1, (0.5, 0.25)), (30, 2, (0.7, 0.1)), (12, 0, (0.7, 0.1)), (20, 0, (0.7, 0.1))
    ):  # fmt: skip
        activations, observations = rng.normal(size=(steps, 4)), rng.normal(size=(steps, 3))
        activations[:, 1], observations[:, constant] = values
        activations[4], observations[5] = activations[3], observations[4]  # now and then it stays
        yield activations, observations


@same(seeing, 1, "responses", 0.05, off={"single": "there, so small a change is rounding"})
def what_hardly_changes(rng):
    """A neuron that has nearly reached 1, and is a straight line of the observed number."""
    for steps, change in ((30, 3e-7), (25, -3e-7)):
        line = rng.permutation(np.arange(float(steps)))[:, None]
        yield 0.99999 + change * line, line


looping = exercise.task(
    "13.8", "Your own loop", seconds=30, needs=("13.1", "13.5"), refused=PPO_LOOP
)
OUT_OF_TIME = {"environment": "Pendulum-v1", "n_envs": 1, "n_steps": 400}
"""A rollout in which time runs out after 200 steps and with the last one."""


def looped(module, seeds, steps, n_epochs, batch_size, target_kl, settings):
    """learn(ppo, {1}, seed), where ppo has n_epochs={2}, batch_size={3} and target_kl={4}"""
    from itertools import count

    import numpy as np

    from botschool.course.ppo import ENVIRONMENT, SETTINGS, Pieces

    def result(ppo_seed, seed):
        options = {"n_epochs": n_epochs, "batch_size": batch_size, "target_kl": target_kl}
        options = SETTINGS | options | settings
        ppo = Pieces(options.pop("environment", ENVIRONMENT), ppo_seed, **options)
        rollouts, taken, updates, first = [], [], count(), {}

        def collect():
            rollouts.append(Pieces.collect(ppo))
            return rollouts[-1]

        def minibatch(rows=None):
            if not taken:  # later rollouts overwrite these arrays
                for name in ("advantages", "returns"):
                    first[f"rollout.{name}"] = np.array(getattr(rollouts[0], name), dtype=float)
            if len(taken) < 100:
                every = np.arange(rollouts[0].rewards.size)
                taken.append(every[slice(None) if rows is None else rows])
            return Pieces.minibatch(ppo, rows)

        def step(gradient):
            next(updates)
            return Pieces.step(ppo, gradient)

        ppo.collect, ppo.minibatch, ppo.step = collect, minibatch, step
        module.learn(ppo, steps, seed)
        return first | {
            "ppo.steps": ppo.steps,
            "the number of updates": next(updates),
            "ppo.parameters": ppo.parameters.copy(),
            "the batches": taken,
        }

    return [result(*each) for each in seeds]


def first_result(found, *_):
    names = ("rollout.advantages", "rollout.returns", "ppo.steps", "the number of updates")
    return {name: found[0][name] for name in (*names, "ppo.parameters")}


def numbers_of_batches(found, *_):
    sizes = [len(rows) for rows in found[0]["the batches"]]
    return {"ppo.steps": found[0]["ppo.steps"], "the sizes of the batches": sizes}


def orders(found, seeds, steps, n_epochs, *_):
    epochs = np.array_split(np.concatenate([*found[0]["the batches"], []]), n_epochs)
    parameters = [np.asarray(each["ppo.parameters"]) for each in found]
    return numbers_of_batches(found) | {
        "the steps of an epoch, sorted,": [np.sort(epoch) for epoch in epochs],
        "that epochs have the same order": all(np.array_equal(epochs[0], e) for e in epochs[1:]),
        "that the same seed gives the same parameters": np.array_equal(*parameters[:2]),
        "that another seed gives the same parameters": np.array_equal(*parameters[1:]),
    }


def a_seed(rng):
    return int(rng.integers(100_000))


@same(looping, 4, looped, 1e-4, view=first_result)
def one_batch_an_epoch(rng):
    """A batch of all steps has no order, so the parameters are known."""
    for steps, n_epochs in ((512, 1), (512, 3), (1024, 2)):
        yield [(a_seed(rng), 700)], steps, n_epochs, 512, None, {}
    for steps in (512, 1024):  # slowly, so that some divergence lies between 1 and 1.5 times it
        yield [(a_seed(rng), 700)], steps, 14, 512, 1.5e-4, {"learning_rate": 5e-4}
    for n_epochs in (1, 2):
        yield [(a_seed(rng), 700)], 400, n_epochs, 400, None, OUT_OF_TIME


@same(looping, 1, looped, view=numbers_of_batches)
def the_stop_ends_the_rollout(rng):
    """The first batch has no divergence; each one after an update has more than 1.5e-8."""
    for steps, n_epochs in ((512, 2), (1024, 3)):
        yield [(a_seed(rng), 700)], steps, n_epochs, 128, 1e-8, {}


@same(looping, 4, looped, view=orders)
def the_order_is_new(rng):
    for n_epochs in (2, 3):
        seed = a_seed(rng)
        yield [(seed, 700), (seed, 700), (seed, 701)], 512, n_epochs, 128, None, {}


def mean_return(ppo, parameters):
    """The mean return of an agent in 20 new episodes."""
    ppo.parameters[:] = np.asarray(parameters, dtype=np.float32)
    return ppo.play(range(1_000_000, 1_000_020))[0].mean()


@exercise.cached
def engine(seed, steps):
    """A training by the engine's own loop, and its mean return."""
    from botschool.course.ppo import ENVIRONMENT, SETTINGS
    from botschool.rl.native import PPO

    ppo = PPO(ENVIRONMENT, seed, **SETTINGS)
    while ppo.steps < steps:
        ppo.collect()
        ppo.update()
    return ppo, mean_return(ppo, ppo.parameters.copy())


def learnt(found, seeds, steps, *_):
    """How much of the engine's mean return the loop must reach follows from the steps."""
    share = 0.3 if steps < 10_000 else 0.5
    engines = [engine(seed, steps) for seed, _ in seeds]
    theirs = np.mean([reached for _, reached in engines])
    pairs = zip(engines, found, strict=True)
    yours = np.mean([mean_return(ppo, each["ppo.parameters"]) for (ppo, _), each in pairs])
    expect(
        yours >= share * theirs,
        f"with {len(seeds)} agents, the mean return in new episodes is {yours:.0f}, but should be "
        f"at least {share:.0%} of {theirs:.0f}, which the engine's loop reaches.",
    )
    return True


@same(looping, 5, looped, view=learnt)
def learns_as_the_engine_does(rng):
    for steps in (6_144, 24_576):
        yield [(a_seed(rng), 700) for _ in range(5)], steps, 8, 128, 0.02, {}
