"""Experiment files as they were written for the original library (docs/specification.md,
"Experiment files"): capitals, comments, blanks, tabs, line ends and absent keys as they come. Each
starts as it is, and goes on for ten generations by --resume.
"""

import numpy as np
import pytest

from botschool import config
from botschool.evolution.run import Run
from running import same, write_experiment

LOCOMOTOR = """[EXP]
environment = {body}BulletEnv-v5
algo = OpenAI-ES

[POLICY]
nrobots = 1
heterogeneous = 0
episodes = 1
pepisodes = 3
maxsteps = 1000
nhiddens = {nhiddens}
nlayers = 1
bias = 1
out_type = 3
architecture = 0
afunction = 2
winit = 1
action_noise = 1
normalize = 1
clip = 1

[ALGO]
maxMsteps = {length}
stepsize = 0.01
sampleSize = {samplesize}
noiseStdDev = 0.02
wdecay = 1
symseed = 1
saveeach = 60
"""


def locomotor(body, nhiddens=50, samplesize=20, length=50):
    return LOCOMOTOR.format(body=body, nhiddens=nhiddens, samplesize=samplesize, length=length)


FILES = {
    "cartpole": "[EXP]\nenvironment = CartPole-v0\nalgo = SSS\n",
    "acrobot": "[EXP]\r\nenvironment=Acrobot-v1\r\nalgo=OpenAI-ES\r\n\r\n[POLICY]\r\nepisodes=3\r\n"
    "pepisodes=20\r\nmaxsteps=500\r\nnHiddens=10\r\nnlayers=1\r\nbias=1\r\nout_type=2\r\n"
    "afunction=2\r\nwinit=1\r\n\r\n[ALGO]\r\nmaxMsteps=20\r\nsampleSize=20\r\nstepsize=0.01\r\n",
    "pendulum": "[EXP]\nenvironment\t=\tPendulum-v0\nalgo\t=\tOpenAI-ES\n\n[POLICY]\n"
    "episodes\t= 3\npepisodes\t= 20\nmaxsteps\t= 200\nnhiddens\t= 10\nbias\t= 1\nout_type\t= 3\n"
    "winit\t= 1\nnormalize\t= 1\n\n[ALGO]\nmaxmsteps\t= 100\nsamplesize\t= 20\n\n\n",
    "mountaincar": "; a car in a valley\n[EXP]\nenvironment = MountainCarContinuous-v0\n"
    "algo = SSS ; steady state\n[POLICY]\nepisodes = 3\nnhiddens = 5 # of one layer\nbias = 1\n"
    "[ALGO]\nmaxmsteps = 5\npopSize = 20\nmutation = 0.1\n",
    "hopper": locomotor("Hopper"),
    "halfcheetah": locomotor("HalfCheetah"),
    "ant": locomotor("Ant"),
    "walker": locomotor("Walker2D"),
    "humanoid": locomotor("Humanoid", 64, 250, 100),
    "balancebot": "[EXP]\nenvironment = BalanceBotBulletEnv-v0\nalgo = OpenAI-ES\n\n[POLICY]\n"
    "episodes = 1\npepisodes = 3\nmaxsteps = 500\nnhiddens = 10\nbias = 1\nout_type = 3\n"
    "winit = 1\n\n[ALGO]\nmaxmsteps = 10\nsampleSize = 20\n",
    "bodybrain": "#\n# body and brain\n#\n[EXP]\nenvironment = envBodybrainCustom\n"
    "algo = OpenAI-ES\n[POLICY]\nepisodes = 3\npepisodes = 3\nmaxsteps = 400\nnhiddens = 50\n"
    "bias = 1\nout_type = 3\nwinit = 1\naction_noise = 1\nnormalize = 1\nclip = 1\n"
    "[ALGO]\nmaxMsteps = 100\nstepsize = 0.01\nsampleSize = 20\nnoiseStdDev = 0.02\nwdecay = 1\n",
    "swingup": "[ALGO]\nmaxMsteps = 500\nwdecay = 1\nstepSize = 0.01\nsampleSize = 20\n\n"
    "[POLICY]\nepisodes = 3\nnhiddens = 55\nnhiddens2 = 30\nnlayers = 2\nbias = 1\nout_type = 3\n"
    "winit = 1\nclip = 1\n\n[EXP]\nenvironment = envSwingupCustom\nalgo = OpenAI-ES\n",
    "discrim": "[EXP]\nenvironment = ErDiscrim\n   algo = openai-es\n\n[Policy]\n   episodes = 10\n"
    "   pepisodes = 20\n   maxsteps = 500\n   nhiddens = 10\n   bias = 1\n   out_type = 2\n"
    "   architecture = 3\n   afunction = 2\n   winit = 0\n   action_noise = 1\n\n[Algo]\n"
    "   maxmsteps = 350\n   stepsize = 0.01\n   samplesize = 20\n   noisestddev = 0.02\n",
    "dpole": "[EXP]\nenvironment = ErDpole\nalgo = OpenAI-ES\n[POLICY]\nepisodes = 10\n"
    "pepisodes = 500\nmaxsteps = 1000\nnhiddens = 10\nnlayers = 1\nbias = 1\nout_type = 2\n"
    "nbins = 1\narchitecture = 3\nafunction = 2\nwinit = 0\naction_noise = 0\n"
    "action_noise_range = 0.01\nnormalize = 0\nclip = 0\nwrange = 1.0\n[ALGO]\nmaxmsteps = 10000\n"
    "sampleSize = 250\n",
    "predprey": "[EXP]\nenvironment = ErPredprey\nalgo = coevo2\n\n[POLICY]\nnrobots = 2\n"
    "heterogeneous = 1\nepisodes = 1\nmaxsteps = 1000\nnhiddens = 25\nnlayers = 1\nbias = 1\n"
    "out_type = 2\narchitecture = 3\nafunction = 2\nwinit = 0\n\n[ALGO]\nngenerations = 1000\n"
    "popsize = 80\nselsize = 10\nsampleSize = 20\nstepsize = 0.01\nnoiseStdDev = 0.02\n"
    "wdecay = 1\nsaveeach = 100\n",
    "staybehind": "[EXP]\nenvironment = ErStaybehind\nalgo = coevo\n\n[POLICY]\nnrobots = 2\n"
    "heterogeneous = 1\nmaxsteps = 500\nnhiddens = 25\nnlayers = 1\nbias = 1\nout_type = 2\n"
    "architecture = 3\nafunction = 2\nwinit = 0\n\n[ALGO]\npopsize = 20\nselsize = 5\n"
    "saveeach = 10\n",
}
"""The original's fourteen, and two files of classic control in the same style."""
QUICK = ("cartpole", "acrobot", "pendulum", "mountaincar", "swingup", "discrim", "dpole")


