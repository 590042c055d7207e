"""Our solution of exercise 6 thinks as the tool's network does; its grader compares with it."""

import runpy
from pathlib import Path

import numpy as np
import pytest

from botschool.course import genotype_file
from botschool.net import Network, NetworkSpec

FILE = Path(__file__).parents[2] / "solutions/ex06_foraging_robot/foraging_robot.py"
SOLUTION = runpy.run_path(str(FILE))


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_brains_think_as_the_tools_network(seed):
    genotype, rng = np.load(genotype_file(f"discrimS{seed}.npy")), np.random.default_rng(seed)
    brain, memory = SOLUTION["weights"](genotype), np.zeros((2, 10))
    net = Network(NetworkSpec(inputs=8, outputs=2, nhiddens=10, bias=1, architecture=3))
    net.parameters = genotype
    for observation in rng.uniform(0, 1, (40, 8)):
        action, memory = SOLUTION["think"](brain, observation, memory)
        net.observation = observation
        np.testing.assert_allclose(action, net.step(), atol=1e-6)
