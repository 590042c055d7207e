"""Makes data/genotypes/predprey from a run: the ten best of both populations at some generations.

    python tools/studies keep_best results/predprey 12 0 10 20 40

The files have the names and the meaning of the run's own, in single precision (in which networks
are evaluated anyway).
"""

import sys
from pathlib import Path

import numpy as np

BEST = 10
KEPT = Path(__file__).parents[2] / "data" / "genotypes" / "predprey"


def main() -> None:
    _, folder, seed, *generations = sys.argv
    KEPT.mkdir(parents=True, exist_ok=True)
    for generation in generations:
        for name in (f"S{seed}G{generation}.npy", f"S{seed}FitG{generation}.npy"):
            table = np.load(Path(folder) / name)  # predators, then prey, the best first
            half = len(table) // 2
            best = np.concatenate([table[:BEST], table[half : half + BEST]])
            np.save(KEPT / name, best.astype(np.float32))
