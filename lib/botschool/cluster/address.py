"""Read and check the value of --cluster, which says where a cluster is."""

from __future__ import annotations

import ipaddress
import json
import re
import socket
from pathlib import Path

from botschool.errors import BotschoolError
from botschool.inifile import shown

FORMS = "tcp://HOST:PORT, tls://HOST:PORT, a scheduler's file FILE.json or local:N"
MOST = 1024
"""Largest number of workers for local:N."""


def place(text: str, unsafe: bool = False) -> tuple[str, int]:
    """Return the address of the scheduler that --cluster names, or "" and the number of workers to
    start on this machine. Raises BotschoolError.

    unsafe: whether the user allows a network without TLS.
    """
    if text.startswith("local:"):
        count = text.removeprefix("local:")
        if count.isascii() and count.isdigit() and 1 <= int(count) <= MOST:
            return "", int(count)
        raise BotschoolError(
            f"--cluster {shown(text)}: local: needs a number of workers from 1 to {MOST}, as in "
            "local:2."
        )
    address = _of_file(Path(text)) if text.endswith(".json") else text
    address = address if "://" in address else f"tcp://{address}"
    match = re.fullmatch(r"(tcp|tls)://(\[[^]]+\]|[^:/\[\]]+):(\d{1,5})/?", address)
    if match is None or not 0 < int(match[3]) < 65536:
        raise BotschoolError(f"--cluster {shown(text)} is none of {FORMS}.")
    protocol, host = match[1], match[2].strip("[]")
    if protocol == "tcp" and not unsafe and not is_this_machine(host):
        raise BotschoolError(
            f"{address} is not this machine's own address and has no TLS, so anyone on the network "
            "could run programs on the workers and here: start the scheduler with TLS and give "
            "tls://HOST:PORT, or add --no-tls in a network that you trust."
        )
    return address.rstrip("/"), 0


def is_this_machine(host: str) -> bool:
    """Return whether a host's name or number means only this machine's loopback."""
    try:
        found = {str(entry[4][0]) for entry in socket.getaddrinfo(host, None)}
    except (OSError, UnicodeError):
        return False
    return bool(found) and all(_loopback(number) for number in found)


def _loopback(number: str) -> bool:
    return ipaddress.ip_address(number.partition("%")[0]).is_loopback


def _of_file(path: Path) -> str:
    """Return the address in a file that `dask scheduler --scheduler-file FILE` writes."""
    try:
        return str(json.loads(path.read_text())["address"])
    except OSError as error:
        why = error.strerror or error
    except (ValueError, KeyError, TypeError):
        why = "no address stands in it"
    raise BotschoolError(
        f"{path} is not a scheduler's file ({why}): 'dask scheduler --scheduler-file {path}' "
        "writes one."
    )
