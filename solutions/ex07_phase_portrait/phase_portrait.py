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
# # Exercise 7. Phase portrait
#
# The text is `README.md`. Fill in the functions one after another. `botschool grade 7` grades
# them, `botschool grade 7.1` one task.

# %%
"""Exercise 7: what evolution does to the dynamics of a pendulum, seen in phase portraits."""

import gymnasium
import numpy as np

from botschool.config import OpenAIESConfig
from botschool.course import Robot, controller_of
from botschool.evolution.algorithms.openaies import OpenAIES

# %% [markdown]
# ## Task 7.1. From observation to state
#
# `Pendulum-v1` observes the cosine of its angle, the sine of its angle, and its velocity in radians
# per second. Angle 0 is upright, and positive angles are counter-clockwise. `np.arctan2(sine,
# cosine)` returns the angle.


# %%
def to_state(observation: np.ndarray) -> np.ndarray:
    """Return the angle in [-pi, pi] and the velocity of the pendulum.

    observation has the shape (3,), or (n, 3) for n observations; the result has the shape (2,),
    or (n, 2).
    """
    ### BEGIN SOLUTION task 7.1: compute angle and velocity from an observation
    observation = np.asarray(observation, dtype=float)
    angle = np.arctan2(observation[..., 1], observation[..., 0])
    return np.stack([angle, observation[..., 2]], axis=-1)
    ### END SOLUTION


# %% [markdown]
# ## Task 7.2. Recording an episode
#
# A controller is a function: `controller(observation)` returns the action, an array with one
# torque. It can be an evolved network, a rule of yours, or `lambda observation: np.zeros(1)`.


# %%
def record(controller, seed: int, steps: int) -> np.ndarray:
    """Record the states of one episode of Gymnasium's Pendulum-v1, reset with the seed.

    Each step asks the controller once. The recording ends after `steps` steps, or with the episode
    if that comes first. Returns an array of shape (steps done + 1, 2): the states
    (angle in [-pi, pi], velocity) from the start to the one after the last step.
    """
    ### BEGIN SOLUTION task 7.2: record the states of an episode
    env = gymnasium.make("Pendulum-v1")
    observation, _ = env.reset(seed=seed)
    observations = [observation]
    for _ in range(steps):
        observation, _, terminated, truncated, _ = env.step(controller(observation))
        observations.append(observation)
        if terminated or truncated:
            break
    return to_state(np.array(observations))
    ### END SOLUTION


# %% [markdown]
# ## Task 7.3. Arrows
#
# An arrow starts in one state and says how far it is to the next. A pendulum that swings through
# the lowest point from 3.1 to -3.1 turns by 0.08, not by -6.2.