def start(name, folder, command, *limits):
    """Runs the command on the file, in a folder that holds it alone."""
    path = folder / f"{name}.ini"
    path.write_bytes(FILES[name].encode())
    code, out, errors = command("es", "-f", path, "-s", 11, "-o", folder / "run", *limits)
    assert code == 0, errors
    return out


def generations(folder):
    return len(np.load(folder / "run" / "statS11.npy")) // 6


@pytest.mark.parametrize("name", FILES)
def test_it_says_what_it_says(name, tmp_path):
    """Every key of the file is read: its value is in the experiment."""
    path = tmp_path / "old.ini"
    path.write_bytes(FILES[name].encode())
    experiment = config.load(path)
    read = {
        key.lower(): str(value)
        for part in ("exp", "policy", "algo")
        for key, value in vars(getattr(experiment, part)).items()
    }
    for line in FILES[name].replace("mutation", "mutrate").splitlines():
        line = line.partition("#")[0].partition(";")[0]
        if "=" in line:
            key, value = (word.strip() for word in line.split("="))
            found = read[key.lower()]
            same = found.lower() == value.lower() or float(found) == float(value)
            assert same, (key, value, found)


@pytest.mark.slow
@pytest.mark.parametrize("name", QUICK)
def test_it_starts_and_goes_on_for_ten_generations(name, tmp_path, command):
    start(name, tmp_path, command, "--generations", 2)
    assert generations(tmp_path) == 2
    start(name, tmp_path, command, "--generations", 12, "--resume")
    assert generations(tmp_path) == 12


# --- --keep-every: the best of earlier generations stay (docs/specification.md, "Run files").


KEPT = 3


@pytest.fixture
def ini(tmp_path):
    """A native problem, some fifteen generations."""
    policy = {"episodes": 1, "maxsteps": 20, "out_type": 3}
    return write_experiment(tmp_path, "Pendulum-v1", policy=policy, maxmsteps=0.003)


def run_of(command, ini, folder, *flags):
    flags = ("-o", folder, "--keep-every", KEPT, *flags)
    code, _, errors = command("es", "-f", ini, "-s", 5, *flags)
    assert (code, errors) == (0, "")
    return folder


def test_the_best_so_far_of_every_third_generation_is_kept(ini, tmp_path, command):
    from botschool import config

    run_of(command, ini, tmp_path / "kept")
    run = Run(config.load(ini), 5)
    best = {0: run.policy.initial(5)}
    while run.record.steps < run.max_steps:
        run.advance()
        best[run.record.generation] = run.record.bestg
    last = run.record.generation
    assert last > 3 * KEPT
    names = {f"bestgS5G{g}.npy" for g in range(0, last + 1, KEPT)}
    assert {path.name for path in (tmp_path / "kept").glob("bestgS5G*.npy")} == names
    for name in names:
        generation = int(name.removesuffix(".npy").partition("G")[2])
        np.testing.assert_array_equal(np.load(tmp_path / "kept" / name), best[generation])
    assert not np.array_equal(best[KEPT], best[last])


def test_interrupted_and_resumed_keeps_the_same(ini, tmp_path, command):
    whole = run_of(command, ini, tmp_path / "whole")
    for generations in (1, 2, 7):
        run_of(command, ini, tmp_path / "parts", "--generations", generations, "--resume")
    run_of(command, ini, tmp_path / "parts", "--resume")
    assert same(whole, tmp_path / "parts")


def test_a_normalised_robot_is_kept_with_its_vectors(tmp_path, command):
    ini = write_experiment(tmp_path, policy={"normalize": 1}, maxmsteps=0.002)
    folder = run_of(command, ini, tmp_path / "kept")
    first, last = np.load(folder / "bestgS5G0.npy"), np.load(folder / "bestgS5.npy")
    assert first.shape == last.shape
    np.testing.assert_array_equal(first[-8:], [0] * 4 + [1] * 4)
    code, out, _ = command("es", "-f", ini, "-s", 5, "-p", "-g", folder / "bestgS5G3.npy")
    assert code == 0 and "episode 3" in out
