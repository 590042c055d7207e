"""The connection to Dask's scheduler: who is there, tasks out, answers in."""

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
"""Seconds between two questions who is there."""
SILENCE = 10.0
"""Seconds after which a scheduler that does not answer is told of."""
ATTEMPT = 5.0
"""Seconds that one attempt to connect may take."""
QUIET = {
    "distributed.worker.profile.enabled": False,
    "distributed.admin.tick.interval": "1s",
    "distributed.admin.tick.limit": "1h",
    "distributed.admin.system-monitor.interval": "2s",
    "distributed.client.heartbeat": "5s",
}
"""Dask's settings without the measurements that cost each process a few hundredths of a core."""
FROM_TERMINAL = [number for number in SIGNALS if number != signal.SIGTERM]
"""What a terminal sends to all processes: Ctrl-C, and its end. SIGTERM must end workers."""
LOGGERS = ("distributed", "tornado", "asyncio", "bokeh")


class Connection:
    """To one scheduler, for as long as a command runs. Call everything from one thread.

    patience: seconds that the scheduler may be away. say: called with sentences for the user.
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
        """Whether the scheduler was away for too long; nothing is sent from then on."""
        self._question: concurrent.futures.Future | None = None
        self._asked = 0.0
        self._answered = self._refreshed = time.monotonic()
        self._told = False
        for name in list(logging.root.manager.loggerDict):  # what goes wrong is said in sentences
            if name.partition(".")[0] in LOGGERS:
                logging.getLogger(name).setLevel(logging.CRITICAL + 1)
        warnings.filterwarnings("ignore", module="distributed")
        dask.config.set(QUIET)
        if place.local:
            self._start(place.local)
        self._connect(first=True)

    def answer(self, timeout: float) -> tuple[int, bytes | BaseException] | None:
        """Number of a task and what came of it; None if nothing comes within so many seconds."""
        try:
            number, answer = self._answers.get(timeout > 0, timeout)
        except queue.Empty:
            return None
        self._pending.pop(number, None)
        return number, answer

    @property
    def answering(self) -> bool:
        """Whether the scheduler has said lately who is there."""
        return self._client.status == "running" and time.monotonic() - self._answered < SILENCE

    @property
    def place(self) -> str:
        """What the user calls it."""
        return self._place.text

    @property
    def address(self) -> str:
        """The scheduler's."""
        return self._cluster.scheduler_address if self._cluster else self._place.address()

    @property
    def dashboard(self) -> str:
        """Return the address of Dask's dashboard; "" if none answers there.

        Dask names an address for each scheduler, also for one without a dashboard or without bokeh.
        """
        with suppress(Exception):
            link = self._client.dashboard_link or ""
            direct = build_opener(ProxyHandler({}))
            with direct.open(link, timeout=ATTEMPT) as page:
                if b"Dask needs" not in page.read(1000):  # of a scheduler without bokeh
                    return link
        return ""

    def _start(self, workers: int) -> None:
        """A scheduler and workers of our own; only this machine reaches them."""
        _track_processes()
        try:
            with unheard(FROM_TERMINAL):  # they are the main process's affair
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
        """A new client; raises BotschoolError if there is none at first."""
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
        """Calls a function on that worker, and on no other; gives the task's number."""
        number = next(self._numbers)
        key = f"{function.__name__}-{self._name}-{number}"
        task = self._on_loop(self._task(self._client, function, worker, message, key))
        self._pending[number] = task
        task.add_done_callback(lambda done: self._answers.put((number, _outcome(done))))
        return number

    def forget(self, number: int | None) -> None:
        """Gives a task up: it need not begin any more, and its answer does not count."""
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
        """Keeps `members` up to date; to be called again and again.

        Raises BotschoolError when the scheduler has been away for longer than is allowed.
        """
        try:
            self._refresh(time.monotonic())
        finally:
            self._refreshed = time.monotonic()

    def _refresh(self, now: float) -> None:
        if now - self._refreshed > ATTEMPT:  # nobody has asked: it was not the scheduler's silence
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
                f"The scheduler at {self.place} has not answered for {away:.0f} seconds: start it "
                "again, and add --resume to go on, with any --cluster or without one."
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
        """Leaves the scheduler; one of our own ends, with its workers."""
        with suppress(Exception):
            self._client.close(timeout=2)
        if self._cluster is not None:
            with suppress(Exception):
                self._cluster.close(timeout=5)
            for process in multiprocessing.active_children():
                if "Dask" in process.name:  # it would be waited for
                    process.kill()


def _track_processes() -> None:
    """Starts what tidies up after worker processes: it would let their signals through again, and
    complain when this process is ended at once."""
    if os.name == "posix":
        before = os.environ.get("PYTHONWARNINGS")
        os.environ["PYTHONWARNINGS"] = "ignore"
        resource_tracker.ensure_running()
        os.environ.pop("PYTHONWARNINGS")
        if before is not None:
            os.environ["PYTHONWARNINGS"] = before


def _has_certificates() -> bool:
    """Whether Dask's settings name those that a client needs."""
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
