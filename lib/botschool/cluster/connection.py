"""Connect to Dask's scheduler: list its workers, submit tasks, receive answers."""

from __future__ import annotations

import asyncio
import concurrent.futures
import itertools
import logging
import multiprocessing
import os
import queue
import signal
import time
import uuid
import warnings
from collections.abc import Callable
from contextlib import suppress
from multiprocessing import resource_tracker
from urllib.request import ProxyHandler, build_opener

from botschool.cluster.address import Place
from botschool.errors import BotschoolError, said
from botschool.terminal import SIGNALS, unheard

try:
    import dask
    import distributed
except ImportError:
    raise BotschoolError(
        "--cluster needs Dask, which is not installed: pip install 'botschool[cluster]'."
    ) from None

ASKING = 0.5
"""Seconds between two requests for the list of workers."""
SILENCE = 10.0
"""Seconds of silence after which the user is told that the scheduler does not answer."""
ATTEMPT = 5.0
"""Longest duration of an attempt to connect, in seconds."""
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


class Connection:
    """A connection to one scheduler while a command runs. Call all methods from one thread.

    patience: seconds that the scheduler may stay silent. say: called with messages for the user.
    """

    def __init__(self, place: Place, patience: float, say: Callable[[str], None]) -> None:
        self._place = place
        self._patience = patience
        self._say = say
        self._cluster: distributed.LocalCluster | None = None
        self._client: distributed.Client | None = None
        self._numbers = itertools.count()
        self._pending: dict[int, concurrent.futures.Future] = {}
        self._name = uuid.uuid4().hex[:8]
        self._answers: queue.SimpleQueue[tuple[int, bytes | BaseException]] = queue.SimpleQueue()
        self.members: dict[str, int] = {}
        """Threads of each worker, by its address."""
        self.lost = False
        """Whether the scheduler was silent for too long; nothing is sent after that."""
        self._question: concurrent.futures.Future | None = None
        self._asked = 0.0
        self._answered = self._refreshed = time.monotonic()
        self._told = False
        for name in list(logging.root.manager.loggerDict):  # botschool's own messages report errors
            if name.partition(".")[0] in LOGGERS:
                logging.getLogger(name).setLevel(logging.CRITICAL + 1)
        warnings.filterwarnings("ignore", module="distributed")
        dask.config.set(QUIET)
        if place.local:
            self._start(place.local)
        self._connect(first=True)

    def answer(self, timeout: float) -> tuple[int, bytes | BaseException] | None:
        """Return a task's number and its answer; None if nothing arrives in `timeout` seconds."""
        try:
            number, answer = self._answers.get(timeout > 0, timeout)
        except queue.Empty:
            return None
        self._pending.pop(number, None)
        return number, answer

    @property
    def answering(self) -> bool:
        """Return whether the scheduler has sent its list of workers recently."""
        return self._client.status == "running" and time.monotonic() - self._answered < SILENCE

    @property
    def place(self) -> str:
        """Return the user's name for the cluster."""
        return self._place.text

    @property
    def address(self) -> str:
        """Return the scheduler's address."""
        return self._cluster.scheduler_address if self._cluster else self._place.address()

    @property
    def dashboard(self) -> str:
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
        except Exception as error:
            raise BotschoolError(
                f"--cluster {self._place.text} cannot start its workers ({said(error)}): -w "
                f"{workers} uses the cores of this machine without them."
            ) from None

    def _connect(self, first: bool = False) -> None:
        """Connect a new client; raises BotschoolError if the first attempt fails."""
        address = self.address if first else ""
        if address.startswith("tls:") and not _has_certificates():
            raise BotschoolError(
                f"{address} needs certificates: name them in Dask's settings, distributed.comm.tls "
                "(ca-file, client.cert and client.key)."
            )
        try:
            with unheard(FROM_TERMINAL):
                address = self.address
                self._client = distributed.Client(
                    self._cluster or address,
                    timeout=ATTEMPT,
                    set_as_default=False,
                    name="botschool",
                )
        except BotschoolError:
            if first:
                raise
        except Exception as error:
            if not first:
                return
            trusted = " and the certificates of both sides" if address.startswith("tls:") else ""
            raise BotschoolError(
                f"No scheduler answers at {address} ({said(error)}): start one with 'dask "
                f"scheduler', or check the address{trusted}."
            ) from None
        self._asked = 0.0

    def submit(self, function: Callable[[bytes], bytes], worker: str, message: bytes) -> int:
        """Call a function on this worker only; return the task's number."""
        number = next(self._numbers)
        key = f"{function.__name__}-{self._name}-{number}"
        task = self._on_loop(self._task(self._client, function, worker, message, key))
        self._pending[number] = task
        task.add_done_callback(lambda done: self._answers.put((number, _outcome(done))))
        return number

    def forget(self, number: int | None) -> None:
        """Give a task up: it need not begin, and its answer does not count."""
        task = self._pending.pop(number, None)
        if task is not None:
            task.cancel()

    def _on_loop(self, coroutine) -> concurrent.futures.Future:
        return asyncio.run_coroutine_threadsafe(coroutine, self._client.loop.asyncio_loop)

    @staticmethod
    async def _task(client, function, worker, message, key) -> bytes:
        future = client.submit(
            function, message, key=key, workers=[worker], allow_other_workers=False, pure=False
        )
        try:
            return await future
        finally:
            future.release()

    def refresh(self) -> None:
        """Update `members`; call it repeatedly.

        Raises BotschoolError when the scheduler has been silent for longer than `patience`.
        """
        try:
            self._refresh(time.monotonic())
        finally:
            self._refreshed = time.monotonic()

    def _refresh(self, now: float) -> None:
        if now - self._refreshed > ATTEMPT:  # refresh was not called: the scheduler was not silent
            self._answered = now
        if self._question is not None and self._question.done():
            with suppress(Exception, asyncio.CancelledError, concurrent.futures.CancelledError):
                self.members = dict(self._question.result())
                self._answered = now
                if self._told:
                    self._say(f"The scheduler at {self.place} is back.")
                self._told = False
            self._question = None
        away = now - self._answered
        if away > self._patience:
            self.lost = True
            raise BotschoolError(
                f"The scheduler at {self.place} has not answered for {away:.0f} seconds: "
                "start it again, and add --resume to continue, with any --cluster or without "
                "one."
            )
        if away > SILENCE and not self._told:
            self._told = True
            self._say(
                f"The scheduler at {self.place} does not answer: waiting for it up to "
                f"{self._patience:.0f} seconds (Ctrl-C stops and saves)."
            )
        if self._question is None and now - self._asked >= ASKING:
            self._asked = now
            if self._client.status in ("closed", "closing", "newly-created"):
                self.members = {}
                self._reconnect()
            elif self._client.status == "running":
                self._question = self._on_loop(_ask(self._client))
            else:
                self.members = {}

    def _reconnect(self) -> None:
        if self._cluster is None:
            with suppress(Exception):
                self._client.close(timeout=1)
            self._connect()

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


def _has_certificates() -> bool:
    """Return whether Dask's settings name the certificates that a client needs."""
    try:
        return distributed.Security().get_connection_args("client").get("ssl_context") is not None
    except Exception as error:
        raise BotschoolError(
            f"The certificates in Dask's settings distributed.comm.tls cannot be used "
            f"({said(error)})."
        ) from None


async def _ask(client) -> dict[str, int]:
    return await asyncio.wait_for(client.scheduler.ncores(), SILENCE)


def _outcome(done: concurrent.futures.Future) -> bytes | BaseException:
    if done.cancelled():
        return concurrent.futures.CancelledError()
    return done.exception() or done.result()
