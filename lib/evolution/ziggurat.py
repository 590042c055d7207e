"""Generate ziggurat.hpp: the tables of numpy's ziggurat for the normal distribution.

    python lib/evolution/ziggurat.py > lib/evolution/ziggurat.hpp

The method is Marsaglia and Tsang's (2000) with 256 layers: a random word chooses a layer (8 bits),
a sign and a place (52 bits); a place inside the layer is taken at once. Where numpy's layers end is
asked of numpy, since its tables are rounded in a way of their own: it is given words of our choice.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.random import Generator, Philox

LAYERS = 256
PLACES = 1 << 52


class Asked:
    """numpy's normal numbers from words of our choice."""

    def __init__(self) -> None:
        self._bits = Philox(key=1)
        self._numbers = Generator(self._bits)
        self._state = self._bits.state

    def draw(self, layer: int, place: int) -> tuple[float, int]:
        """Return the number that a word gives, and how many words it took."""
        half = 1 << 63  # as a uniform number; and as a draw it is place 0 of layer 0
        words = [place << 9 | layer, half, half, half]
        self._state["buffer"] = np.array(words, dtype=np.uint64)
        self._state["buffer_pos"] = 0
        self._bits.state = self._state
        return self._numbers.standard_normal(), self._bits.state["buffer_pos"]

    def width(self, layer: int) -> float:
        """Return how far apart places of a layer are."""
        place = self.inside(layer) // 2 or PLACES // 2
        exact = 1 << (place.bit_length() - 1)  # times a power of two is exact
        return self.draw(layer, exact)[0] / exact

    def inside(self, layer: int) -> int:
        """Return the first place that needs a further look."""
        low, high = 0, PLACES
        while low < high:
            middle = (low + high) // 2
            if self.draw(layer, middle)[1] == 1:
                low = middle + 1
            else:
                high = middle
        return low


def table(kind: str, name: str, values: list[str]) -> list[str]:
    """An array in C++, in lines of at most 100 characters."""
    lines, line = [], "   "
    for value in values:
        if len(line) + len(value) > 95:
            lines.append(line)
            line = "   "
        line += f" {value},"
    return [f"inline constexpr {kind} {name}[{LAYERS}] = {{", *lines, line, "};"]


def header() -> str:
    """Return the text of ziggurat.hpp."""
    asked = Asked()
    inside = [asked.inside(layer) for layer in range(LAYERS)]
    # no place of layer 1 is inside: it is as wide as its density says
    width = [asked.width(layer) for layer in range(LAYERS)]
    tail = width[-1] * PLACES
    height = [1.0] + [math.exp(-0.5 * (w * PLACES) ** 2) for w in width[1:]]
    return "\n".join(
        [
            "// Made by ziggurat.py. A word chooses a layer and a place in it; the number is",
            "// place * width[layer]. Places below inside[layer] need no further look;",
            "// height[layer] is the density at a layer's edge. The tail begins at `tail`.",
            "#pragma once",
            "",
            "#include <cstdint>",
            "",
            "// clang-format off",
            "namespace botschool::ziggurat {",
            f"inline constexpr double tail = {tail!r}, inverse_tail = {1 / tail!r};",
            *table("double", "width", [value.hex() for value in width]),
            *table("std::uint64_t", "inside", [f"{value}ull" for value in inside]),
            *table("double", "height", [value.hex() for value in height]),
            "}  // namespace botschool::ziggurat",
            "// clang-format on",
        ]
    )


if __name__ == "__main__":
    print(header())
