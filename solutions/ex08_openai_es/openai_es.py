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
# # Exercise 8. OpenAI-ES
#
# The text is `README.md`. Fill in the functions one after another. `botschool grade 8` grades
# them, `botschool grade 8.1` one task.

# %%
"""Exercise 8: the OpenAI evolution strategy, piece by piece, and the stability of its curves."""

import numpy as np

from botschool.course import Robot

# %% [markdown]
# In the formulas below, the *centre* c holds the n parameters of the solution that is being
# improved, and s is `noiseStdDev`, how far the candidates lie from it. No function changes the
# arrays that it is given.
#
# ## Task 8.1. Symmetric sampling
#
# For each of the random vectors e, c + s e and c - s e are two candidates on opposite sides of the
# centre.


# %%
def candidates_around(centre: np.ndarray, samples: np.ndarray, noiseStdDev: float) -> np.ndarray:
    """Two candidates for each sample, on both sides of the centre.

    centre has the shape (n,) and samples (samplesize, n). In the result, shape (2 * samplesize,
    n), row 2 b is centre + noiseStdDev * samples[b], and row 2 b + 1 is centre - noiseStdDev *
    samples[b]. The arguments are not changed.
    """
    ### BEGIN SOLUTION task 8.1: sample symmetrically
    candidates = np.empty((2 * len(samples), len(centre)))
    candidates[0::2] = centre + noiseStdDev * samples
    candidates[1::2] = centre - noiseStdDev * samples
    return candidates
    ### END SOLUTION


# %% [markdown]
# ## Task 8.2. Utilities
#
# The worst candidate gets the utility -0.5, the best 0.5, and the others lie evenly between them
# (*centred ranks*).


# %%
def utilities(fitness: np.ndarray) -> np.ndarray:
    """Centred ranks of the candidates, in the order of the candidates.

    utilities([10, 90, 12, 30, 0]) returns [-0.25, 0.5, 0.0, 0.25, -0.5]. Of equals, the one that
    comes first gets the lower rank. There are at least two candidates.
    """
    ### BEGIN SOLUTION task 8.2: turn fitness into utilities
    utilities = np.empty(len(fitness))
    utilities[np.argsort(fitness, kind="stable")] = np.linspace(-0.5, 0.5, len(fitness))
    return utilities
    ### END SOLUTION


# %% [markdown]
# ## Task 8.3. The gradient
#
# $$g = \frac{1}{2 \cdot \mathrm{samplesize}} \sum_b (u_{2b} - u_{2b+1}) \, e_b$$
#
# This estimates the gradient, the direction in which fitness (in ranks) rises most steeply.


# %%
def gradient(samples: np.ndarray, utilities: np.ndarray) -> np.ndarray:
    """The estimated gradient, shape (n,), by the formula above.

    samples has the shape (samplesize, n); utilities has the shape (2 * samplesize,) and the order
    of the rows of `candidates_around`.
    """
    ### BEGIN SOLUTION task 8.3: estimate the gradient
    weights = utilities[0::2] - utilities[1::2]
    return weights @ samples / len(utilities)
    ### END SOLUTION


# %% [markdown]
# ## Task 8.4. Weight decay
#
# - `wdecay` 0: d = -g, no decay;
# - `wdecay` 1: d = -g + 0.005 c, a pull in proportion to each parameter;
# - `wdecay` 2: d = -g + 0.005 sign(c), the same pull on each parameter that is not 0.


# %%
def descent(gradient: np.ndarray, centre: np.ndarray, wdecay: int) -> np.ndarray:
    """The direction d that the optimiser descends on, shape (n,): minus the gradient, and decay."""
    ### BEGIN SOLUTION task 8.4: add weight decay
    pull = {0: np.zeros(len(centre)), 1: centre, 2: np.sign(centre)}[wdecay]
    return -gradient + 0.005 * pull
    ### END SOLUTION


# %% [markdown]
# ## Task 8.5. Adam
#
# m is a running mean of d, and v one of its square (element by element). In generation t, counted
# from 1:
#
# $$m \leftarrow 0.9\, m + 0.1\, d \qquad v \leftarrow 0.999\, v + 0.001\, d^2$$
#
# $$\hat m = \frac{m}{1 - 0.9^t} \qquad \hat v = \frac{v}{1 - 0.999^t} \qquad
# c \leftarrow c - \mathrm{stepsize} \cdot \frac{\hat m}{\sqrt{\hat v} + 10^{-8}}$$


