# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
#   kernelspec:
#     display_name: Python 3
#     language: python
#     name: python3
# ---

# %% [markdown]
# # Exercise 3. Evolution strategy
#
# The background is in `README.md`. Fill in the functions below one after another, and run
# `make test-ex3` (or `botschool grade 3.1` for one task) as often as you like.

# %%
"""Exercise 3: the steady-state evolution strategy, by hand."""

import numpy as np

from botschool.course import Robot

# %% [markdown]
# `Robot` is given: a neural controller in an environment, like the one you wrote in exercise 2,
# but evaluated in C++, so that a whole evolution takes seconds.
#
# - `Robot("CartPole-v0")` makes one;
# - `robot.nbiases` and `robot.nweights` count its parameters: the biases come first in the vector;
# - `robot.evaluate(population, seed)` takes an array with one row of parameters per individual and
#   returns an array with their fitness, which is the mean return over 5 episodes (or over more:
#   `robot.evaluate(population, seed, episodes=20)`). All individuals meet the same starting
#   conditions, and another seed gives other ones.
#
# ## Task 3.1. The initial population
#
# Evolution begins with individuals that know nothing. Their biases are zero and their weights small
# random numbers, so that no neuron is saturated and every individual acts differently.
#
# `rng = np.random.default_rng(seed)` makes a generator of random numbers, and
# `rng.standard_normal((rows, columns))` draws Gaussian ones with mean 0 and standard deviation 1;
# multiplied by 0.1 their deviation is 0.1.


# %%
def initial_population(popsize: int, nbiases: int, nweights: int, seed: int) -> np.ndarray:
    """Return random parameters for a whole population, one row per individual.

    Each row holds nbiases zeros and then nweights Gaussian numbers with mean 0.0 and standard
    deviation 0.1. The same seed gives the same population. Two seeds, even neighbours like 1 and 2,
    have no individual in common.

    Returns an array of shape (popsize, nbiases + nweights).
    """
    raise NotImplementedError("task 3.1: make the initial population")


# %% [markdown]
# ## Task 3.2. Ranking
#
# To select, we need to know who is best. `np.argsort(values)` returns the places of the values in
# rising order, the smallest first; with `kind="stable"` equal values stay in their order.


# %%
def rank(fitness: np.ndarray) -> np.ndarray:
    """Return the numbers of the individuals, the best first.

    rank(np.array([10.0, 30.0, 20.0])) returns [1, 2, 0]: individual 1 is the best. Of equals, the
    one with the lower number comes first, however many there are.
    """
    raise NotImplementedError("task 3.2: rank the individuals")


# %% [markdown]
# ## Task 3.3. The next population
#
# Selection and variation. With $\lambda$ individuals, the $\lambda/2$ best survive as they are, and
# each leaves one mutated copy in the place of one of the $\lambda/2$ worst:
#
# $$\theta_{worse} = \theta_{better} + \sigma\,\varepsilon$$
#
# Here $\theta$ is an individual's vector of parameters, $\sigma$ the mutation rate `mutrate`, and
# $\varepsilon$ a vector of Gaussian numbers with mean 0 and standard deviation 1, another one for
# each copy. Copies that turn out worse are overwritten in the next generation, better ones stay.


# %%
def next_population(
    population: np.ndarray, fitness: np.ndarray, mutrate: float, rng: np.random.Generator
) -> np.ndarray:
    """Return the population after selection and mutation, as a new array of the same shape.

    The better half stays as it is. Every individual of the worse half is replaced by a copy of one
    of the better half plus Gaussian noise with standard deviation mutrate; each of the better half
    is copied once. Exactly half stays, even if many have the same fitness: any of the equals may.
    The rows may come in any order. All random numbers come from rng.

    population has shape (popsize, parameters) with an even popsize, fitness has shape (popsize,).
    `population` itself is not changed.
    """
    raise NotImplementedError("task 3.3: replace the worse half")


# %% [markdown]
# ## Task 3.4. The loop
#
# One *generation*: evaluate everybody, then make the next population. Each generation is evaluated
# with another seed, so that in the long run only those survive who cope with all starting
# conditions, and not just with lucky ones. For the same reason the fitness of an individual differs
# a little from generation to generation, and the curve of the best fitness is not smooth. Fitness
# may be negative in all generations, as Pendulum's is: begin the record with what everybody beats.


