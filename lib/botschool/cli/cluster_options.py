"""Define the options of commands that can evaluate on a cluster."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from botschool.errors import BotschoolError

if TYPE_CHECKING:
    from botschool.cluster import Open

Cluster = Annotated[
    str | None,
    typer.Option(
        "--cluster",
        help="Evaluate on the workers of a Dask scheduler: tcp://HOST:PORT, tls://HOST:PORT or its "
        "FILE.json; or local:N, N workers on this machine.",
        metavar="ADDRESS",
    ),
]
NoTLS = Annotated[
    bool,
    typer.Option(
        "--no-tls", help="With --cluster: allow another machine's address without encryption."
    ),
]
Patience = Annotated[
    float | None,
    typer.Option(
        min=0,
        help="With --cluster: minutes to wait for workers or for a scheduler that does not answer.",
        show_default="5",
    ),
]


def machines(
    cluster: str | None, no_tls: bool, patience: float | None, workers: int | None
) -> Open | None:
    """Return the cluster that the options name, without opening it; None without --cluster."""
    if cluster is None:
        if no_tls or patience is not None:
            raise BotschoolError("--no-tls and --patience need --cluster: add --cluster ADDRESS.")
        return None
    if workers is not None:
        raise BotschoolError(
            "--cluster has its own workers: leave -w out (local:N starts N on this machine)."
        )
    from botschool.cluster import PATIENCE, Open

    return Open(cluster, no_tls, PATIENCE if patience is None else 60 * patience)
