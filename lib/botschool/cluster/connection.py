"""Connect to Dask's scheduler: list its workers, submit tasks."""

from __future__ import annotations

import asyncio
import logging
import multiprocessing
import os
import signal
import warnings
from collections.abc import Callable
from contextlib import suppress
from multiprocessing import resource_tracker
from typing import Any
from urllib.request import ProxyHandler, build_opener

from botschool.errors import BotschoolError, said
from botschool.terminal import SIGNALS, unheard

try:
    import dask
    import distributed
except ImportError:
    raise BotschoolError(
        "--cluster needs Dask, which is not installed: pip install 'botschool[cluster]'."
    ) from None

SILENCE = 10.0
"""Seconds in which the scheduler should answer."""
ATTEMPT = 5.0
"""Longest duration of the first attempt to connect, in seconds."""
RETRIES = 4
"""How often Dask tries a task again that has failed."""
QUIET = {
    "distributed.worker.profile.enabled": False,
    "distributed.admin.tick.interval": "1s",
    "distributed.admin.tick.limit": "1h",
    "distributed.admin.system-monitor.interval": "2s",
    "distributed.client.heartbeat": "5s",
}
"""Dask's settings without the measurements that cost each process a few hundredths of a core."""
FROM_TERMINAL = [number for number in SIGNALS if number != signal.SIGTERM]
"""Signals that a terminal sends to all processes: Ctrl-C, and its end. SIGTERM must end workers."""
LOGGERS = ("distributed", "tornado", "asyncio", "bokeh")


class Lost(Exception):
    """Raised for a task if the connection is lost."""


class Connection:
    """A connection to one scheduler while a command runs.

    place: the user's name for it; workers: how many to start here, with a scheduler, if there is no
    address; patience: seconds that scheduler and workers may be away; say: called with messages for
    the user.
    """

    def __init__(
        self, place: str, address: str, workers: int, patience: float, say: Callable[[str], None]
    ) -> None:
        self.place, self.address, self.patience, self.say = place, address, patience, say
        self._cluster: distributed.LocalCluster | None = None
        self.heard = False
        """Set when the scheduler answers."""
        for name in list(logging.root.manager.loggerDict):  # botschool's own messages report errors
            if name.partition(".")[0] in LOGGERS:
                logging.getLogger(name).setLevel(logging.CRITICAL + 1)
        warnings.filterwarnings("ignore", module="distributed")
        dask.config.set(QUIET)
        if workers:
            self._start(workers)
        self._connect(ATTEMPT)
        if link := self._dashboard():
            say(f"Dask's dashboard: {link}")
        if not self._cluster:
            self._client.close()
            self._connect(max(patience, ATTEMPT))  # for so long, Dask tries to connect again

    @property
    def open(self) -> bool:
        """Return whether there is a connection."""
        return self._client.status == "running"

    async def members(self) -> dict[str, int] | None:
        """Return the threads of each worker by its address; None without an answer."""
        if not self.open:
            return {}
        try:
            found = await asyncio.wait_for(self._client.scheduler.ncores(), SILENCE)
        except Exception:
            return None
        self.heard = True
        return found

    async def submit(self, worker: str, function: Callable, *arguments: Any) -> Any:
        """Call a function on this worker, and again if it fails. Raises its exception, or Lost."""
        if not self.open:
            raise Lost
        future = self._client.submit(
            function, *arguments, workers=[worker], retries=RETRIES, pure=False
        )
        try:
            return await future
        except Exception:
            if future.status == "error":  # the function's own
                raise
            raise Lost from None
        finally:
            future.release()

    def _start(self, workers: int) -> None:
        """Start a scheduler and workers that only this machine can reach."""
        _track_processes()
        try:
            with unheard(FROM_TERMINAL):  # the main process handles these signals
                self._cluster = distributed.LocalCluster(
                    n_workers=workers,
                    threads_per_worker=1,
                    host="127.0.0.1",
                    dashboard_address="127.0.0.1:0",
                    worker_dashboard_address="127.0.0.1:0",
                    memory_limit=0,
                    silence_logs=logging.CRITICAL + 1,
                )
            self.address = self._cluster.scheduler_address
        except Exception as error:
            raise BotschoolError(
                f"--cluster {self.place} cannot start its workers ({said(error)}): -w {workers} "
                "uses the cores of this machine without them."
            ) from None

    def _connect(self, timeout: float) -> None:
        """Connect a new client. Raises BotschoolError."""
        if self.address.startswith("tls:") and not _has_certificates():
            raise BotschoolError(
                f"{self.address} needs certificates: name them in Dask's settings, "
                "distributed.comm.tls (ca-file, client.cert and client.key)."
            )
        try:
            with unheard(FROM_TERMINAL):
                self._client: Any = distributed.Client(
                    self._cluster or self.address,
                    timeout=timeout,
                    set_as_default=False,
                    name="botschool",
                )
            self.loop = self._client.loop.asyncio_loop
            """The loop in which `members` and `submit` run."""
        except Exception as error:
            trusted = " and the certificates of both sides"
            raise BotschoolError(
                f"No scheduler answers at {self.address} ({said(error)}): start one with 'dask "
                f"scheduler', or check the address{trusted * self.address.startswith('tls:')}."
            ) from None

    def _dashboard(self) -> str:
        """Return the address of Dask's dashboard; "" if none answers there.

        Dask names an address even for a scheduler without a dashboard or without bokeh.
        """
        with suppress(Exception):
            link = self._client.dashboard_link or ""
            direct = build_opener(ProxyHandler({}))
            with direct.open(link, timeout=ATTEMPT) as page:
                if b"Dask needs" not in page.read(1000):  # a scheduler without bokeh says this
                    return link
        return ""

    def close(self) -> None:
        """Leave the scheduler; one that we started ends, with its workers."""
        with suppress(Exception):
            self._client.close(timeout=2)
        if self._cluster is not None:
            with suppress(Exception):
                self._cluster.close(timeout=5)
            for process in multiprocessing.active_children():
                if "Dask" in process.name:  # Python would wait for it
                    process.kill()


def _has_certificates() -> bool:
    """Return whether Dask's settings name the certificates that a client needs."""
    try:
        return distributed.Security().get_connection_args("client").get("ssl_context") is not None
    except Exception as error:
        raise BotschoolError(
            f"The certificates in Dask's settings distributed.comm.tls cannot be used "
            f"({said(error)})."
        ) from None


def _track_processes() -> None:
    """Start Python's resource tracker now: later it would unblock the workers' signals, and
    complain when this process is killed.
    """
    if os.name == "posix":
        before = os.environ.get("PYTHONWARNINGS")
        os.environ["PYTHONWARNINGS"] = "ignore"
        resource_tracker.ensure_running()
        os.environ.pop("PYTHONWARNINGS")
        if before is not None:
            os.environ["PYTHONWARNINGS"] = before
