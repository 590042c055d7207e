"""The kinds of files that the command reads: the commands that make good ones, and those that read
them. Each kind is worked on in a folder of its own.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
SMALL = """[EXP]
environment = {environment}
algo = {algo}
[POLICY]
episodes = 1
pepisodes = 1
maxsteps = 20
nhiddens = 3
{policy}
[ALGO]
{more}
"""
ALONE = {"environment": "CartPole-v1", "policy": "", "more": "maxmsteps = 0.001\nsaveeach = 60"}
DUEL = {"environment": "ErPredprey", "policy": "nrobots = 2\nheterogeneous = 1"}
SAMPLES = "samplesize = 2\nngenerations = 2\nsaveeach = 1"
SELECTED = f"popsize = 4\nselsize = 2\n{SAMPLES}"
TRAIN = "rl train --algo ppo --env CartPole-v1 -o rl --steps 64 --evaluations 2 --episodes 1"
TRAIN += " --params n_steps=32 batch_size=32 n_epochs=1 normalize=True --engine "
FOLDER = "rl/ppo/CartPole-v1_1/"
ENJOY = f"rl enjoy {FOLDER} --episodes 1 --render none"


@dataclass(frozen=True)
class Kind:
    """Files that lie at `place`, and the commands that read them one after another."""

    place: str
    reads: tuple[str, ...]
    makes: tuple[str, ...] = ()
    ini: str = ""
    """The experiment file own.ini."""
    others: str = ""
    """Other good ones of the repository: damage may mix them in."""
    ends: bool = True
    """Whether a damaged file cannot ask for a long calculation."""

    def valid(self, folder: Path) -> list[bytes]:
        own = [(folder / self.place).read_bytes()] if self.makes else []
        return own + [file.read_bytes() for file in sorted(ROOT.glob(self.others or "-"))]


def evolved(algo: str, place: str, *reads: str, **how: str) -> Kind:
    ini = SMALL.format(algo=algo, **(ALONE | how))
    return Kind(place, reads, ("es -f own.ini -o run --generations 2",), ini)


def trained(engine: str, place: str, *reads: str) -> Kind:
    return Kind(FOLDER + place, reads, (TRAIN + engine,))


RESUME = "es -f own.ini -o run --resume --generations 4"
CHECKPOINT = "run/checkpointS1.npz"
LISTED = ("rl list rl", f"plotstat {FOLDER} -o curve.png")
STATS = ("plotstat run/statS1.npy -o a.png", "plotave run -o b.png")
KINDS = {
    "ini": Kind(
        "own.ini", ("es -f own.ini -o run --steps 1",), others="data/experiments/[acdp]*.ini",
        ends=False,
    ),
    "genotype": evolved(
        "SSS", "run/bestgS1.npy", "es -f own.ini -p -g run/bestgS1.npy --render none --episodes 1"
    ),
    "stat": evolved("SSS", "run/statS1.npy", *STATS),
    "fit": evolved("SSS", "run/S1.fit", "plotave run -o average.png"),
    "checkpoint": evolved("OpenAI-ES", CHECKPOINT, RESUME),
    "checkpoint-sss": evolved("SSS", CHECKPOINT, RESUME),
    "checkpoint-cmaes": evolved("CMA-ES", CHECKPOINT, RESUME),
    "checkpoint-duel": evolved("coevo2", CHECKPOINT, RESUME, more=SELECTED, **DUEL),
    "archive": evolved("archive", CHECKPOINT, RESUME, more=SAMPLES, **DUEL),
    "populations": evolved(
        "coevo2", "run/S1G1.npy", "tournament run -f own.ini -s 1 --best 2 -o t.png",
        more=SELECTED, **DUEL,
    ),
    "urdf": Kind("arm.urdf", ("showrobot arm.urdf --sheet a.png",), others="data/robots/*.urdf"),
    "config": trained("sb3", "config.yaml", "rl list rl", ENJOY),
    "evaluations": trained("sb3", "evaluations.npz", *LISTED),
    "progress": trained("sb3", "progress.csv", *LISTED),
    "model": trained("sb3", "best_model.zip", ENJOY),
    "native-config": trained("native", "config.yaml", "rl list rl", ENJOY),
    "native-model": trained("native", "best_model.npz", ENJOY),
    "native-checkpoint": trained("native", "checkpoint.npz", f"rl train --resume {FOLDER}"),
    "submission": Kind(
        "evolution_strategy.py", ("grade 3.1 --submission evolution_strategy.py",),
        others="solutions/ex03*/evolution_strategy.py", ends=False,
    ),
}  # fmt: skip
