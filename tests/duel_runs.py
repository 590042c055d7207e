"""For tests of PettingZoo environments: very small experiments, and their runs."""

from botschool import config
from botschool.evolution.coevolution import Coevolution
from botschool.evolution.run import evolve

FACE = "botschool.envs.predprey"
ALGORITHMS = {
    "coevo2": {"ngenerations": 3, "popsize": 4, "selsize": 2, "samplesize": 2, "saveeach": 1},
    "archive": {"ngenerations": 6, "samplesize": 2, "addtoarchiveevery": 1, "ncompetitors": 3},
    "archivestar": {"ngenerations": 6, "samplesize": 2, "addtoarchiveevery": 1, "popsize": 2}
    | {"ncompetitors": 4, "seldifferentiated": 0, "preferential": 2},
    "maxsolvestar": {"ngenerations": 6, "samplesize": 2, "archivelen": 4, "ncompetitors": 3},
}


def write(folder, environment="tiny_duels:Duel", algo="coevo2", options="", policy=None):
    """Writes FOLDER/own.ini, a very small experiment. Gives its path."""
    policy = {"nrobots": 2, "heterogeneous": 1, "maxsteps": 20, "nhiddens": 3} | (policy or {})
    algorithm = {"noiseStdDev": 0.5, "stepsize": 0.3, **ALGORITHMS.get(algo, {})}
    lines = ["[EXP]", f"environment = {environment}", f"algo = {algo}", f"options = {options}"]
    lines += ["[POLICY]", *(f"{key} = {value}" for key, value in policy.items())]
    lines += ["[ALGO]", *(f"{key} = {value}" for key, value in algorithm.items())]
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "own.ini").write_text("\n".join(lines) + "\n")
    return folder / "own.ini"


def run(path, folder, workers=1, resume=False, **limits):
    folder.mkdir(exist_ok=True)
    return evolve(Coevolution(config.load(path), 3, workers), folder, resume=resume, **limits)