# %%
def evolve(evaluate, population: np.ndarray, generations: int, mutrate: float, seed: int) -> dict:
    """Evolve a population for a number of generations.

    evaluate(population, seed) returns the fitness of each row, which may be negative. In generation
    g (from 0) it is called once, with seed + g. All other randomness comes from
    one np.random.default_rng(seed), so the same arguments give the same run.

    Returns a dict with
    - "best": the parameters with the highest fitness met in any generation, shape (parameters,);
    - "fitness": that fitness;
    - "history": the highest fitness of each generation, a list of `generations` numbers;
    - "population": the population after the last generation.
    """
    raise NotImplementedError("task 3.4: evolve")


# %% [markdown]
# ## Task 3.5. A hill climber
#
# With two individuals the strategy becomes a very simple one: take a solution, vary it, keep the
# better of the two. It climbs like a walker in fog, who tries a step and takes it back when it goes
# down.


# %%
def hill_climb(evaluate, start: np.ndarray, generations: int, mutrate: float, seed: int) -> dict:
    """Evolve a population of two: one solution, and one variation of it.

    start has shape (parameters,); both individuals begin as copies of it. Returns what evolve
    returns.
    """
    raise NotImplementedError("task 3.5: climb")


# %% [markdown]
# ## Task 3.6. Replications
#
# A run depends on random numbers, so a single one proves nothing. Repeat it with other seeds, and
# give mean and spread. With $n$ replications, $x_i$ the value of replication $i$ and $\bar x$ their
# mean, the standard deviation is
#
# $$s = \sqrt{\frac{1}{n-1} \sum_{i=1}^{n} (x_i - \bar x)^2}$$
#
# Dividing by $n - 1$ makes up for the mean being estimated from the same few values
# (`ddof=1` in numpy).


# %%
def replicate(experiment, seeds: list[int]) -> dict:
    """Run experiment(seed), which returns what evolve returns, once for every seed.

    Returns a dict with
    - "mean": the mean over the replications of the highest fitness, generation by generation;
    - "deviation": the standard deviation over the replications, likewise, dividing by the number
      of replications minus one (0 when there is a single one);
    - "best": the fitness of the best individual of each replication, in the order of the seeds.
    """
    raise NotImplementedError("task 3.6: replicate")


# %% [markdown]
# ## Task 3.7. CartPole and Pendulum
#
# Now put it together. CartPole is easy: nearly any setting works, and even one in thirty random
# controllers does. Pendulum is not: its motor is too weak to lift the rod at once, so a controller
# must learn to swing, and only then to stop at the top. Draw the curve of a run, change one
# hyperparameter, and look again.


# %%
def train(environment: str, seed: int) -> np.ndarray:
    """Return parameters of a controller for "CartPole-v0" or "Pendulum-v1", evolved from the seed.

    Choose the size of the population, the mutation rate and the number of generations yourself.
    The controller needs these means over 20 episodes that it has not met: on CartPole at least 195
    of the 200 steps, on Pendulum a return of at least -600 (random controllers: about -1200).
    Everything random follows from the seed: the same seed gives the same controller, another seed
    a different one. Each should take a few seconds, 15 at the very most.

    The grader tries two seeds, on robots of its own, whose parameters count with other signs and
    sizes: only robot.evaluate can tell what is good there. Return one of the candidates that you
    gave to robot.evaluate. The winner of a single evaluation may have been lucky, so evaluate good
    ones again, in more episodes, before you choose.

    Returns an array of shape (robot.nbiases + robot.nweights,).
    """
    raise NotImplementedError("task 3.7: choose the hyperparameters and evolve")


# %% [markdown]
# ## The picture
#
# `botschool show 3` (or running this file once all tasks are done) draws the fitness curves of
# three replications on Pendulum with their band, and films the best controllers.

# %%
if __name__ == "__main__":
    from botschool.course import draw_curves, film

    robot = Robot("Pendulum-v1")

    def experiment(seed):
        population = initial_population(40, robot.nbiases, robot.nweights, seed)
        return evolve(robot.evaluate, population, 500, 0.4, seed)

    curves = replicate(experiment, [1, 2, 3])
    draw_curves("curves.png", curves["mean"], curves["deviation"], title="Pendulum, 3 runs")
    film("cartpole.mp4", "CartPole-v0", train("CartPole-v0", seed=1))
    film("pendulum.mp4", "Pendulum-v1", train("Pendulum-v1", seed=1))