# %%
def adam(
    centre: np.ndarray, d: np.ndarray, m: np.ndarray, v: np.ndarray, t: int, stepsize: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """One step of Adam: the new centre, the new m and the new v, all of shape (n,).

    d is the direction of this generation, m and v are those of the generation before (zeros for
    the first), t is the number of this generation, from 1. The arguments are not changed.
    """
    ### BEGIN SOLUTION task 8.5: make a step of Adam
    m = 0.9 * m + 0.1 * d
    v = 0.999 * v + 0.001 * d**2
    step = (m / (1 - 0.9**t)) / (np.sqrt(v / (1 - 0.999**t)) + 1e-8)
    return centre - stepsize * step, m, v
    ### END SOLUTION


# %% [markdown]
# ## Task 8.6. The whole algorithm


# %%
def evolve(
    evaluate,
    centre: np.ndarray,
    generations: int,
    seed: int,
    samplesize: int = 20,
    noiseStdDev: float = 0.02,
    stepsize: float = 0.01,
    wdecay: int = 0,
) -> dict:
    """OpenAI-ES from a first centre, which stays as it is.

    rng = np.random.default_rng(seed) makes the samples of a generation by one call of
    rng.standard_normal((samplesize, n)). All candidates of generation g (from 0) are evaluated by
    one evaluate(candidates, seed + g), which returns their fitness. Each call of evolve begins with
    m and v of zeros. `adam` counts generations from 1: t = g + 1.

    Returns a dict with
    - "centre": the centre after the last generation, shape (n,);
    - "history": the mean fitness of the candidates of each generation, a list of `generations`
      numbers.
    """
    ### BEGIN SOLUTION task 8.6: put the pieces together
    rng = np.random.default_rng(seed)
    m, v, history = np.zeros(len(centre)), np.zeros(len(centre)), []
    for generation in range(generations):
        samples = rng.standard_normal((samplesize, len(centre)))
        fitness = evaluate(candidates_around(centre, samples, noiseStdDev), seed + generation)
        history.append(float(np.mean(fitness)))
        d = descent(gradient(samples, utilities(fitness)), centre, wdecay)
        centre, m, v = adam(centre, d, m, v, generation + 1, stepsize)
    return {"centre": centre, "history": history}
    ### END SOLUTION


# %% [markdown]
# ## Task 8.7. How stable is it?
#
# $$\mathrm{drop} = \frac{\max_t \left( \max_{i \le t} x_i - x_t \right)}{\max x - \min x}$$
#
# - drop at most 0.1: `"monotonic"`, but for small ripples;
# - more than 0.1, at most 0.3: `"mild regressions"`;
# - more than 0.3: `"severe regressions"`.


# %%
def smooth(curve: np.ndarray, width: int) -> np.ndarray:
    """The mean of each `width` neighbours: a curve of len(curve) - width + 1 numbers.

    smooth([1, 2, 6, 1], 2) returns [1.5, 4.0, 3.5].
    """
    ### BEGIN SOLUTION task 8.7: smooth a curve
    return np.convolve(curve, np.full(width, 1 / width), mode="valid")
    ### END SOLUTION


def stability(curve: np.ndarray) -> dict:
    """The largest fall of a curve (smoothed or not), and the verdict on it.

    Returns a dict with
    - "drop": by the formula above, 0.0 for a curve that is flat;
    - "bottom": the index where the fall is largest, the first one of equals;
    - "peak": the index of the height that it fell from, the highest value up to the bottom, the
      first one of equals (a curve that never falls has the bottom 0 and the peak 0);
    - "verdict": "monotonic", "mild regressions" or "severe regressions".

    stability([0, 8, 6, 10]) has drop 0.2, peak 1, bottom 2 and the verdict "mild regressions".
    """
    ### BEGIN SOLUTION task 8.7: judge the stability of a curve
    curve = np.asarray(curve, dtype=float)
    falls = np.maximum.accumulate(curve) - curve
    bottom = int(np.argmax(falls))
    peak = int(np.argmax(curve[: bottom + 1]))
    height = curve.max() - curve.min()
    drop = float(falls[bottom] / height) if height > 0 else 0.0
    verdict = "severe regressions"
    if drop <= 0.1:
        verdict = "monotonic"
    elif drop <= 0.3:
        verdict = "mild regressions"
    return {"drop": drop, "bottom": bottom, "peak": peak, "verdict": verdict}
    ### END SOLUTION


# %% [markdown]
# ## Task 8.8. CartPole and Pendulum
#
# `Robot(environment)` is the same as in exercise 3. Start, as there, from biases 0 and Gaussian
# weights with standard deviation 0.1; how many of each there are, `robot.nbiases` and
# `robot.nweights` say. `robot.evaluate(candidates, seed, episodes=10)` measures fitness.
#
# An episode of CartPole-v0 ends after 200 steps, one of CartPole-v1, which the last part of this
# file draws, after 500. Otherwise they are the same.


# %%
def train(environment: str, seed: int) -> np.ndarray:
    """A centre for Robot(environment), "CartPole-v0" or "Pendulum-v1", evolved from the seed.

    Return the centre to which your OpenAI-ES has led. The seed decides about the start and all
    samples: another seed gives another evolution.

    Choose the hyperparameters yourself. On average over 100 new episodes, the pole of CartPole
    must stay up for 195 of 200 steps, and Pendulum must reach a return of -400. Seconds are enough.
    """
    ### BEGIN SOLUTION task 8.8: choose the hyperparameters and evolve
    robot = Robot(environment)
    weights = 0.1 * np.random.default_rng(seed).standard_normal(robot.nweights)
    centre = np.concatenate([np.zeros(robot.nbiases), weights])
    generations = 80 if "CartPole" in environment else 600

    def evaluate(candidates, seed):
        return robot.evaluate(candidates, seed, episodes=10)

    run = evolve(evaluate, centre, generations, seed, noiseStdDev=0.2, stepsize=0.05)
    return run["centre"]
    ### END SOLUTION


# %% [markdown]
# ## Curves with their verdicts
#
# `botschool show 8` runs this part.

# %%
if __name__ == "__main__":
    from botschool.course import draw_verdicts, film

    rash = {"stepsize": 0.3, "noiseStdDev": 0.02}
    lengths = {"CartPole-v1": 150, "Acrobot-v1": 150, "Pendulum-v1": 600}
    panels = {}
    for environment, generations in lengths.items():
        robot, curves = Robot(environment), []
        for seed in (1, 2, 3):
            weights = 0.1 * np.random.default_rng(seed).standard_normal(robot.nweights)
            centre = np.concatenate([np.zeros(robot.nbiases), weights])
            run = evolve(robot.evaluate, centre, generations, seed, **rash)
            curve = smooth(np.array(run["history"]), 20)
            curves.append((curve, stability(curve)))
        panels[environment] = curves
    draw_verdicts("stability.png", panels, columns=len(panels))
    film("pendulum.mp4", "Pendulum-v1", train("Pendulum-v1", seed=1))
