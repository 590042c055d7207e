"""Helpers for tests of clusters: Dask's schedulers and workers as processes on the loopback,
certificates, and a network that can be cut.
"""

from __future__ import annotations

import contextlib
import json
import signal
import socket
import subprocess
import sys
import threading
import time
from pathlib import Path

import psutil

from running import environment_of_command

ROOT = Path(__file__).parents[1]
CERTIFICATES = ROOT / "deploy" / "certificates.sh"
PATIENCE = 90
"""Seconds that a process may take to start on a busy machine."""


class Member:
    """A scheduler or worker, with its output so far."""

    def __init__(self, name: str, arguments: list[str], folder: Path, environment: dict) -> None:
        self.name = name
        self._log = folder / f"{name}.log"
        with open(self._log, "wb") as log:
            self.process = subprocess.Popen(
                [sys.executable, "-m", "dask", *arguments],
                stdout=log,
                stderr=subprocess.STDOUT,
                env=environment,
            )

    @property
    def log(self) -> str:
        """Return its standard output and error."""
        return self._log.read_text(errors="replace")

    @property
    def alive(self) -> bool:
        return self.process.poll() is None

    def says(self, words: str) -> None:
        """Wait until it has written these words; fail if it ends before."""
        until(lambda: words in self.log or not self.alive, f"{self.name}: no {words!r}", self)
        assert words in self.log, f"{self.name} has ended:\n{self.log}"

    def signal(self, number: int) -> None:
        """Send a signal to it and to the processes it has started."""
        for process in family(self.process.pid):
            with contextlib.suppress(psutil.NoSuchProcess):
                process.send_signal(number)

    def kill(self) -> None:
        """Kill it and its processes with kill -9."""
        self.signal(signal.SIGKILL)
        self.process.wait()

    def stop(self) -> None:
        """Ask it to end, as a batch system does before it kills, and wait until it has."""
        self.process.terminate()
        try:
            self.process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            self.kill()

    def full_disk(self) -> None:
        """Simulate a full disk: from now on every write to a file fails."""
        import resource

        for process in family(self.process.pid):
            process.rlimit(resource.RLIMIT_FSIZE, (0, 0))


def family(pid: int) -> list[psutil.Process]:
    """Return a process and its descendants."""
    try:
        process = psutil.Process(pid)
        return [process, *process.children(recursive=True)]
    except psutil.NoSuchProcess:
        return []


def until(happens, otherwise: str, member: Member | None = None, seconds: float = PATIENCE):
    """Wait until `happens()` returns something true, and return that."""
    end = time.monotonic() + seconds
    while not (found := happens()):
        told = f"\n{member.log}" if member else ""
        assert time.monotonic() < end, f"{otherwise} in {seconds} s{told}"
        time.sleep(0.05)
    return found


class Cluster:
    """Context of a scheduler and workers; at its end all are killed.

    settings: environment variables of all of them, as Dask reads them (DASK_...); tls: a folder
    that `certificates` has made. The scheduler keeps its address when it is started again.
    """

    def __init__(self, folder: Path, tls: Path | None = None, **settings: str) -> None:
        self.folder = folder
        folder.mkdir(parents=True, exist_ok=True)
        self.protocol = "tls" if tls else "tcp"
        self.environment = environment_of_command(
            **({"DASK_CONFIG": str(tls)} if tls else {}), **settings
        )
        self.file = folder / "scheduler.json"
        self.address = f"{self.protocol}://127.0.0.1:0"
        self.members: list[Member] = []

    def __enter__(self) -> Cluster:
        self.start_scheduler()
        return self

    def __exit__(self, *error: object) -> None:
        for member in self.members:
            if member.alive:
                member.kill()

    def _member(self, name: str, *arguments: object, **environment: str) -> Member:
        count = sum(member.name.startswith(name) for member in self.members)
        member = Member(
            f"{name}{count}",
            [name, *map(str, arguments)],
            self.folder,
            self.environment | environment,
        )
        self.members.append(member)
        return member

    def start_scheduler(self) -> Member:
        """Return the scheduler once it listens; if it was killed, start it again at the same
        address.
        """
        host, port = "127.0.0.1", self.address.rpartition(":")[2]
        self.file.unlink(missing_ok=True)
        self.scheduler = self._member(
            "scheduler",
            *("--host", host, "--port", port, "--protocol", self.protocol, "--no-dashboard"),
            *("--scheduler-file", self.file),
        )
        self.scheduler.says("Scheduler at:")
        text = until(
            lambda: self.file.exists() and self.file.read_text(),
            "no scheduler file",
            self.scheduler,
        )
        self.address = json.loads(text)["address"]
        return self.scheduler

    def start_worker(
        self, *arguments: object, threads: int = 1, address: str | None = None, **environment: str
    ) -> Member:
        """Return a worker that has just been started; `registered` waits for it."""
        where = self.folder / "space" / str(len(self.members))
        where.mkdir(parents=True)
        return self._member(
            "worker",
            address or self.address,
            *("--nthreads", threads, "--no-nanny", "--no-dashboard", "--local-directory", where),
            *arguments,
            **environment,
        )

    def start_workers(self, count: int) -> list[Member]:
        """Return workers that the scheduler knows."""
        workers = [self.start_worker() for _ in range(count)]
        for worker in workers:
            registered(worker)
        return workers

    @property
    def workers(self) -> list[Member]:
        """Return the workers that have not ended."""
        return [m for m in self.members if m.name.startswith("worker") and m.alive]


