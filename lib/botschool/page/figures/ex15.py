"""What the figures of exercise 15 need."""

from base64 import b64encode
from typing import Any

import numpy as np

from botschool import _core, config, problems
from botschool.page.exercise import robot
from botschool.paths import material
from botschool.policies.net import Network
from botschool.seeds import POST_EVALUATION_SEED

CORE = "predprey"
GENERATIONS = range(0, 301, 60)
SEED = 12


def data() -> dict[str, Any]:
    """Return the best predator and prey of some generations, and who beats whom.

    Their parameters are rounded to 8 bits, so that the page stays small.
    """
    folder = material() / "data" / "genotypes" / "predprey"
    saved = [np.load(folder / f"S{SEED}G{generation}.npy") for generation in GENERATIONS]
    sides = [
        [rounded(population[side * len(population) // 2]) for population in saved]
        for side in (0, 1)
    ]
    return {
        "arena": robot("predprey.ini", seed=SEED),
        "generations": list(GENERATIONS),
        "sides": [[{"step": step, "levels": coded(levels)} for step, levels in s] for s in sides],
        "matrix": tournament(*([step * levels for step, levels in s] for s in sides)),
    }


def rounded(genotype: np.ndarray) -> tuple[float, np.ndarray]:
    """Return a step and the genotype in whole multiples of it, from -127 to 127."""
    step = float(np.abs(genotype).max()) / 127
    return step, np.rint(genotype.astype(float) / step)


def coded(levels: np.ndarray) -> str:
    """Return whole numbers from -127 to 127 as text."""
    return b64encode(levels.astype(np.int8).tobytes()).decode()


def tournament(predators: list[np.ndarray], prey: list[np.ndarray]) -> list[list[float]]:
    """Return what each predator (row) gets against each prey; a chase has no chance in it."""
    return [[chase(one, other) for other in prey] for one in predators]


def chase(predator: np.ndarray, prey: np.ndarray) -> float:
    """Return what the predator gets, with networks in double precision as in the page."""
    experiment = config.load(material() / "data" / "experiments" / "predprey.ini")
    policy = problems.of(experiment).policy(experiment.policy)
    networks = [Network(policy.spec) for _ in range(2)]
    for network, genotype in zip(networks, (predator, prey), strict=True):
        network.parameters[:] = genotype
        network.reset()
    stepper = _core.make_stepper("ErPredprey")
    stepper.set(experiment.policy.maxsteps)
    stepper.start(SEED + POST_EVALUATION_SEED, 0)
    total = 0.0
    for _ in range(experiment.policy.maxsteps):
        for network, seen in zip(networks, np.split(stepper.observation, 2), strict=True):
            network.observation[:] = seen
        actions = [network.step().astype(np.float32) for network in networks]
        reward, ended = stepper.step(np.concatenate(actions).astype(float))
        total += reward
        if ended:
            break
    return total
