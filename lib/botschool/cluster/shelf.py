"""Which tables a worker has: the newest that fit."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Iterable


class Shelf:
    """Names, each with a size in bytes; those used last are kept, as many as fit."""

    def __init__(self, limit: int) -> None:
        self._limit = limit
        self._sizes: OrderedDict[bytes, int] = OrderedDict()
        self._total = 0

    def __contains__(self, name: bytes) -> bool:
        return name in self._sizes

    def put(self, name: bytes, size: int) -> None:
        """A table that is there from now on."""
        self.drop(name)
        self._sizes[name] = size
        self._total += size

    def drop(self, name: bytes) -> None:
        """A table that is not there."""
        self._total -= self._sizes.pop(name, 0)

    def use(self, names: Iterable[bytes]) -> None:
        """Tables that are used now."""
        for name in names:
            self._sizes.move_to_end(name)

    def trim(self) -> list[bytes]:
        """Drops what has not been used for longest, until the rest fits; gives the names."""
        dropped = []
        while self._total > self._limit:
            dropped.append(next(iter(self._sizes)))
            self.drop(dropped[-1])
        return dropped