def registered(worker: Member) -> Member:
    """Wait until the scheduler knows this worker."""
    worker.says("Registered to")
    return worker


@contextlib.contextmanager
def frozen(process: subprocess.Popen):
    """Stop a process, and those it has started, meanwhile."""
    for each in family(process.pid):
        each.suspend()
    try:
        yield
    finally:
        for each in family(process.pid):
            each.resume()


@contextlib.contextmanager
def slowed(member: Member, share: float = 0.1):
    """Give a member only this share of its time meanwhile."""
    ends = threading.Event()

    def halt() -> None:
        while not ends.wait(share * 0.1):
            member.signal(signal.SIGSTOP)
            ends.wait((1 - share) * 0.1)
            member.signal(signal.SIGCONT)

    thread = threading.Thread(target=halt, daemon=True)
    thread.start()
    try:
        yield
    finally:
        ends.set()
        thread.join()


def certificates(folder: Path) -> Path:
    """Make a folder with an authority, a certificate and Dask's settings, as users do."""
    subprocess.run(["sh", CERTIFICATES, folder], check=True, capture_output=True)
    return folder


class Cable:
    """Forwards connections to a port of the loopback, until it is cut.

    While it is cut it keeps all connections, accepts new ones, and lets nothing through, like a
    network with its switch off: neither end notices. `broken` closes them and refuses new ones.
    """

    def __init__(self, port: int) -> None:
        self._target = port
        self._whole = threading.Event()
        self._whole.set()
        self._refuses = False
        self.passed = 0
        """Bytes, in both directions."""
        self._sockets: list[socket.socket] = []
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.port = self._listener.getsockname()[1]
        threading.Thread(target=self._accept, daemon=True).start()

    @contextlib.contextmanager
    def cut(self):
        """Let nothing through meanwhile; the data arrive afterwards."""
        self._whole.clear()
        try:
            yield
        finally:
            self._whole.set()

    @contextlib.contextmanager
    def broken(self):
        """Close all connections, and new ones at once, meanwhile."""
        self._refuses = True
        self._close()
        try:
            yield
        finally:
            self._refuses = False

    def close(self) -> None:
        self._listener.close()
        self._close()

    def _close(self) -> None:
        for each in self._sockets:
            with contextlib.suppress(OSError):
                each.shutdown(socket.SHUT_RDWR)
            each.close()
        self._sockets.clear()

    def _accept(self) -> None:
        while True:
            try:
                near, _ = self._listener.accept()
            except OSError:
                return
            if self._refuses:
                near.close()
                continue
            try:
                far = socket.create_connection(("127.0.0.1", self._target))
            except OSError:
                near.close()
                continue
            self._sockets += [near, far]
            for one, other in ((near, far), (far, near)):
                threading.Thread(target=self._forward, args=(one, other), daemon=True).start()

    def _forward(self, one: socket.socket, other: socket.socket) -> None:
        with contextlib.suppress(OSError):
            while data := one.recv(65536):
                self._whole.wait()
                self.passed += len(data)
                other.sendall(data)
        for each in (one, other):
            with contextlib.suppress(OSError):
                each.shutdown(socket.SHUT_RDWR)


def free_port() -> int:
    """Return a port of the loopback on which no process listens."""
    with socket.create_server(("127.0.0.1", 0)) as listener:
        return listener.getsockname()[1]


def port_of(address: str) -> int:
    return int(address.rpartition(":")[2])


def shortened(name: str, folder: Path, **changes: object) -> Path:
    """Return a copy of data/experiments/NAME.ini with other values of some keys."""
    lines = (ROOT / "data" / "experiments" / f"{name}.ini").read_text().splitlines()
    for key, value in changes.items():
        places = [i for i, line in enumerate(lines) if line.split("=")[0].strip() == key]
        if places:
            lines[places[0]] = f"{key} = {value}"
        else:
            lines.append(f"{key} = {value}")  # [ALGO] is the last section
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{name}.ini"
    path.write_text("\n".join(lines) + "\n")
    return path
