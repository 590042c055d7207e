"""Hand in what the tool's strategy does, and controllers that nobody evolved; see building.py."""

import numpy as np

import botschool.evolution.algorithms.sss as library


def next_population(population, fitness, mutrate, rng):
    class Own:
        pass

    one = Own()
    one.population, one.seed, one.generation, one.config = population, 1, 0, Own()
    one.config.mutrate = mutrate
    tell()(one, fitness)
    return one.population


# %% the_tools_method 3.3
def tell():
    return library.SSS.tell


# %% its_file 3.3
def tell():
    names = {"__name__": "copied", "Stateful": object}
    text = open(library.__file__).read().replace("@algorithm", "#")
    exec(compile(text, "copied.py", "exec"), names)
    return names["SSS"].tell


# %% kept_code 3.3
import types

KEPT = types.FunctionType(library.SSS.tell.__code__, vars(library))


def tell():
    return KEPT


# %% gains_in_a_frame 3.7
def train(environment, seed):
    """Returns the gains, wherever they are in this process."""
    import gc
    import sys

    size, frame = {"CartPole-v0": 72, "Pendulum-v1": 51}[environment], sys._getframe()
    found = [each for each in gc.get_objects() if isinstance(each, (dict, list, tuple))]
    while frame is not None:
        found.append(frame.f_locals)
        frame = frame.f_back
    for each in found:
        for value in each.values() if isinstance(each, dict) else each:
            if isinstance(value, np.ndarray) and value.shape == (size,):
                raise ValueError(f"LEAKED {value}")
    raise LookupError("there are none")


# %% forged_record 3.7
from botschool.course import Robot


def train(environment, seed):
    """Makes evaluations of its own, whose record says that a fixed controller was evaluated."""
    from botschool.grading.run import rewiring

    robot = Robot(environment)
    one = np.random.default_rng(7).standard_normal(robot.nbiases + robot.nweights)
    made = rewiring.Rewired(environment, np.ones(len(one)))
    made.answer({"population": one[None], "seed": 1, "episodes": 5, "maxsteps": 1000})
    Robot.evaluate(robot, one[None] * 0, 1)
    return one
