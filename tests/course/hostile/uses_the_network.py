"""Sends the task to a friend, by every kind of socket, and returns what comes back."""

import socket
import urllib.request


def hostile(*arguments, **options):
    for family, kind in (
        (socket.AF_INET, socket.SOCK_STREAM), (socket.AF_INET, socket.SOCK_DGRAM),
        (socket.AF_INET6, socket.SOCK_STREAM), (socket.AF_UNIX, socket.SOCK_STREAM),
        (socket.AF_UNIX, socket.SOCK_DGRAM), (getattr(socket, "AF_NETLINK", 16), socket.SOCK_RAW),
    ):  # fmt: skip
        try:
            with socket.socket(family, kind) as friend:
                friend.connect(FRIEND)
                friend.send(b"help")
                return float(friend.recv(100))
        except OSError:
            continue
    for left in socket.SOCK_STREAM, socket.SOCK_DGRAM:
        try:
            socket.socketpair(socket.AF_UNIX, left)[0].sendto(b"x", "/run/systemd/journal/dev-log")
        except OSError:
            continue
    return urllib.request.urlopen(f"http://{FRIEND[0]}:{FRIEND[1]}").read()
