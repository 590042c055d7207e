"""Evaluate on many machines by Dask (docs/specification.md, "On a cluster").

`Open(TEXT).problem(experiment, say)` evaluates on a cluster's workers. Only then is Dask imported.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING

from botschool.cluster.address import place
from botschool.config import Experiment

if TYPE_CHECKING:
    from botschool.cluster.problem import Distributed

PATIENCE = 300.0
"""Default for the seconds to wait for workers, or for a scheduler that does not answer."""


@dataclass(frozen=True)
class Open:
    """A cluster as the user names it."""

    text: str
    """The value of --cluster."""
    unsafe: bool = False
    """Allow addresses beyond this machine without TLS."""
    patience: float = PATIENCE
    """Seconds to wait for workers, or for a scheduler that does not answer."""

    @contextmanager
    def problem(self, experiment: Experiment, say: Callable[[str], None]) -> Iterator[Distributed]:
        """Yield the experiment's problem, evaluated on the workers. Raises BotschoolError.

        say: called with messages for the user.
        """
        address, workers = place(self.text, self.unsafe)
        from botschool.cluster.connection import Connection
        from botschool.cluster.problem import Distributed

        with closing(Connection(self.text, address, workers, self.patience, say)) as connection:
            yield Distributed(experiment, connection)