# %%
def arrows(before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """Return one arrow for each pair of states, shape (n, 4).

    before and after hold n states each, shape (n, 2). A row of the result is the angle and the
    velocity before, the change of the angle, and the change of the velocity. The change of an
    angle is the short way around, in [-pi, pi]; a velocity has no way around. The arrays given stay
    as they are.
    """
    ### BEGIN SOLUTION task 7.3: compute arrows, the short way around
    change = after - before
    change[:, 0] = (change[:, 0] + np.pi) % (2 * np.pi) - np.pi
    return np.hstack([before, change])
    ### END SOLUTION


# %% [markdown]
# ## Task 7.4. The whole state space
#
# To see what the controller would do everywhere, start one step from each point of a grid. Below
# all its wrappers (`env.unwrapped`) the environment holds its state as an attribute: after a
# `reset`, `env.unwrapped.state = np.array([angle, velocity])` puts the pendulum anywhere. The
# controller must be given the observation that belongs to that state.


# %%
def grid(nangles: int, nvelocities: int) -> np.ndarray:
    """Return evenly spaced states, shape (nangles * nvelocities, 2).

    The angles go from -pi to pi and the velocities from -8 to 8, both ends included. All angles
    with the first velocity come first, then all angles with the second, and so on.
    """
    ### BEGIN SOLUTION task 7.4: lay out the grid
    angles = np.linspace(-np.pi, np.pi, nangles)
    velocities = np.linspace(-8, 8, nvelocities)
    return np.stack([np.tile(angles, nvelocities), np.repeat(velocities, nangles)], axis=1)
    ### END SOLUTION


def next_states(controller, states: np.ndarray) -> np.ndarray:
    """Return the states one step of Pendulum-v1 after each of the given ones; shapes (n, 2).

    The controller chooses the action in each state. Angles are in [-pi, pi].
    """
    ### BEGIN SOLUTION task 7.4: step once from each state
    env = gymnasium.make("Pendulum-v1")
    env.reset()
    following = []
    for angle, velocity in states:
        env.unwrapped.state = np.array([angle, velocity])
        seen = np.array([np.cos(angle), np.sin(angle), velocity], dtype=np.float32)
        observation, *_ = env.step(controller(seen))
        following.append(observation)
    return to_state(np.array(following))
    ### END SOLUTION


# %% [markdown]
# ## Task 7.5. Keeping stages of evolution
#
# A run leaves only its best robot behind. To compare stages you need the robots on the way, too.
# The loop of an evolution is the same for every algorithm of botschool: `algorithm.ask()` returns
# the candidates of a generation (one row of parameters each) and seeds that are not needed here,
# and `algorithm.tell(fitness)` takes their fitness back.


# %%
def evolve(algorithm, evaluate, generations: int, every: int) -> dict:
    """Evolve, and keep the best candidate of one generation in `every`.

    In generation g (from 0) the candidates come from one `candidates, seeds = algorithm.ask()`,
    their fitness from one `evaluate(candidates, g)`, which is then told to the algorithm. Kept is
    the candidate with the highest fitness of the generations 0, every, 2 * every, ..., and of the
    last one. The algorithm may use its array of candidates again for the next generation.

    Returns a dict with
    - "generations": the numbers of the generations kept, in order, each once;
    - "parameters": the candidates kept, shape (number of them, parameters);
    - "history": the highest fitness of each generation, a list of `generations` numbers.
    """
    ### BEGIN SOLUTION task 7.5: evolve and keep stages
    kept, parameters, history = [], [], []
    for generation in range(generations):
        candidates, _ = algorithm.ask()
        fitness = evaluate(candidates, generation)
        best = int(np.argmax(fitness))
        history.append(float(fitness[best]))
        if generation % every == 0 or generation == generations - 1:
            kept.append(generation)
            parameters.append(candidates[best].copy())
        algorithm.tell(fitness)
    return {"generations": kept, "parameters": np.array(parameters), "history": history}
    ### END SOLUTION


# %% [markdown]
# ## Task 7.6. Three stages
#
# `Robot("Pendulum-v1")` evaluates networks fast, as in exercise 3. `openai_es(robot, seed)` below
# gives the algorithm that you will write yourself in exercise 8, with hyperparameters that suit
# the pendulum: 600 generations with 10 episodes for each candidate take about a second. With fewer
# episodes some runs never get beyond a return of -800.


# %%
def openai_es(robot: Robot, seed: int) -> OpenAIES:
    """Return OpenAI-ES for a robot: 20 pairs of candidates per generation."""
    config = OpenAIESConfig(samplesize=20, stepsize=0.05, noiseStdDev=0.2)
    weights = 0.1 * np.random.default_rng(seed).standard_normal(robot.nweights)
    centre = np.concatenate([np.zeros(robot.nbiases), weights])
    return OpenAIES(config, lambda index: centre, seed)


def three_stages(seed: int) -> np.ndarray:
    """Return parameters of three controllers of Robot("Pendulum-v1") from one evolution, in order.

    The first is the best of generation 0; the last swings the pendulum up and holds it: its mean
    return over 100 episodes is at least -400. The middle one is on its way: its mean return is at
    least 100 higher than the first one's, and at least 100 lower than the last one's.

    The return of one evaluation depends on luck: measure those that you have kept once more, with
    robot.evaluate(parameters, seed, episodes=100), before you choose. Return candidates as they
    were evaluated. Everything random follows from the seed, and another seed gives another
    evolution. The parameters of the grader's robots count with other signs and sizes.

    Returns an array of shape (3, parameters).
    """
    ### BEGIN SOLUTION task 7.6: evolve the pendulum and choose three stages
    robot = Robot("Pendulum-v1")

    def evaluate(candidates, generation):
        return robot.evaluate(candidates, seed + generation, episodes=10)

    parameters = evolve(openai_es(robot, seed), evaluate, generations=600, every=5)["parameters"]
    fitness = robot.evaluate(parameters, seed + 10_000, episodes=100)
    best = int(np.argmax(fitness))
    halfway = (fitness[0] + fitness[best]) / 2
    middle = int(np.argmin(np.abs(fitness[: best + 1] - halfway)))
    return parameters[[0, middle, best]]
    ### END SOLUTION


# %% [markdown]
# ## Task 7.7. The picture
#
# `figure = Figure(figsize=(width, height))` makes an empty picture, `figure.subplots(1, n,
# squeeze=False)[0]` its n panels in a row, and `figure.savefig(file, dpi=100)` writes it with 100
# pixels per unit of figsize. In a panel, `axes.quiver(x, y, dx, dy, angles="xy",
# scale_units="xy", scale=1)` draws arrows in the units of the axes, so that each ends exactly in
# the next state. Give the field a quiet colour and the path a strong one.


# %%
def draw_portraits(
    file: str, titles: list[str], fields: list[np.ndarray], paths: list[np.ndarray]
) -> None:
    """Draw phase portraits side by side, in one row, into a PNG file.

    Panel i has titles[i], the arrows fields[i] of the grid, and above them the arrows paths[i] of
    episodes; both have the shape (n, 4), as `arrows` gives them, and each arrow is drawn from its
    state to the next one, with its head there. Whatever is drawn, each panel
    shows exactly the angles from -pi to pi, from left to right, and the velocities from -8 to 8,
    upwards. The picture is at least 300 pixels high, and at least 300 wide for each panel.
    """
    from matplotlib.figure import Figure

    ### BEGIN SOLUTION task 7.7: draw the portraits
    figure = Figure(figsize=(4.0 * len(titles), 4.2), layout="constrained")
    panels = figure.subplots(1, len(titles), squeeze=False, sharey=True)[0]
    exact = {"angles": "xy", "scale_units": "xy", "scale": 1}
    for axes, title, field, path in zip(panels, titles, fields, paths, strict=True):
        axes.quiver(*field.T, color="#a8b4c0", width=0.0035, **exact)
        axes.quiver(*path.T, color="#d55e00", width=0.005, **exact)
        axes.set(title=title, xlabel="angle (0 is upright)", xlim=(-np.pi, np.pi), ylim=(-8, 8))
        axes.set_xticks([-np.pi, -np.pi / 2, 0, np.pi / 2, np.pi])
        axes.set_xticklabels(["-π", "-π/2", "0", "π/2", "π"])
    panels[0].set_ylabel("velocity (rad/s)")
    figure.savefig(file, dpi=100)
    ### END SOLUTION


# %% [markdown]
# ## The portraits
#
# `botschool show 7` runs this part.

# %%
if __name__ == "__main__":
    from botschool.course import film

    robot = Robot("Pendulum-v1")
    stages = three_stages(seed=1)
    returns = robot.evaluate(stages, seed=123, episodes=100)
    controllers = [lambda observation: np.zeros(1), *(controller_of(robot, p) for p in stages)]
    names = ["generation 0", "on the way", "evolved"]
    titles = ["no motor"]
    titles += [f"{name} (return {value:.0f})" for name, value in zip(names, returns, strict=True)]

    states = grid(25, 21)
    fields = [arrows(states, next_states(controller, states)) for controller in controllers]
    paths = []
    for controller in controllers:
        episodes = [record(controller, seed, steps=200) for seed in (1, 2, 3, 4)]
        paths.append(np.concatenate([arrows(e[:-1], e[1:]) for e in episodes]))
    draw_portraits("portraits.png", titles, fields, paths)
    print("picture: portraits.png")
    film("pendulum.mp4", "Pendulum-v1", stages[2])
