"""Evaluate on many machines by Dask (docs/specification.md, "On a cluster").

`Open(TEXT)` opens a Cluster, whose `problem(experiment)` evaluates on its workers. Only then is
Dask imported.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING

from botschool.cluster.address import place
from botschool.config import Experiment

if TYPE_CHECKING:
    from botschool.cluster.connection import Connection
    from botschool.cluster.problem import Distributed

PATIENCE = 300.0
"""Default for the seconds to wait for workers, or for a scheduler that does not answer."""


class Cluster:
    """A connection to a scheduler, which makes problems that use it."""

    def __init__(self, connection: Connection, patience: float, say: Callable[[str], None]) -> None:
        self._connection, self._patience, self._say = connection, patience, say

    def problem(self, experiment: Experiment) -> Distributed:
        """Return the experiment's problem, evaluated on the workers. Raises BotschoolError."""
        from botschool.cluster.problem import Distributed

        return Distributed(experiment, self._connection, self._patience, self._say)


@dataclass(frozen=True)
class Open:
    """A cluster as the user names it. Calling it with `say`, a function that gets messages for the
    user, returns the context of the Cluster. Raises BotschoolError.
    """

    text: str
    """The value of --cluster."""
    unsafe: bool = False
    """Allow addresses beyond this machine without TLS."""
    patience: float = PATIENCE
    """Seconds to wait for workers, or for a scheduler that does not answer."""

    @contextmanager
    def __call__(self, say: Callable[[str], None]) -> Iterator[Cluster]:
        found = place(self.text, self.unsafe)
        from botschool.cluster.connection import Connection

        connection = Connection(found, self.patience, say)
        try:
            if connection.dashboard:
                say(f"Dask's dashboard: {connection.dashboard}")
            yield Cluster(connection, self.patience, say)
        finally:
            connection.close()
