"""Combine the policies of two agents that may differ in observations and actions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from botschool.errors import BotschoolError
from botschool.policies.hyperparameters import PolicyConfig
from botschool.policies.policy import Interface, Policy

NOISE_STRIDE = 2**48
"""Difference of the seeds of two robots' action noise (docs/specification.md, "Evaluation")."""


class Pair:
    """The policies that an experiment's [POLICY] describes, one for each of two agents.

    Both have the hyperparameters of the file, but inputs and outputs of their own. A genotype is
    two rows of `nparameters` values, one after the other; the larger network determines their
    length. The smaller network's row ends with unused values (docs/specification.md, "Policy
    network").
    """

    networks = 2

    def __init__(self, problem: str, interfaces: Sequence[Interface], config: PolicyConfig) -> None:
        """Make both policies. Raises BotschoolError."""
        if config.nrobots != 2:
            raise BotschoolError(f"{problem} has 2 agents: set nrobots = 2, not {config.nrobots}.")
        alone = replace(config, nrobots=1, heterogeneous=0)
        self.config = config
        self.sides = [Policy(problem, interface, alone) for interface in interfaces]
        self.sizes = [side.genotype_size for side in self.sides]
        """Parameters of each network."""
        self.nparameters = max(self.sizes)
        """Values of a row."""

    @property
    def genotype_size(self) -> int:
        """Return the number of values of both rows."""
        return 2 * self.nparameters

    @property
    def scales(self) -> bool:
        """Return whether a side's outputs are scaled to the limits of its actions."""
        return any(side.scales for side in self.sides)

    @property
    def unreached(self) -> str:
        """Return a note about actions that outputs do not reach, or hardly; often ""."""
        return self.sides[0].unreached or self.sides[1].unreached

    @property
    def neurons(self) -> tuple[list[int], list[int]]:
        """Return the inputs and outputs of each network."""
        inputs, outputs = zip(*(side.neurons for side in self.sides), strict=True)
        return list(inputs), list(outputs)

    def initial(self, seed: int, index: int = 0) -> np.ndarray:
        """Return a random genotype, shape (genotype_size,); each (seed, index) gives another."""
        rows = np.zeros((2, self.nparameters))
        for k, (row, side) in enumerate(zip(rows, self.sides, strict=True)):
            row[: self.sizes[k]] = side.initial(seed, 2 * index + k)
        return rows.ravel()

    def split(self, saved: np.ndarray) -> tuple[np.ndarray, None]:
        """Split a saved genotype into (genotype, no normalisation vectors).

        Raises BotschoolError if it has the wrong length for this policy.
        """
        saved = np.asarray(saved)
        if saved.dtype.kind not in "fiu" or saved.shape != (self.genotype_size,):
            raise BotschoolError(
                f"The genotype has shape {saved.shape}, but this experiment needs "
                f"{self.genotype_size} values ({self.nparameters} for each agent): it was saved "
                "with other [POLICY] settings."
            )
        if not np.isfinite(saved).all():
            raise BotschoolError("The genotype holds values that are not finite numbers.")
        return saved.astype(np.float64), None

    def load(self, genotype: np.ndarray, normalisation: None = None) -> None:
        """Put a genotype into the networks; its rows may also be given as (2, nparameters)."""
        for side, row in zip(self.sides, genotype.reshape(2, -1), strict=True):
            side.load(row[: side.genotype_size], None)

    def reset(self, seed: int, episode: int) -> None:
        """Start an episode; its action noise depends only on (seed, episode) and the side."""
        for k, side in enumerate(self.sides):
            side.reset((seed + k * NOISE_STRIDE) % 2**64, episode)

    @property
    def activations(self) -> np.ndarray:
        """Return the activations of the first network's neurons, then of the second's."""
        return np.concatenate([side.network.activations for side in self.sides])
